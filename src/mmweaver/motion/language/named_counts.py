"""How often, with how many steps and how fast a step is shown, in words."""

from mmweaver.motion.language.activities import BY_KEY, words_in
from mmweaver.motion.language.plan import Step

# Done once where the sentence has no number, though they do not end the step; again and again within two seconds.
_ONCE = words_in("lunge roll_over roll_in_bed raise point swipe")
_RHYTHMIC = words_in(
    """
    hop hop_one_leg jumping_jacks wave clap knock nod shake_head arm_circles punch push_ups sit_ups stairs count_fingers
    """
)
PACES = words_in("walk jog sidestep limp stagger march walking_lunge")
SPEEDS_SAID = {-1: " slowly", 0: "", 1: " quickly"}
_SMALL_NUMBERS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven")


def how_often(step: Step, key: str) -> str:
    """How often an activity is repeated, where it can be."""
    activity = BY_KEY[key]
    if activity.counted_s is None or key in PACES or step.style in ("held", "released"):
        return ""
    if step.count:
        return f" {times_said(step.count)}"
    is_once = (activity.once or key in _ONCE) and step.style != "frontlunge"
    if step.style == "several" and not activity.hands and not (is_once and step.upper):
        return " twice or more"
    if is_once:
        return " once"
    return " repeatedly" if key in _RHYTHMIC else " once or more"


def times_said(count: int) -> str:
    return {1: "once", 2: "twice"}.get(count, f"{_number(count)} times")


def steps_said(count: int) -> str:
    return "one step" if count == 1 else f"{_number(count)} steps"


def _number(count: int) -> str:
    return _SMALL_NUMBERS[count] if count < len(_SMALL_NUMBERS) else str(count)
