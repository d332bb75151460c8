"""What a body activity of a step shows, in words: with its leg, its way, its seat, what it lies on."""

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.named_counts import PACES, SPEEDS_SAID, how_often, steps_said, times_said
from mmweaver.motion.language.named_hands import hand_of, with_hand
from mmweaver.motion.language.plan import Step

_SIDES = ("left", "right")
_BODY = {  # with the slots "leg" and "foot"; others by their names
    "pick_up": "picking something up from the floor", "put_down": "putting something down on the floor",
    "jumping_jacks": "doing jumping jacks", "push_ups": "doing push-ups", "sit_ups": "doing sit-ups",
    "leap": "jumping", "stand_up": "standing up from a seat", "stomp": "stamping with {foot}",
    "kick": "kicking with {foot}", "raise_leg": "raising and lowering {leg}", "one_leg": "standing on {leg}",
    "limp": "limping on {leg}",
    "hop_one_leg": "hopping on {leg}", "lunge": "lunging ahead with {leg}",
    "side_lunge": "lunging to the side with {leg}, the arms out to the sides",
    "limb_extension": "extending {leg} and the arm of that side to the side",
    "roundhouse": "a roundhouse kick with {foot}", "side_kick": "kicking to the side with {foot}",
    "roll_over": "rolling onto {own_side} and back", "roll_in_bed": "rolling onto {own_side} and back on furniture",
    "twist": "twisting the trunk to both sides", "fall_off": "falling off a seat",
}  # fmt: skip
_WAYS = {
    **{way: f" {way}" for way in ("forwards", "backwards", "away", "around")},
    **{side: f" to the {side} in the photo" for side in _SIDES}, "away": " away from the radar",
    "towards": " towards the radar", "pacing": " to and fro", "spot": " on the spot", "seat": " to a seat",
    "back": " back the way it came",
}  # fmt: skip
_ONTO = {
    "back": "on the back", "front": "on the belly", **{side: f"on the person's {side} side" for side in _SIDES},
}  # fmt: skip
_LYING = words_in("lie lie_down fall")


def of_the_body(step: Step) -> str:
    """A body activity: 'walking three steps backwards', 'lunging ahead with the left leg twice'."""
    name = _BODY.get(step.lower, BY_KEY[step.lower].name)
    if step.lower == "jog" and step.style != "jog":
        name = "running"
    if step.lower == "kneel_up" and step.style == "knee":
        name = f"standing up from the {step.foot} knee" if step.foot else "standing up from one knee"
    if step.lower == "turn":
        return f"turning{_turn(step)}{SPEEDS_SAID[step.speed]}"
    if step.lower == "lunge" and not step.foot and (step.count > 1 or step.style):
        name = "lunging ahead with each leg in turn"
    which = f"the {step.foot}" if step.foot else "one"
    own_side = f"the person's {step.direction} side" if step.direction in _SIDES else "a side"
    name = name.format(foot=f"{which} foot", leg=f"{which} leg", own_side=own_side)
    if step.lower in ("pick_up", "put_down"):
        name += with_hand(hand_of(step, step.lower))
    paces = f" {steps_said(step.count)}" if step.lower in PACES and step.count and not step.upper else ""
    return f"{name}{paces}{_way(step)}{SPEEDS_SAID[step.speed]}{how_often(step, step.lower)}"


def _way(step: Step) -> str:
    """Where it goes, leans or lies, and on what."""
    if step.lower in _LYING:
        return f" {_ONTO.get(step.style, 'on the back')}"
    if step.lower == "kneel_up" and step.style == "knee":
        return ""
    if step.style == "knee":
        return f" on the {step.foot} knee" if step.foot else " on one knee"
    if step.lower == "fall_off":
        return f" to the person's {step.style}"
    if step.uses_seat:
        return f" on the {step.seat}" if step.seat and step.lower != "stand_up" else ""
    if step.lower == "lean":
        way = {"backwards": " backwards", "": " to one side"}.get(step.direction, f" to the person's {step.direction}")
        return (
            way
            if step.upper
            else way + {"held": " and staying so", "released": ", staying so and coming up"}.get(step.style, "")
        )
    if step.lower == "bend" and step.style in ("held", "released") and not step.upper:
        return " and staying down" if step.style == "held" else ", staying down and coming up"
    if step.lower in ("kick", "roundhouse"):
        return {"back": " to the back", "high": " high up"}.get(step.style, "")
    if not step.moves or step.lower == "forward_roll":
        return _WAYS["spot"] if step.direction == "spot" and step.lower == "jog" else ""
    return _going(step)


def _going(step: Step) -> str:
    """Where something leads that changes the position on the floor."""
    if step.direction == "circle":
        return f" in a circle{_round(step)}"
    if step.arc_deg:
        backwards = " backwards" if step.direction == "backwards" else ""
        return f"{backwards} in an arc of {abs(step.arc_deg):g} degrees{_own_side(step.arc_deg, step.style)}"
    to = f" {step.distance_m:g} m" if step.distance_m else ""
    if step.target or (step.seat and step.direction == "seat"):
        return f"{to} to the {step.target or step.seat}"
    if step.lower == "sidestep" and step.direction not in _SIDES:
        return f"{to} to a side"
    return to + _WAYS.get(step.direction, "")


def _round(step: Step) -> str:
    if step.style == "either" or not step.arc_deg:
        way = ""
    else:
        way = " counterclockwise" if step.arc_deg > 0 else " clockwise"
    rounds = round(abs(step.arc_deg) / 360)
    return way + (f", {times_said(rounds)} round" if rounds > 1 else "")


def _turn(step: Step) -> str:
    """Which way a turn goes and how far, or what the person faces then."""
    if step.facing:
        facing = {"towards": "to face the radar", "away": "to face away from the radar"}
        aim = f"to face {step.facing} in the photo" if step.facing in _SIDES else f"to face the {step.facing}"
        return f" {facing.get(step.facing, aim)}"
    if step.turn_deg:
        return f" {abs(step.turn_deg):g} degrees{_own_side(step.turn_deg, step.style)}"
    return f" 90 degrees to the person's {step.direction}" if step.direction in _SIDES else " around"


def _own_side(angle_deg: float, style: str) -> str:
    return "" if style == "either" else f" to the person's {'left' if angle_deg > 0 else 'right'}"
