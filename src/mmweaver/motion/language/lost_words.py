"""What a clause says that its steps do not show: sides, arms, circles and counts without a place in any step."""

from collections.abc import Sequence

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.lexicon import ARMS, NUMBERS, TIMES
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import words_in
from mmweaver.motion.language.words import Word

_SIDES = frozenset({"left", "right"})
# Activities of the whole body in which the arms have their part, or words for hands that name a place.
_WITH_ARMS = words_in(
    """
    crawl push_ups plank downward_dog jumping_jacks limb_extension fall pick_up put_down dance kneel_down kneel_up kneel
    get_up stand_up stretch sit_down one_leg golf turn stumble warrior_pose tree_pose lie lie_down recline lie_on_seat
    bow stairs side_lunge lunge
    """
)


# Activities in which one hand or foot is not distinguished from the other.
_WITHOUT_ONE_HAND = words_in("clap type read nod shake_head look_around cross_arms hips shrug stretch hands_up breathe")
_WITH_ONE_FOOT = words_in(
    """
    limp hop_one_leg one_leg kick stomp raise_leg lunge side_lunge limb_extension kneel_down kneel_up stairs tree_pose
    warrior_pose
    """
)


def lost_words(words: Sequence[Word], steps: Sequence[Step]) -> list[str]:
    """What of a clause is in none of the steps that carry it out, as sentences for its record."""
    texts = [word.text for word in words]
    lost = []
    if _side_of_a_limb(texts) and not any(step.hand or step.foot for step in steps):
        lost.append("which hand or foot it is is not shown")
    elif _SIDES & set(texts) and not any(_has_side(step) for step in steps):
        lost.append("the side is not shown")
    if ARMS & set(texts) and not any(step.upper or step.lower in _WITH_ARMS for step in steps):
        lost.append("what the arms do is not shown")
    if "in_circle" in texts and not any(_is_round(step) for step in steps):
        lost.append("the circle is not shown")
    if "sideways" in texts and not any(_has_side(step) or step.lower == "sidestep" for step in steps):
        lost.append("the side is not shown")
    if {*TIMES, "times"} & set(texts) and not any(_is_counted(step) for step in steps):
        lost.append("how often is not kept")
    paces = {"step", "steps"} & set(texts) and any(text in NUMBERS or text.isdigit() for text in texts)
    if paces and all(step.upper for step in steps if step.moves) and any(step.moves for step in steps):
        lost.append("the number of steps is not kept")
    handed = [step for step in steps if step.hand and (step.upper or step.lower in ("pick_up", "put_down"))]
    if any(step.hand in _SIDES for step in steps) and all(step.upper in _WITHOUT_ONE_HAND for step in handed):
        lost.append("which hand or foot it is is not shown")
    if any(step.foot and step.lower not in _WITH_ONE_FOOT for step in steps):
        lost.append("which foot it is is not shown")
    return list(dict.fromkeys(lost))


def _side_of_a_limb(texts: list[str]) -> bool:
    """Whether a side names a hand or a leg, not a direction."""
    for i, text in enumerate(texts):
        if text in ("left_leg", "right_leg"):
            return True
        if text in _SIDES and ARMS & set(texts[i + 1 : i + 3]) and not {"with", "and"} & set(texts[i + 1 : i + 2]):
            return True
    return False


def _has_side(step: Step) -> bool:
    """Whether a step goes, turns, looks or is done to one side, or with one hand or foot."""
    directed = step.moves or step.lower in ("turn", "stumble", "leap", "sidestep", "walk", "jog")
    sides = {step.direction if directed else "", step.style, step.facing, step.hand, step.foot}
    signed = (step.arc_deg and step.style != "either") or (step.turn_deg and step.style != "either")
    placed = step.place is not None or step.target
    return bool(sides & {"left", "right", "both", "side", "seat"} or signed or placed or step.lower == "sidestep")


def _is_round(step: Step) -> bool:
    return bool(
        step.direction == "circle"
        or step.arc_deg
        or step.turn_deg
        or step.lower == "turn"
        or step.upper in ("draw_circle", "stir", "arm_circles", "wipe")
    )


def _is_counted(step: Step) -> bool:
    """Whether it is done as often as the sentence says."""
    countable = BY_KEY[step.upper or step.lower].counted_s is not None
    return bool(
        (step.count and (countable or step.count == 1)) or abs(step.turn_deg) >= 360.0 or abs(step.arc_deg) >= 360.0
    )
