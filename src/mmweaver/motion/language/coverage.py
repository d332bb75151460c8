"""Every word of a clause is carried out by one of its steps, says nothing about the movement, or is named as not shown.

Checked once all clauses have their steps: sides, arms, circles, numbers, manners, sizes and places that no step has.
"""

import re
from collections.abc import Sequence

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.lexicon import ARMS, MANNERS, NUMBERS, PASSED, SIZES, TARGETS, TIMES
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verb_steps import LEGS
from mmweaver.motion.language.verbs import words_in
from mmweaver.motion.language.words import Word

_SIDES = frozenset({"left", "right"})
# Activities of the whole body in which the arms have their part, or words for hands that name a place.
_WITH_ARMS = words_in(
    """
    crawl push_ups plank downward_dog jumping_jacks limb_extension fall pick_up put_down dance kneel_down kneel_up kneel
    get_up stand_up stretch sit_down golf turn stumble warrior_pose tree_pose lie lie_down recline lie_on_seat
    bow stairs side_lunge lunge sit_ups pedal roundhouse side_kick hula_hoop forward_roll roll_over roll_in_bed
    """
)


_ON_FOOT = words_in("step steps stepping walk walks walking run runs running jog jogs jogging")
# Activities in which one hand or foot is not distinguished from the other.
_WITHOUT_ONE_HAND = words_in("clap type read nod shake_head look_around cross_arms shrug stretch hands_up breathe")
_EITHER_WAY = words_in("draw_circle")
_TO_A_SIDE = words_in(
    "side_kick swipe roll_over roll_in_bed sidestep side_lunge limb_extension lean arms_out arm_extension"
)
_WITH_ONE_FOOT = words_in(
    """
    limp hop_one_leg one_leg kick roundhouse side_kick stomp raise_leg lunge side_lunge limb_extension kneel_down
    kneel_up stairs tree_pose warrior_pose
    """
)


def not_shown(words: Sequence[Word], steps: Sequence[Step]) -> list[str]:
    """What of a clause is in none of the steps that carry it out, as sentences for its record."""
    texts = [word.text for word in words]
    lost = [f"{text!r} is not shown" for text in texts if text in MANNERS]
    lost += [f"the number {text!r} is not kept" for text in _lost_numbers(words, steps)]
    lost += [f"{place!r} is not shown" for place in _lost_places(texts, steps)]
    lost += _lost_aims(texts, steps)
    if _side_of_a_limb(texts) and not any(step.hand or step.foot for step in steps):
        lost.append("which hand or foot it is is not shown")
    elif any(not any(_goes_to(step, side) for step in steps) for side in sides_gone_to(texts)):
        lost.append("the side is not shown")
    if ARMS & set(texts) and not any(step.upper or step.lower in _WITH_ARMS for step in steps):
        lost.append("what the arms do is not shown")
    if "in_circle" in texts and not any(goes_round(step) for step in steps):
        lost.append("the circle is not shown")
    if "sideways" in texts and not any(goes_aside(step) for step in steps):
        lost.append("the side is not shown")
    aimed_back = "back_to_start" in texts and not any(step.direction == "backwards" for step in steps)
    turned = {"away", "backwards"} <= set(texts) and not any(step.direction == "backwards" for step in steps)
    if {"backwards", "backward"} & set(texts) and (aimed_back or turned or not any(goes_back(step) for step in steps)):
        lost.append("'backwards' is not shown")
    goes = any(step.moves for step in steps)
    comes_back = any(step.lower in ("stand", "turn") for step in steps) and not _ON_FOOT & set(texts)
    if "back_to_start" in texts and not (goes or comes_back):
        lost.append("the way back is not shown")
    if {*TIMES, "times"} & set(texts) and not any(_is_counted(step) for step in steps):
        lost.append("how often is not kept")
    if any(step.hand in _SIDES for step in steps) and not any(moves_one_hand(step) for step in steps):
        lost.append("which hand or foot it is is not shown")
    if any(step.foot and step.lower not in _WITH_ONE_FOOT for step in steps):
        lost.append("which foot it is is not shown")
    return list(dict.fromkeys(lost))


def _lost_aims(texts: list[str], steps: Sequence[Step]) -> list[str]:
    """What is faced, where somebody goes who is shown on the spot, and how high the hands are."""
    lost = []
    for i, text in enumerate(texts):
        if text in ("facing", "faces") and not any(step.facing or step.lower == "turn" for step in steps):
            lost.append(f"{' '.join(texts[i : i + 3])!r} is not shown")
    if "pacing_to_and_fro" in texts and not any(step.moves for step in steps):
        lost.append("where it goes is not shown")
    if any(step.upper in ("clap", "wave") for step in steps):
        lost += [f"{text!r} is not shown" for text in texts if text in ("above", "overhead", "over")]
    return lost


def _side_of_a_limb(texts: list[str]) -> bool:
    """Whether a side names a hand or a leg, not a direction."""
    for i, text in enumerate(texts):
        if text in ("left_leg", "right_leg"):
            return True
        if text in _SIDES and ARMS & set(texts[i + 1 : i + 3]) and not {"with", "and"} & set(texts[i + 1 : i + 2]):
            return True
    return False


def sides_gone_to(texts: list[str]) -> list[str]:
    """The sides of directions, not those of limbs."""
    limbs = ARMS | LEGS
    return [text for i, text in enumerate(texts) if text in _SIDES and not limbs & set(texts[i + 1 : i + 3])]


def _goes_to(step: Step, side: str) -> bool:
    """Whether a step goes, turns, looks or is done to one side, or is done with the hand or foot of this side."""
    return goes_aside(step) or {step.hand, step.foot} & {side, "both"} != set()


def goes_aside(step: Step) -> bool:
    """Whether a step goes, turns, looks or is done to one side."""
    directed = step.moves or step.lower in ("turn", "stumble", "leap", "sidestep", "walk", "jog", "lean")
    sides = {step.direction if directed else "", step.style, step.facing}
    signed = (step.arc_deg and step.style != "either") or (step.turn_deg and step.style != "either")
    placed = step.place is not None or step.target or (step.seat and step.moves)
    if step.upper in _EITHER_WAY:  # "clockwise" is a way round, and no side
        return True
    to_a_side = {step.lower, step.upper} & _TO_A_SIDE and not step.arms_ahead
    return bool(sides & {"left", "right", "side", "seat"} or signed or placed or to_a_side)


def sides_of(step: Step) -> set[str]:
    """Left and right, of the directions, turns, limbs and looks of a step."""
    way = step.direction if step.upper not in ("look_around", "point") else ""
    sides = {way, step.style, step.facing, step.hand, step.foot} & _SIDES
    sides |= _SIDES if "both" in (step.hand, step.foot) else set()
    for angle_deg in (step.arc_deg, step.turn_deg):
        if angle_deg and step.style != "either":
            sides.add("left" if angle_deg > 0 else "right")
    return sides


def moves_one_hand(step: Step) -> bool:
    """Whether a step moves a hand that may be the left or the right one."""
    return bool(step.hand) and (
        (bool(step.upper) and step.upper not in _WITHOUT_ONE_HAND) or step.lower in ("pick_up", "put_down")
    )


def goes_back(step: Step) -> bool:
    back = step.direction in ("backwards", "back", "pacing", "away") or step.style == "back"
    return back or step.place is not None or step.lower in ("lie", "lie_down", "fall", "turn")


def goes_round(step: Step) -> bool:
    return bool(
        (step.direction == "circle" and step.moves)
        or step.arc_deg
        or step.turn_deg
        or step.lower in ("turn", "hula_hoop")
        or step.upper in ("draw_circle", "stir", "arm_circles", "wipe")
    )


def _is_counted(step: Step) -> bool:
    """Whether it is done as often as the sentence says."""
    countable = any(BY_KEY[key].counted_s is not None for key in (step.upper or step.lower, step.lower))
    return bool(
        (step.count and (countable or step.count == 1)) or abs(step.turn_deg) >= 360.0 or abs(step.arc_deg) >= 360.0
    )


def _lost_numbers(words: Sequence[Word], steps: Sequence[Step]) -> list[str]:
    """Numbers of movements that no step has; "one", and numbers of limbs, are no such numbers."""
    kept = {float(step.count) for step in steps} | {step.seconds for step in steps} | {0.0, 1.0}
    kept |= {step.distance_m for step in steps}
    turned_deg = {abs(step.turn_deg) for step in steps} | {abs(step.arc_deg) for step in steps}
    kept |= turned_deg | {angle / whole for angle in turned_deg for whole in (90.0, 180.0, 360.0)}
    if any(step.place is not None for step in steps):
        kept |= {step.place.distance_m for step in steps if step.place is not None}
    lost = []
    for i, word in enumerate(words):
        if word.text in TIMES or not (word.text in NUMBERS or word.text.isdigit()):
            continue
        following = [other for other in words[i + 1 : i + 3] if other.text not in SIZES | _SIDES]
        counted = following and (following[0].is_activity or following[0].text in ("step", "steps", "times", "circles"))
        if counted and float(NUMBERS.get(word.text, word.text)) not in kept:
            lost.append(word.text)
    return lost


def _lost_places(texts: list[str], steps: Sequence[Step]) -> list[str]:
    """Phrases like "through the door" and "to the window" of a walk that goes nowhere in particular."""
    if not any(step.moves for step in steps):
        return []
    goes = any(step.target or step.place or step.uses_seat or step.upper or step.direction == "seat" for step in steps)
    lost = []
    for i, text in enumerate(texts):
        if text != "from" and (goes or text not in PASSED):  # the thing is where it goes, or what the hands are at
            continue
        noun = next((k for k in range(i + 1, min(i + 5, len(texts))) if texts[k] in TARGETS), None)
        if noun is not None:
            lost.append(" ".join(texts[i : noun + 1]))
    return lost


_SIZED = (
    "steps? strides? circles? jumps? leaps? hops? bows? kicks? waves? curves? arcs? bends? punch(?:es)? movements?"
    " motions? squats? lunges? rounds? laps?"
).replace(" ", "|")
_SIZE = re.compile(
    rf"\b({'|'.join(sorted(SIZES))})(?:,? (?:and )?[a-z-]+)?? (?:{_SIZED})\b"
    r"|\b(high|deeply|low|wide|widely|far)(?= *(?:$|[,.;]| and\b| then\b| while\b))"
)
# Activities that are as large as that anyway, or known in two sizes.
_LARGE = words_in("raise raise_hold draw_circle draw_z breathe arms_out hands_up arm_extension stretch")


def sizes_not_shown(text: str, steps: Sequence[Step]) -> list[str]:
    """The sizes of movements that a sentence names; no movement of the library is larger or smaller on request."""
    if any(step.upper in _LARGE or step.style == "high" or step.lower in ("crouch", "fall") for step in steps):
        return []
    found = [match[1] or match[2] for match in _SIZE.finditer(text.lower())]
    return [f"{size!r} is not shown" for size in dict.fromkeys(found)]
