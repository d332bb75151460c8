"""What an activity of the hands shows, in words: with the hand or arm that does it, and where that goes."""

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.named_counts import SPEEDS_SAID, how_often
from mmweaver.motion.language.plan import Step

_SIDES = ("left", "right")
_HANDS = {  # with the slots "hand", "arm", "forearm" of the side that acts
    "raise": "raising {hand} overhead and lowering it", "raise_hold": "lifting {arm} overhead and keeping it up",
    "lower_arm": "lowering {arm} from overhead", "push_hand": "pushing {hand} forward",
    "pull_hand": "pulling {hand} to the chest", "knock_elbow": "raising and lowering {forearm}",
    "arm_extension": "extending {arm} upwards at the side", "arm_circles": "circling {arm} at the sides",
    "draw_circle": "drawing a circle in the air with {hand}", "draw_z": "drawing a Z in the air with {hand}",
    "hands_up": "holding the hands up before the face", "sweep": "sweeping the floor with both hands",
    "swipe": "swiping {hand} through the air", "cross_arms": "holding the arms crossed",
    "golf": "a golf swing with both hands", "carry": "carrying something",
}  # fmt: skip
# Activities of one hand, and those of both unless the sentence names one.
_ONE_HANDED = words_in(
    """
    wave raise drink eat phone brush_teeth comb wipe write stir knock open_door point throw reach raise_hold lower_arm
    push_hand pull_hand draw_circle draw_z swipe yawn knock_elbow arm_extension cough vacuum jab cross forehand backhand
    tennis_serve pick_up put_down hook uppercut
    """
)
_OF_BOTH = {  # activities that move one hand where the sentence says both
    **dict.fromkeys(words_in("eat phone brush_teeth comb wipe write stir open_door point throw"), "right"),
    **dict.fromkeys(words_in("swipe draw_circle draw_z yawn cough vacuum drink"), "left"),
}
_BOTH = words_in("arms_out hips arm_circles push pull carry")
_IN_TURN = words_in("punch jab cross hook uppercut")
_LIMBS = ("{hand}", "{arm}", "{forearm}")
_HEIGHTS = {"high": " high up", "up": " upwards", "down": " downwards", "under": " underarm"}


def of_a_hand(step: Step, part: Step) -> str:
    """What one activity of the hands shows, with its limb; `step` is the whole of it."""
    key, hand = part.upper, hand_of(part, part.upper)
    name = _HANDS.get(key, BY_KEY[key].name)
    if key == "arms_out":
        arms = "the arms" if hand == "both" else f"the {hand} arm"
        way = "ahead" if part.arms_ahead else "to the sides" if hand == "both" else "to the side"
        name = f"holding {arms} out {way}"
    elif key == "hips":
        name = "holding the hands on the hips" if hand == "both" else f"holding the {hand} hand on the hip"
    elif key == "raise_hold" and step.lower != "stand":  # it is up already, or comes up meanwhile
        name = "holding {arm} up overhead"
    elif key == "look_around":
        name = {"down": "looking down", **{side: f"looking to the {side} in the photo" for side in _SIDES}}.get(
            part.facing or part.direction, "looking around to both sides"
        )
    elif key == "point":
        side = part.facing or part.direction
        name = f"pointing to the {side} in the photo" if side in _SIDES else "pointing ahead"
    elif key == "swipe":
        across = "" if part.style else " across the body"
        name += f" to the person's {part.direction}" if part.direction in _SIDES else across
    if any(limb in name for limb in _LIMBS):
        which = "both" if hand == "both" else "one" if hand == "one" else f"the {hand}"
        name = name.format(**{limb: f"{which} {limb}{'s' * (hand == 'both')}" for limb in ("hand", "arm", "forearm")})
        name = name.replace("ing it", "ing them") if hand == "both" else name
    elif hand and key not in ("arms_out", "hips"):
        name += with_hand(hand) + " in turn" * (hand == "both" and key in _IN_TURN)
    speed = (part.speed or step.speed) if step.lower == "stand" else 0
    return f"{name}{_HEIGHTS.get(part.style, '')}{SPEEDS_SAID[speed]}{how_often(part, key)}"


def with_hand(hand: str) -> str:
    return {"both": " with both hands", "one": " with one hand"}.get(hand, f" with the {hand} hand")


def hand_of(part: Step, key: str) -> str:
    """The hand that acts: left, right, both, "one" where the seed chooses it, "" for what needs both anyway."""
    if key in _ONE_HANDED:
        return _OF_BOTH.get(key, "both") if part.hand == "both" else part.hand or "one"
    if key in ("punch", "text"):  # a phone is in one hand or both where the sentence names none
        return part.hand or (("one" if part.count == 1 else "both") if key == "punch" else "")
    return (part.hand or "both") if key in _BOTH else ""
