"""Steps to a side that a sentence names once for several walks."""

import re
from dataclasses import replace
from itertools import pairwise

from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.plan import Step

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
