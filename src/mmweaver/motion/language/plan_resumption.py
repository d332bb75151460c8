"""The plan of a sentence for somebody who is in the room already: it begins and ends in a held posture."""

from dataclasses import replace

from mmweaver.motion.language.plan import Foot, MotionPlan, Step, Way
from mmweaver.motion.language.postures import STILL, insert_transitions
from mmweaver.motion.language.timing import is_elastic

HELD_FIRST_S, HELD_LAST_S = 0.6, 0.8  # long enough to blend from the last motion, and to come to rest
_SEATED = ("sit", "sit_down")


def posture_held(posture: str, *, seconds: float, style: str = "", foot: Foot = "") -> Step:
    """A step in which the body stays as it is: standing, sitting, kneeling or lying."""
    return Step(lower=STILL.get(posture, "stand"), seconds=seconds, style=style, foot=foot)


def continued(plan: MotionPlan, before: Step | None, *, seat_m: float | None = None) -> MotionPlan:
    """The plan after the step `before`, with what leads from one posture to the other; it ends at rest.

    `seat_m`: how far it is to the nearest seat; who is to sit down and does not stand before one walks there first.
    `before` is None for the first sentence, which begins as it says.
    """
    steps = list(plan.steps)
    if before is not None:
        goes_to_seat = before.posture == "feet" and steps[0].lower in _SEATED and seat_m is not None
        way = [Step(lower="walk", direction=Way.SEAT, distance_m=seat_m or 0.0, clause=steps[0].clause)]
        steps = insert_transitions([before, *(way if goes_to_seat else []), *steps])
    last = steps[-1]
    rest = posture_held(last.posture, seconds=HELD_LAST_S, style=last.style, foot=last.foot)
    return replace(plan, steps=(*steps, rest))


def goes_on(plan: MotionPlan, seconds: float) -> Step | None:
    """The last activity of a plan for so many seconds more; None where it ends by itself or leads elsewhere."""
    last = next((step for step in reversed(plan.steps) if step.clause), None)
    if last is None or last.moves or last.count or last.seconds or last.turn_deg or last.lower == "turn":
        return None
    return replace(last, seconds=seconds, clauses=()) if is_elastic(last) else None
