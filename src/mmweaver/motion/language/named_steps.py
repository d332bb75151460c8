"""What a step shows, in words."""

from collections.abc import Iterable
from itertools import groupby

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.plan import Step

_ONE = ("left", "right")
# Words with other senses: "picking up speed", "sweeping with a foot".
_PLAINLY = {"pick_up": "picking something up from the floor", "sweep": "sweeping the floor"}
_AIMED = ("turn", "stumble", "lean", "leap")
_WAYS = {
    **{way: f" {way}" for way in ("forwards", "backwards", "away", "back", "around")},
    **{side: f" to the {side}" for side in _ONE}, "towards": " towards the radar", "pacing": " to and fro",
    "circle": " in a circle", "spot": " on the spot",
}  # fmt: skip


def in_turn(steps: Iterable[Step]) -> str:
    """Steps in the order in which they are shown: 'walking backwards, then standing'."""
    return ", then ".join(name for name, _ in groupby(map(doing, steps)))


def doing(step: Step) -> str:
    """What a step shows, with its way or side: 'walking backwards', 'kicking with the left foot'."""
    limb = (
        f" with the {step.hand} hand"
        if step.hand in _ONE
        else f" with the {step.foot} foot"
        if step.foot in _ONE
        else ""
    )
    limb = " with both hands" if step.hand == "both" and step.upper else limb
    way = _WAYS.get(step.direction, "") if step.moves or step.lower in _AIMED else ""
    way = f" to the {step.target}" if step.moves and step.target else way
    if step.lower == "turn" and (step.turn_deg or step.direction in _ONE):
        way = f" {abs(step.turn_deg) or 90:g} degrees{way}"
    upper = _PLAINLY.get(step.upper, BY_KEY[step.upper].name) if step.upper else ""
    if step.upper == "raise":
        upper, limb = (
            {"": "raising a hand", "both": "raising both hands"}.get(step.hand, f"raising the {step.hand} hand"),
            "",
        )
    lower = "" if step.lower == "stand" and upper else f"{_PLAINLY.get(step.lower, BY_KEY[step.lower].name)}{way}"
    return " and ".join(filter(None, (lower, upper))) + limb
