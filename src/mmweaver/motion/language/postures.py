"""Postures: sitting, kneeling and lying last until the person gets up; missing transitions are inserted."""

import re
from dataclasses import replace
from itertools import pairwise

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.plan import FALLING_ON, Step, Way
from mmweaver.motion.language.posture_persistence import STAYING

RISING = {"seat": ("stand_up",), "knees": ("kneel_up",), "floor": ("get_up",), "couch": ("sit_up", "stand_up")}
STILL = {"seat": "sit", "knees": "kneel", "floor": "lie", "couch": "lie_on_seat"}
_WITH_FREE_HANDS = ("sit_down", "kneel_down")
# Activities done lying, and on which side; "": on either.
LYING = {"push_ups": "front", "plank": "front", "sit_ups": "back", "roll_over": ""}
_ITS_PLACE = re.compile(r"back[_ ]to[_ ]start|\b(?:position|place|spot|pose|posture|stance)\b")
_FALLS_ON = {Way.FORWARDS: "front", Way.BACKWARDS: "back"}  # direction of a stumble -> style of the fall
_WAYS_OF_FALLING = words_in("back backwards backward onback onbelly forward forwards front ahead")
ENTERING = {"sit": "sit_down", "kneel": "kneel_down", "lie": "lie_down", "lie_on_seat": "recline"}


def insert_transitions(steps: list[Step]) -> list[Step]:
    """Inserts the missing transitions: sitting down, kneeling, lying down, getting up.

    Args:
        steps: Steps of the plan.

    Returns:
        All steps, repeated static postures merged.
    """
    result: list[Step] = []
    posture = ""  # not known yet
    for step in steps:
        for one in _transitions_to(step, posture, result):
            result.append(one)
            posture = one.posture
    return merged(_styled(_falling_on(result)))


def _transitions_to(step: Step, posture: str, before: list[Step]) -> list[Step]:
    """The step as performed from a posture, after the transitions that it needs."""
    if step.lower in ("stand_up", "kneel_up", "get_up"):
        return _rising(step, posture, before)
    if posture in STILL and step.lower == "stand" and not step.on_feet:  # "sits down, stays for two seconds"
        return [replace(step, lower=STILL[posture])]
    if step.posture == "feet":
        return [*_rising_steps(posture, step), step] if step.lower != "fall" else [step]
    return _going_down(step, posture, before)


def _rising(step: Step, posture: str, before: list[Step]) -> list[Step]:
    if posture in RISING:
        return [replace(step, lower=lower, seat="") for lower in RISING[posture]]
    if not before:
        return [step]
    if before[-1].lower in ("squat", "pick_up", "put_down", "bow", "bend", "lunge"):
        return []  # these end upright
    return [replace(step, lower="stand")]


def _going_down(step: Step, posture: str, before: list[Step]) -> list[Step]:
    """Sitting, kneeling, lying: stays in the posture, or goes down first."""
    anything_before = bool(before)
    if step.lower == "roll_over" and posture == "couch":
        step = replace(step, lower="roll_in_bed")
    if step.lower in ("recline", "lie_on_seat", "roll_in_bed", "fall_off") or (posture, step.posture) == (
        "couch",
        "seat",
    ):
        return _seat_transitions(step, posture, anything_before)
    if step.lower in LYING:
        is_there = posture == "floor" and LYING[step.lower] in ("", _lies_on(before))
        down = Step(lower="lie_down", style=LYING[step.lower] or "back", clause=step.clause)
        return [step] if is_there or not before else [*_rising_steps(posture, step), down, step]
    if posture == step.posture:
        if step.lower in ("sit_down", "kneel_down", "lie_down", "fall"):
            step = replace(step, lower=STILL[posture])
        return [step]
    first = _rising_steps(posture, step)
    if step.lower == "crawl":
        return [*first, Step(lower="kneel_down", clause=step.clause), step] if before else [step]
    down = ENTERING.get(step.lower, step.lower)
    during = step.upper if step.lower in _WITH_FREE_HANDS and not _is_done_once(step) else ""
    if not anything_before and step.lower == down and step.upper and step.lower != "fall":
        return [replace(step, upper=during, count=0, seconds=0.0), replace(step, lower=STILL[step.posture])]
    if not anything_before:
        return [step]
    if step.upper:  # goes down, then does it there
        return [
            *first,
            replace(step, lower=down, upper=during, count=0, seconds=0.0),
            replace(step, lower=STILL[step.posture]),
        ]
    return [*first, replace(step, lower=down)]


def _lies_on(before: list[Step]) -> str:
    """Side on which a body on the floor lies: front | back | left | right."""
    for step in reversed(before):
        if LYING.get(step.lower):
            return LYING[step.lower]
        if step.lower in ("lie_down", "fall") or (step.lower == "lie" and step.style):
            return step.style or "back"
    return "back"


def _is_done_once(step: Step) -> bool:
    """Whether the hands' movement has a beginning and an end, so that it does not start while going down."""
    activity = BY_KEY[step.upper] if step.upper else None
    return activity is not None and (activity.once or activity.counted_s is not None)


def _seat_transitions(step: Step, posture: str, anything_before: bool) -> list[Step]:
    """Lying on furniture and falling off it, both from sitting; sitting up from lying."""
    if posture == "couch" and step.lower in ("recline", "lie_on_seat"):
        return [replace(step, lower="lie_on_seat")]
    if step.lower == "roll_in_bed" and posture == "couch":
        return [step]
    if step.lower in ("lie_on_seat", "roll_in_bed") and not anything_before:
        return [step]
    about = replace(step, upper="", count=0, seconds=0.0)
    entered = [replace(step, lower="recline")] if step.lower == "lie_on_seat" and not step.upper else [step]
    if step.lower == "roll_in_bed" or (step.lower == "lie_on_seat" and step.upper):
        entered = [replace(about, lower="recline"), step]
    if posture == "couch":
        up = replace(about, lower="sit_up")
        return (
            [up]
            if step.posture == "seat" and not step.upper
            else [up, replace(step, lower="sit")]
            if step.posture == "seat"
            else [up, step]
        )
    if posture == "seat":
        return entered
    sits = "sit" if not anything_before and step.lower == "fall_off" else "sit_down"
    return [*_rising_steps(posture, step), replace(about, lower=sits), *entered]


def _rising_steps(posture: str, step: Step) -> list[Step]:
    return [Step(lower=lower, clause=step.clause) for lower in RISING.get(posture, ())]


def _falling_on(steps: list[Step]) -> list[Step]:
    """A stumble with a fall continues in its direction, without coming upright first: `FALLING_ON`."""
    for k, (before, step) in enumerate(pairwise(steps)):
        if before.lower != "stumble" or step.lower != "fall" or before.style:
            continue
        on_front = step.style == "front" or "stumbl" in before.clause
        way = before.direction or (Way.FORWARDS if on_front else Way.BACKWARDS)
        says_how = bool(words_in(step.clause) & _WAYS_OF_FALLING) or step.style not in ("front", "back")
        if not says_how and way in _FALLS_ON:
            steps[k + 1] = step = replace(step, style=_FALLS_ON[way])
        if step.style == _FALLS_ON.get(way):
            steps[k] = replace(before, direction=way, style="" if before.seconds else FALLING_ON)
    return steps


def _styled(steps: list[Step]) -> list[Step]:
    """Lying on back or belly as the person went down; kneeling on the named knee."""
    style, foot, knee = "", "", ""
    for k, step in enumerate(steps):
        if step.lower in LYING:
            style = LYING[step.lower] or style or "back"
        if step.lower in ("lie_down", "fall", "fall_off") or (step.lower in ("lie", "get_up") and not style):
            style = step.style or "back"
        if step.posture == "knees":
            foot, knee = step.foot or foot, step.style or knee
        if step.lower in ("lie", "get_up", "lie_down", "fall", "fall_off", *LYING):
            steps[k] = replace(step, style=style)
        if step.lower in ("kneel", "kneel_up"):
            steps[k] = replace(step, foot=foot, style=knee)
        if step.lower in ("stand_up", "get_up", "kneel_up"):
            style, foot, knee = "", "", ""
    return steps


def inherit_state(steps: list[Step]) -> list[Step]:
    """Resolves what a step takes over from earlier ones.

    'Walks back' returns if the person has walked before, goes on after a turn, else goes backwards; objects that were
    picked up are put down with the same hands.

    Args:
        steps: Steps of the plan, modified in place.
    """
    gone = False
    for k, step in enumerate(steps):
        if step.direction == Way.BACK and not gone and k and _ITS_PLACE.search(step.clause):  # not moved away
            steps[k] = replace(step, lower="stand", direction=None)
        elif step.direction == Way.BACK and not gone:  # "turns around and walks back" goes along the new heading
            turned = k > 0 and steps[k - 1].lower == "turn"
            steps[k] = replace(step, direction=Way.FORWARDS if turned else Way.BACKWARDS)
        gone = gone or step.moves
        lifted = next((one for one in reversed(steps[:k]) if one.lower == "pick_up"), None)
        if step.lower == "put_down" and not step.hand and lifted is not None:
            steps[k] = replace(step, hand=lifted.hand)
    return steps


def merged(steps: list[Step]) -> list[Step]:
    """Merges two equal static postures in a row, unless the second is a pause before the next movement.

    Args:
        steps: Steps in temporal order.
    """
    result: list[Step] = []
    for number, step in enumerate(steps, start=1):
        plain = (
            step.lower in ("sit", "stand", "kneel", "lie", "lie_on_seat")
            and not step.upper
            and not step.seconds
            and not step.facing
            and not (number < len(steps) and _is_a_pause(step))
        )
        same = {
            "sit": ("sit", "sit_down"),
            "kneel": ("kneel", "kneel_down"),
            "lie": ("lie", "lie_down", "fall", "fall_off"),
            "lie_on_seat": ("lie_on_seat", "recline"),
        }.get(step.lower, (step.lower,))
        if not (plain and result and result[-1].lower in same and not result[-1].upper):
            result.append(step)
    return result


def _is_a_pause(step: Step) -> bool:
    """Whether a posture is a deliberate pause: 'pauses', 'lies there for a bit'."""
    return step.lower != "stand" and bool((STAYING | {"there"}) & {*step.clause.split()})
