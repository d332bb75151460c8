"""Plan of a sentence for a person who is already in the room: it begins and ends in a held posture."""

from dataclasses import replace

from mmweaver.motion.language.plan import Foot, MotionPlan, Step, Way
from mmweaver.motion.language.postures import STILL, insert_transitions
from mmweaver.motion.language.timing import is_elastic

HELD_FIRST_S, HELD_LAST_S = 0.6, 0.8  # to blend from the last motion, and to come to rest
_SEATED = ("sit", "sit_down")


def posture_held(posture: str, *, seconds: float, style: str = "", foot: Foot = "") -> Step:
    """A step in which the body stays still: standing, sitting, kneeling or lying.

    Args:
        posture: feet, seat, couch, knees or floor.
        seconds: Duration.
        style: Side on which the body lies.
        foot: Knee on which the body kneels.
    """
    return Step(lower=STILL.get(posture, "stand"), seconds=seconds, style=style, foot=foot)


def continued(plan: MotionPlan, before: Step | None, *, seat_m: float | None = None) -> MotionPlan:
    """Continues from the step `before`, with the transitions between the postures; ends at rest.

    Args:
        plan: Plan of the sentence.
        before: Last step of the previous motion; None for the first sentence.
        seat_m: Distance to the nearest seat in metres, to which a person who sits down walks first; None if the body
            already stands in front of one.
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
    """Continues the last activity of a plan.

    Args:
        plan: Plan of the last sentence.
        seconds: Duration.

    Returns:
        The step; None if the activity ends by itself or leads elsewhere.
    """
    last = next((step for step in reversed(plan.steps) if step.clause), None)
    if last is None or last.moves or last.count or last.seconds or last.turn_deg or last.lower == "turn":
        return None
    return replace(last, seconds=seconds, clauses=()) if is_elastic(last) else None
