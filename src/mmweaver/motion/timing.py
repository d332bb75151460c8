"""How long each step of a plan lasts: natural durations, stretched or squeezed into the time there is."""

from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.plan import MotionPlan, Step

# Seconds (at least, naturally) of a step that may go on as long as it likes.
OPEN: dict[str, tuple[float, float]] = {
    "stand": (0.3, 1.0), "walk": (0.8, 2.0), "jog": (0.8, 2.0), "turn": (0.7, 1.2), "sit": (0.4, 1.5),
    "sit_down": (0.95, 1.6), "stand_up": (0.9, 1.4), "squat": (1.1, 2.0), "jump": (1.45, 1.7),
    "jumping_jacks": (1.0, 2.1), "wave": (0.8, 1.8), "clap": (0.6, 1.6), "raise": (1.1, 2.2), "drink": (1.4, 2.8),
    "punch": (0.55, 1.5),
}  # fmt: skip
# Seconds of one of a counted number: at least, naturally; and what the first and last of them need besides.
COUNTED: dict[str, tuple[float, float, float]] = {
    "wave": (0.45, 0.75, 0.3), "clap": (0.32, 0.5, 0.25), "raise": (1.1, 2.0, 0.0), "drink": (1.4, 2.6, 0.0),
    "punch": (0.42, 0.6, 0.1), "squat": (1.1, 2.0, 0.0), "jump": (0.92, 1.0, 0.6), "jumping_jacks": (0.92, 1.1, 0.35),
    "walk": (0.5, 0.58, 0.3), "jog": (0.36, 0.4, 0.3),
}  # fmt: skip
ONCE = ("turn", "sit_down", "stand_up")  # done in their natural time; what is left goes to others


def schedule(plan: MotionPlan, duration_s: float) -> MotionPlan:
    """The plan with start and end of every step.

    A single movement without a count may be cut short: a part of it is shown. Raises InputError where several
    movements, or a number of repetitions, cannot fit.
    """
    first = plan.steps[0]
    least: list[float] = [limits[0] for limits in map(_limits, plan.steps)]
    if sum(least) > duration_s + 1e-9 and (len(plan.steps) > 1 or first.count or first.seconds):
        needed = sum(least)
        raise InputError(
            f"{len(plan.steps)} movement(s) need at least {needed:.1f} s, there are {duration_s:.1f} s; ask for more"
            f" frames (at 10 a second {int(needed * 10 + 0.999)} of them) or say less"
        )
    spans = _spans(plan.steps, max(duration_s, sum(least)))
    steps: list[Step] = []
    start = 0.0
    for step, span in zip(plan.steps, spans, strict=True):
        steps.append(replace(step, start_s=start, end_s=start + span))
        start += span
    return replace(plan, steps=tuple(steps))


def _limits(step: Step) -> tuple[float, float]:
    """Least and natural seconds of a step."""
    if step.seconds:
        return step.seconds, step.seconds
    doing = step.upper or step.lower
    if step.count and doing in COUNTED:
        least, natural, besides = COUNTED[doing]
        slower = 1.25 if step.speed < 0 else 1.0
        return step.count * least + besides, (step.count * natural + besides) * slower
    return OPEN[doing]


def _spans(steps: tuple[Step, ...], duration_s: float) -> list[float]:
    limits: list[tuple[float, float]] = [_limits(step) for step in steps]
    least, natural = sum(limit[0] for limit in limits), sum(limit[1] for limit in limits)
    if duration_s <= natural:
        share = (duration_s - least) / (natural - least) if natural > least else 0.0
        return [low + share * (high - low) for low, high in limits]
    elastic = [step.lower not in ONCE and not step.count and not step.seconds for step in steps]
    if not any(elastic):
        elastic = [k == len(steps) - 1 for k in range(len(steps))]  # done, then stays as it is
    weight = sum(limit[1] for limit, free in zip(limits, elastic, strict=True) if free)
    extra = duration_s - natural
    return [high + (extra * high / weight if free else 0.0) for (_, high), free in zip(limits, elastic, strict=True)]
