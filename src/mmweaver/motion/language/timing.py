"""Scheduling of a plan: natural durations, stretched or compressed into the given time."""

import math
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.language.sentence import parse

LONGEST_S = 600.0


def plan_motion(text: str, duration_s: float | None = None, fps: float = 10.0) -> MotionPlan:
    """Parses a sentence and schedules its steps; without a duration they take as long as is natural.

    This is the plan that `compose` takes. Raises InputError as `parse` and `schedule` do.

    >>> plan = plan_motion("a person bows, then waves", 4.0)
    >>> [(step.name, round(step.start_s, 2), round(step.end_s, 2)) for step in plan.steps]
    [('bowing', 0.0, 2.2), ('waving', 2.2, 4.0)]
    """
    plan = parse(text)
    return schedule(plan, natural_s(plan) if duration_s is None else duration_s, fps)


def schedule(plan: MotionPlan, duration_s: float, fps: float = 10.0) -> MotionPlan:
    """Gives every step of a plan its start and end; `fps` is only used in the text of an error.

    A single movement without a count may be cut short: a part of it is shown. Raises InputError for a duration that
    is not positive or above `LONGEST_S`, and where several movements, or a number of repetitions, do not fit into it.
    """
    if not (math.isfinite(duration_s) and 0 < duration_s <= LONGEST_S):
        raise InputError(f"a duration of {duration_s:g} s is not possible; choose above 0 and up to {LONGEST_S:g} s")
    first = plan.steps[0]
    least: list[float] = [limits[0] for limits in map(_limits, plan.steps)]
    if sum(least) > duration_s + 1e-9 and (len(plan.steps) > 1 or first.count or first.seconds):
        needed = sum(least)
        raise InputError(
            f"{len(plan.steps)} movement(s) need at least {needed:.1f} s, there are {duration_s:.1f} s; ask for more"
            f" frames (at {fps:.3g} a second {int(needed * fps + 0.999)} of them) or say less"
        )
    spans = _spans(plan.steps, max(duration_s, sum(least)))
    steps: list[Step] = []
    start = 0.0
    for step, span in zip(plan.steps, spans, strict=True):
        steps.append(replace(step, start_s=start, end_s=start + span))
        start += span
    return replace(plan, steps=tuple(steps), duration_s=duration_s)


def natural_s(plan: MotionPlan) -> float:
    """How long a plan takes when no duration is given, in seconds."""
    return sum(_limits(step)[1] for step in plan.steps)


def _limits(step: Step) -> tuple[float, float]:
    """Least and natural duration of a step, in seconds."""
    if step.seconds:
        return step.seconds, step.seconds
    if step.lower == "turn" and step.turn_deg:
        lasts = 0.3 + abs(step.turn_deg) / 185
        return lasts, lasts + 0.2
    doing = BY_KEY[step.upper or step.lower]
    if step.count and doing.counted_s:
        least, natural, edges = doing.counted_s
        slower = 1.25 if step.speed < 0 else 1.0
        return step.count * least + edges, (step.count * natural + edges) * slower
    under = BY_KEY[step.lower]
    return max(doing.least_s, under.least_s * under.once), max(doing.natural_s, under.natural_s * under.once)


def _is_done_once(step: Step) -> bool:
    """Whether a step takes its natural time only."""
    return BY_KEY[step.lower].once or (step.lower == "stand" and bool(step.upper) and BY_KEY[step.upper].once)


def _spans(steps: tuple[Step, ...], duration_s: float) -> list[float]:
    """Seconds of each step: between least and natural if time is short, else spare time goes to elastic steps."""
    limits: list[tuple[float, float]] = [_limits(step) for step in steps]
    least, natural = sum(limit[0] for limit in limits), sum(limit[1] for limit in limits)
    if duration_s <= natural:
        share = (duration_s - least) / (natural - least) if natural > least else 0.0
        return [low + share * (high - low) for low, high in limits]
    elastic = [not (_is_done_once(step) or step.count or step.seconds) for step in steps]
    if not any(elastic):
        elastic = [k == len(steps) - 1 for k in range(len(steps))]  # the last pose is held
    weight = sum(limit[1] for limit, free in zip(limits, elastic, strict=True) if free)
    extra = duration_s - natural
    return [high + (extra * high / weight if free else 0.0) for (_, high), free in zip(limits, elastic, strict=True)]
