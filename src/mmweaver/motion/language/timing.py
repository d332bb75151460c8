"""Scheduling of a plan: natural durations, stretched, compressed, repeated or cut to the given time."""

import math
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.plan import APPROXIMATED, FALLING_ON, NOT_DONE, STYLED_MPS, MotionPlan, Shape, Step
from mmweaver.motion.language.postures import PACES, add_shown_text
from mmweaver.motion.language.sentence import parse_sentence

LONGEST_S = 600.0
SHORTEST_SHARE = 0.5  # of a movement's minimum time, below which it is not recognizable
PACING_S = 5.5  # "walks to and fro": there and back
CRAWLING_TO_AND_FRO_S = 9.0
TURN_M = 0.6  # a corner of a path takes as long as this distance
SHORTEST_OF_SECONDS_S = 0.3  # of a step with a stated duration
HELD_POSTURES = ("stand", "sit", "kneel", "lie", "lie_on_seat", "recline", "floor_sit")
FALLING_ON_S = (0.8, 1.0)  # minimum and natural time of a stumble that ends in a fall
REPEATED_FROM = 2  # a sentence that fits this often into the time is repeated


def plan_motion(text: str, duration_s: float | None = None) -> MotionPlan:
    """Parses a sentence and schedules its steps; the result is the input of `compose`.

    If the duration is much longer than needed, the sentence is repeated where possible; see `schedule` for shorter
    ones.

    Args:
        text: The sentence.
        duration_s: Duration in seconds; None for the natural one.

    Returns:
        The scheduled plan.

    Raises:
        InputError: As in `parse` and `schedule`.

    >>> plan = plan_motion("a person bows, then waves", 4.0)
    >>> [(step.name, round(step.start_s, 2), round(step.end_s, 2)) for step in plan.steps]
    [('bowing', 0.0, 2.2), ('waving', 2.2, 4.0)]
    """
    plan = parse_sentence(text, in_part=True)
    if duration_s is None:
        return schedule(plan, natural_s(plan))
    return schedule(repeated(plan, duration_s), duration_s)


def schedule(plan: MotionPlan, duration_s: float) -> MotionPlan:
    """Assigns start and end to every step of a plan.

    What does not fit is cut at the end: fewer repetitions, the beginning of a movement, no more movements after it;
    notes and `clauses` report it.

    Args:
        plan: Parsed plan.
        duration_s: Duration in seconds, above 0 and up to `LONGEST_S`.

    Returns:
        The scheduled plan.

    Raises:
        InputError: If the duration is out of range, or too short for the first movement to be recognizable.
    """
    _check(duration_s)
    plan = _cut(plan, duration_s)
    spans = _spans(plan.steps, max(duration_s, least_s(plan)))
    steps: list[Step] = []
    start = 0.0
    for step, span in zip(plan.steps, spans, strict=True):
        steps.append(replace(step, start_s=start, end_s=start + span))
        start += span
    return replace(plan, steps=tuple(steps), duration_s=duration_s)


def _check(duration_s: float) -> None:
    if not (math.isfinite(duration_s) and 0 < duration_s <= LONGEST_S):
        raise InputError(f"a duration of {duration_s:g} s is not possible; choose above 0 and up to {LONGEST_S:g} s")


def natural_s(plan: MotionPlan) -> float:
    """Natural duration of a plan at the person's pace.

    Args:
        plan: Parsed plan.

    Returns:
        Seconds.
    """
    return sum(max(_limits(step)[1] / step.pace, _limits(step)[0]) for step in plan.steps)


def least_s(plan: MotionPlan) -> float:
    """Minimum duration in which a plan can be shown.

    Args:
        plan: Parsed plan.

    Returns:
        Seconds.
    """
    return sum(_limits(step)[0] for step in plan.steps)


def repeated(plan: MotionPlan, duration_s: float) -> MotionPlan:
    """Repeats a plan as often as it fits into a duration, if every step has an end and the last leads to the first.

    Args:
        plan: Parsed plan.
        duration_s: Duration in seconds.

    Returns:
        The repeated plan with a note; `plan` itself if it cannot be repeated.
    """
    _check(duration_s)
    natural = natural_s(plan)
    times = int(duration_s / natural + 1e-6)
    held = any(step.count or step.seconds or step.lower == "turn" or is_elastic(step) for step in plan.steps)
    if held or times < REPEATED_FROM or plan.steps[-1].posture != _posture_before(plan.steps[0]):
        return plan
    note = f"the sentence takes {natural:.1f} s and is done {times} times in {duration_s:.1f} s"
    return replace(plan, steps=plan.steps * times, notes=(*plan.notes, note))


def _posture_before(step: Step) -> str:
    """The posture in which a step begins."""
    rising = {"stand_up": "seat", "kneel_up": "knees", "get_up": "floor", "sit_up": "couch", "floor_rise": "ground"}
    held = {
        "sit": "seat",
        "kneel": "knees",
        "lie": "floor",
        "lie_on_seat": "couch",
        "recline": "seat",
        "floor_sit": "ground",
    }
    return rising.get(step.lower) or held.get(step.lower, "feet")


def _cut(plan: MotionPlan, duration_s: float) -> MotionPlan:
    """The steps that fit into a duration in their minimum times; the last of them perhaps in part."""
    if least_s(plan) <= duration_s + 1e-9:
        return plan
    kept: list[Step] = []
    left = duration_s
    for step in plan.steps:
        fitting = _fitting(step, left, is_first=not kept)
        if fitting is None:
            break
        kept.append(fitting)
        left -= _limits(fitting)[0]
    if not kept:
        first = plan.steps[0]
        needed = math.ceil(10 * _shortest_s(first) - 1e-6) / 10
        raise InputError(
            f"nothing of {plan.text.strip()!r} can be shown in {duration_s:.3g} s; {first.name} alone takes at least"
            f" {needed:.1f} s: ask for more --seconds or --frames, or leave them out"
        )
    return _record_cut(replace(plan, steps=tuple(kept)), plan.steps, duration_s)


def _fitting(step: Step, left_s: float, *, is_first: bool) -> Step | None:
    """The step as it fits into the remaining time: fewer repetitions, shorter, only its beginning, or not at all."""
    least = _limits(step)[0]
    if least <= left_s + 1e-9:
        return step
    if left_s < (_shortest_s(step) if is_first else _shortest_later_s(step)) - 1e-9:
        return None
    if step.seconds:
        usual = replace(step, seconds=0.0)
        return usual if _limits(usual)[0] > left_s and not _is_held(step) else replace(step, seconds=left_s)
    counted_s = BY_KEY[step.upper or step.lower].counted_s
    if step.count and counted_s:
        return replace(step, count=max(1, int((left_s - counted_s[2]) / counted_s[0] + 1e-6)))
    return step


def _shortest_s(step: Step) -> float:
    """Minimum time in which a first step is recognizable: none for one that continues as it begins."""
    whole = BY_KEY[step.lower]
    is_whole = whole.once or (whole.counted_s is not None and step.lower not in PACES)  # a squat
    if not is_whole and (step.lower != "stand" or not step.upper or not BY_KEY[step.upper].once):
        return 0.0
    return _shortest_later_s(step)


def _shortest_later_s(step: Step) -> float:
    """Minimum time left for a step after others."""
    if step.seconds:
        return min(SHORTEST_OF_SECONDS_S, step.seconds)
    return SHORTEST_SHARE * min(_limits(replace(step, count=count))[0] for count in {0, min(step.count, 1)})


def _record_cut(plan: MotionPlan, wanted: tuple[Step, ...], duration_s: float) -> MotionPlan:
    """Reports in notes and clause records what a cut has dropped."""
    notes, clauses = list(plan.notes), list(plan.clauses)

    def record(step: Step, status: str, how: str) -> None:
        notes.append(f"{step.clause or step.name!r}: {how}")
        for number in step.clauses:
            clauses[number] = clauses[number].lowered_to(status, how)

    kept = plan.steps
    given = _seconds_text(duration_s)
    for k, (before, now) in enumerate(zip(wanted, kept, strict=False)):
        is_begun = k == len(kept) - 1 and least_s(plan) > duration_s + 1e-9 and not _is_held(now)
        hows = [f"only its beginning is shown in {given} s"] * is_begun
        if now.count < before.count:
            begun = f"only the beginning of the first of {before.count} times is shown in {given} s"
            hows = [begun if is_begun and now.count == 1 else f"{now.count} of {before.count} times in {given} s"]
        elif now.seconds < before.seconds:
            hows = hows or [f"{_seconds_text(now.seconds)} of {before.seconds:.1f} s"]
        for how in hows:
            record(before, APPROXIMATED, how)
    for step in wanted[len(kept) :]:
        record(step, NOT_DONE, f"the {given} s are over before it")
    return replace(plan, notes=tuple(notes), clauses=add_shown_text(clauses, kept))


def _seconds_text(seconds: float) -> str:
    return f"{seconds:.1f}" if seconds >= 1 else f"{seconds:.2g}"


def _is_held(step: Step) -> bool:
    """Whether a step is a posture that is complete at any moment."""
    return step.lower in HELD_POSTURES and not step.upper


def _limits(step: Step) -> tuple[float, float]:
    """Minimum and natural duration of a step in seconds: longer for 'slowly', shorter for 'quickly' on the spot."""
    least, natural = _usual_limits(step)
    if not step.speed or step.seconds or step.moves:  # travelling takes the same time at another speed
        return least, natural
    slower = 1.0 if step.count and step.speed < 0 else (1.5, 1.0, 0.75)[step.speed + 1]  # counted: in the count
    return least, max(slower * natural, least)


def _usual_limits(step: Step) -> tuple[float, float]:
    """Minimum and natural duration of a step in seconds; speed affects only walks and counted movements here."""
    if step.other_hand is not None:
        both = [_usual_limits(replace(part, lower=step.lower, other_hand=None)) for part in step.each]
        return max(least for least, _ in both), max(natural for _, natural in both)
    if step.seconds:
        return step.seconds, step.seconds
    if step.lower == "turn" and step.turn_deg:
        lasts = 0.3 + abs(step.turn_deg) / 185
        return lasts, lasts + 0.2
    if step.style == FALLING_ON:
        return FALLING_ON_S
    if step.direction == Shape.CIRCLE and step.moves and not step.count:
        return _circle_limits(step)
    if step.direction == Shape.PACING and step.moves and not step.count:
        return BY_KEY[step.lower].least_s, CRAWLING_TO_AND_FRO_S if step.lower == "crawl" else PACING_S
    if step.distance_m and step.moves:
        usual_mps = {"jog": 2.6, "walk": 1.1}.get(step.lower, 0.7) * (0.65, 1.0, 1.3)[step.speed + 1]
        usual_mps = step.speed_mps or STYLED_MPS.get(step.style, (usual_mps,))[0]
        way_m = step.distance_m + TURN_M * max(len(step.route_m) - 1, 0)
        return way_m / (1.4 * usual_mps) + 0.3, way_m / usual_mps + 0.6
    if step.several and not step.count:  # "does squats"
        least, natural = _usual_limits(replace(step, count=2, speed=0))
        return least, max(natural, 2 * BY_KEY[step.lower].natural_s)
    doing = BY_KEY[step.upper or step.lower]
    if step.upper and BY_KEY[step.lower].once and step.posture != "feet":  # "sits down reading"
        doing = BY_KEY[step.lower]
    if step.count and not doing.counted_s:  # "squats three times with the hands on the hips"
        doing = BY_KEY[step.lower]
    if step.count and doing.counted_s:
        least, natural, edges = doing.counted_s
        slower = 1.25 if step.speed < 0 else 1.0
        return step.count * least + edges, (step.count * natural + edges) * slower
    under = BY_KEY[step.lower]
    is_whole = under.once or bool(under.counted_s and not under.moves)  # a squat is completed
    return max(doing.least_s, under.least_s * is_whole), max(doing.natural_s, under.natural_s * is_whole)


def _circle_limits(step: Step) -> tuple[float, float]:
    """Minimum and natural duration of walking in a circle, as many rounds as stated, in seconds."""
    rounds = max(abs(step.arc_deg) / 360, 1.0)
    speed_mps = {"jog": 1.6, "walk": 1.1, "crawl": 0.35, "hop": 0.5, "hop_one_leg": 0.5}.get(step.lower, 0.7) * (
        0.7,
        1.0,
        1.3,
    )[step.speed + 1]
    return rounds * 2 * math.pi * 0.4 / (1.25 * speed_mps) + 0.3, rounds * 2 * math.pi * 0.7 / speed_mps + 0.6


def _is_done_once(step: Step) -> bool:
    """Whether a step takes its natural time only."""
    return BY_KEY[step.lower].once or (step.lower == "stand" and bool(step.upper) and BY_KEY[step.upper].once)


def is_elastic(step: Step) -> bool:
    """Whether a step can continue for any time."""
    rounds = step.direction == Shape.CIRCLE and abs(step.arc_deg) > 360
    return not (_is_done_once(step) or step.count or step.seconds or step.distance_m or rounds)


def _spans(steps: tuple[Step, ...], duration_s: float) -> list[float]:
    """Seconds of each step: between minimum and natural if time is short, else spare time goes to elastic steps."""
    limits: list[tuple[float, float]] = [_limits(step) for step in steps]
    least, natural = sum(limit[0] for limit in limits), sum(limit[1] for limit in limits)
    if duration_s <= natural:
        share = (duration_s - least) / (natural - least) if natural > least else 0.0
        return [low + share * (high - low) for low, high in limits]
    elastic = [is_elastic(step) for step in steps]
    if not any(elastic):
        elastic = [k == len(steps) - 1 for k in range(len(steps))]  # hold the last pose
    weight = sum(limit[1] for limit, free in zip(limits, elastic, strict=True) if free)
    extra = duration_s - natural
    return [high + (extra * high / weight if free else 0.0) for (_, high), free in zip(limits, elastic, strict=True)]
