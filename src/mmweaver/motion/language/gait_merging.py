"""What is said of a walk as a whole: its gait, its speed, its side."""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby, pairwise

from mmweaver.motion.language.lexicon import SPEEDS
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import Step

_WALKING = re.compile(r"\b(?:walk|step|go|stroll|mov|turn)")


def at_one_gait(steps: list[Step], given_text: str) -> list[Step]:
    """Two curves of a run that patterns have made of one: 'runs in a zigzag' does not walk the second one."""
    run = next((step for step in steps if step.lower == "jog"), None)
    if run is None or _WALKING.search(given_text.lower()):
        return steps
    return [
        replace(step, lower="jog", style=step.style or run.style) if step.lower == "walk" and step.arc_deg else step
        for step in steps
    ]


def with_shared_speeds(steps: list[Step], every_clause: Sequence[ParsedClause], given_text: str) -> list[Step]:
    """The steps with a speed that is said of several of them: of curves that are one pattern, or of all.

    "Walks slowly in an s" is slow in both curves; "slowly, ..." and "..., quickly" at the end are said of everything.
    """
    said = [SPEEDS[word] for word in re.findall("[a-z]+", given_text.lower()) if word in SPEEDS]
    if len(said) != 1 or len(steps) < 2:
        return steps
    if any(_is_only_a_speed(parsed) for parsed in (every_clause[0], every_clause[-1])):
        return [replace(step, speed=said[0]) for step in steps]
    shared: list[Step] = []
    for (_, is_curved), same in groupby(steps, key=lambda step: (step.lower, step.moves and step.arc_deg != 0.0)):
        curves = list(same)
        speed = next((step.speed for step in curves if step.speed), 0) if is_curved else 0
        shared += [replace(step, speed=step.speed or speed) for step in curves]
    return shared


def _is_only_a_speed(parsed: ParsedClause) -> bool:
    """Whether a clause says nothing but how fast it is: a leading "slowly," or a ", very quickly" at the end."""
    alone = replace(parsed.about, clause="", speed=0) == Step() and parsed.about.speed != 0
    return parsed.adds_nothing and alone and parsed.link in ("first", "comma")


_GOING = re.compile(r"\b(?:walk|step|go|stroll|mov|turn|tak)")
_COUNTED_STEPS = re.compile(r"\b(?:an?|one|two|three|four|five|six|seven|eight|nine|ten|\d+) (?:more |side )?steps?\b")


def sideways_throughout(steps: list[Step]) -> list[Step]:
    """ "Walks sideways, four steps to the left, four steps back", "sidesteps left, then four steps right": sideways."""
    is_aimless = len(steps) > 1 and steps[0].lower == "sidestep" and not (steps[0].direction or steps[0].count)
    if not is_aimless or not all(step.lower == "walk" and step.count for step in steps[1:]):
        return steps[:1] + [
            replace(step, lower="sidestep") if before.lower == "sidestep" and _is_only_counted(step) else step
            for before, step in pairwise(steps)
        ]
    result: list[Step] = []
    for step in steps[1:]:
        back = step.direction in ("back", "backwards") and result
        side = OPPOSITE.get(result[-1].direction, "") if back else step.direction
        result.append(replace(step, lower="sidestep", direction=side))
    result[0] = replace(result[0], clauses=(*steps[0].clauses, *result[0].clauses))
    return result


def _is_only_counted(step: Step) -> bool:
    """Whether a walk to a side has no verb of its own: 'four steps to the right'."""
    to_a_side = step.lower == "walk" and bool(step.count) and step.direction in OPPOSITE
    return to_a_side and not _GOING.search(_COUNTED_STEPS.sub("", step.clause))
