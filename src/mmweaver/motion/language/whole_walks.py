"""What is said of a walk as a whole: its gait, how fast all of its parts are."""

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

from mmweaver.motion.language.lexicon import SPEEDS
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
