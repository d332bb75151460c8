"""Modifiers: the words of a clause other than its verbs, as fields of a Step."""

from dataclasses import replace
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.motion.language.lexicon import ARMS, BOTH, DIRECTIONS, NUMBERS, OWN, RADAR, SEATS, SPEEDS, TARGETS, TIMES
from mmweaver.motion.language.measures import CADENCE, SPEED
from mmweaver.motion.language.places import AIM
from mmweaver.motion.language.plan import Direction, Shape, Side, Step, Way, direction_of
from mmweaver.motion.language.words import Word

OPPOSITE: dict[Any, Side] = {Side.LEFT: Side.RIGHT, Side.RIGHT: Side.LEFT}
MAX_COUNT = 60
_WHOM = frozenset({"it", "them", "someone", "somebody", "you", "him", "her", "then", "and", "person", "front"})
_LEGGED = frozenset({"walk", "run", "jog", "jump", "hop", "leap", "step", "go", "move", "sidestep", "squat", "skip"})
_OF_A_LEG = frozenset({"ankle", "thigh", "calf", "shin", "heel", "toe", "toes"})
_OF_THE_BODY = frozenset({"shoulder", "elbow", "ear", "eye", "cheek", "hip", "buttock", "breast", "collar"})
_THAT_ONE = ("first", "second", "this", "that", "the", "other", "each", "every", "no", "which")
STYLE = "style_"  # begins a token for the style of a step: style_cane
_TOKENS = ("onback", "onbelly", "lookdown", "highkick", "frontlunge")


def modifiers(words: list[Word], clause_text: str, notes: list[str]) -> Step:
    """The modifiers of a clause as a Step without a verb.

    Args:
        words: Words of the clause.
        clause_text: Its text.
        notes: Assumptions are appended to it.
    """
    about = Step(clause=clause_text)
    texts = {word.text for word in words}
    for i, word in enumerate(words):
        text, after = word.text, words[i + 1].text if i + 1 < len(words) else ""
        before = words[i - 1].text if i else ""
        if text in SPEEDS:
            about = replace(about, speed=SPEEDS[text])
        elif text in ("left", "right"):
            about = _left_or_right(about, words, i, notes)
        elif text in BOTH or (text == "two" and after in ARMS):
            about = replace(about, hand=about.hand or "both")
        elif text in SEATS:
            about = replace(about, seat=text)
        elif text == "back" and before in (*OWN, "hollow", "straight", "bent", "hurting", "aching"):
            continue  # a part of the body
        elif text in DIRECTIONS:
            about = _direction(about, text, words, i)
        elif "_" in text or text.startswith(("arc", "deg")) or text in _TOKENS:
            about = _token(about, text, texts)
        elif text in TIMES or text in NUMBERS or text.replace(".", "").isdigit():
            about = _number(about, text, words, i)
    return about


def _left_or_right(about: Step, words: list[Word], i: int, notes: list[str]) -> Step:
    """Names the arm that follows; otherwise it is a direction, the viewer's unless "his left" makes it the person's."""
    text, before, after = words[i].text, words[i - 1].text if i else "", words[i + 1].text if i + 1 < len(words) else ""
    if after in ARMS or after.removesuffix("s") in ("punch", "jab", "hook") or _arm_soon(words, i):
        return replace(about, hand="both" if about.hand and about.hand != text else text)
    part = next((word.text for word in words[i + 1 : i + 2] if word.text in _OF_A_LEG | _OF_THE_BODY), "")
    if part:  # "his right ankle", "the left shoulder"
        return replace(about, foot=about.foot or text) if part in _OF_A_LEG else about
    if about.direction == Shape.CIRCLE:
        around_deg = max(abs(about.arc_deg), 360.0)
        return replace(about, arc_deg=around_deg if text == "left" else -around_deg, either_side=False)
    bends = ("turn", "rotate", "pivot", "spin", "roll_over", "swipe")
    if before in OWN and not any(
        word.lemma in bends or word.text.startswith(("arc", "deg", "in_circle")) for word in words
    ):
        notes.append(
            f"'{before} {text}' is taken as the {text} of a person who faces the radar, {OPPOSITE[text]} in the photo"
        )
        text = OPPOSITE[text]
    return replace(about, direction=Side(text))


def _arm_soon(words: list[Word], i: int) -> bool:
    """Whether an arm follows within two words: 'his left hand', 'the left or right arm'."""
    return any(word.text in ARMS for word in words[i + 1 : i + 3]) and not any(
        word.text in ("with", "and", "using") for word in words[i + 1 : i + 2]
    )


def _direction(about: Step, text: str, words: list[Word], i: int) -> Step:
    direction = direction_of(DIRECTIONS[text])
    if direction == Shape.CIRCLE and isinstance(about.direction, Side):
        return replace(about, direction=Shape.CIRCLE, arc_deg=360.0 if about.direction == Side.LEFT else -360.0)
    following = {word.text for word in words[i + 1 : i + 4]}
    going = any(word.is_verb and word.lemma in ("walk", "go", "run", "return", "jog", "head", "come") for word in words)
    if text == "back" and (going or not any(word.lemma in ("step", "lean") for word in words)):
        direction = Way.BACK
    if text == "straight" and any(word.lemma in ("stand", "sit", "raise", "jump", "punch") for word in words):
        return about
    if _is_no_direction(text, words, i, following):
        return about
    if direction == Way.FORWARDS and about.direction:
        return about
    if isinstance(about.direction, Side) and direction == Shape.SPOT:
        return about
    if isinstance(about.direction, Side) and direction in (Shape.AROUND, Way.BACKWARDS):
        return replace(about, direction=about.direction if direction == Shape.AROUND else direction)
    return replace(about, direction=direction)


def _is_no_direction(text: str, words: list[Word], i: int, following: set[str]) -> bool:
    """Whether a direction refers to something unknown (reported by `token_coverage`), or belongs to a limb."""
    if text in ("towards", "toward", "away") and following & {"left", "right"}:
        return True
    if text in ("towards", "toward") and following and not following & (RADAR | TARGETS.keys() | _WHOM):
        return True
    of_an_arm = i and words[i - 1].text in ARMS and text != "in_circle"
    return bool(of_an_arm and any(word.lemma in _LEGGED for word in words))  # "jumps with the arms away from the body"


def _number(about: Step, text: str, words: list[Word], i: int) -> Step:
    """'three times', 'two steps', 'five squats' count; 'two seconds' is a duration; 'one hand' is neither."""
    value = float(NUMBERS[text]) if text in NUMBERS else float(text)
    following = [word.text for word in words[i + 1 : i + 4]]
    if text == "one" and i and words[i - 1].text in _THAT_ONE:
        return about
    if text in TIMES:
        return replace(about, count=int(value))
    if any(word in ("second", "seconds", "sec", "secs", "s") for word in following[:2]):
        return replace(about, seconds=value)
    if following[:1] and following[0] in ("m", "meter", "metre", "meters", "metres"):
        return replace(about, distance_m=value)
    if (following[:1] and following[0] in ARMS) or following[:1] == ["of"]:
        return about
    counted = any(word == "times" or word == "time" for word in following[:2]) or any(
        (word.is_activity and word.lemma != "point") or word.text in ("steps", "repetitions", "reps")
        for word in words[i + 1 : i + 4]
    )
    if not counted or text == "another":
        return about
    if value != int(value) or not 1 <= value <= MAX_COUNT:
        raise InputError(f"{text} times is not possible; say a whole number from 1 to {MAX_COUNT}")
    return replace(about, count=int(value))


def _token(about: Step, text: str, texts: set[str]) -> Step:
    """Tokens of phrases: angles, legs, the side of a push, back or belly."""
    if text in ("left_leg", "right_leg"):
        return replace(about, foot=text.removesuffix("_leg"))
    if text.startswith("arc") and text[3:].isdigit():
        return replace(about, arc_deg=float(text[3:]))
    if text.startswith("deg") and text[3:].isdigit():
        return replace(about, turn_deg=float(text[3:]))
    if text.startswith((SPEED, CADENCE)):
        number = float(text.partition("_")[2])
        said = {"speed_mps": number / 100} if text.startswith(SPEED) else {"steps_hz": number / 60}
        return replace(about, **said)
    if text.startswith("rounds_"):
        times = text.removeprefix("rounds_")
        return replace(about, arc_deg=360.0 * int(NUMBERS.get(times, times)), either_side=True)
    if text.startswith("fraction_"):
        _, part, whole = text.split("_")
        return replace(about, arc_deg=360.0 * int(part) / max(int(whole), 1))
    if text.startswith(AIM):
        return replace(about, facing=text.removeprefix(AIM))
    if text == "from_side":
        return replace(about, style="side")
    if text.startswith(("from_", "on_")) and "pushed" in texts and about.direction in (None, Way.AWAY):
        return replace(about, direction=_PUSHED_FROM.get(text.removeprefix("from_"), about.direction))
    if text in ("onback", "onbelly"):
        return replace(about, style="back" if text == "onback" else "front")
    if text == "lookdown":
        return replace(about, facing="down")
    styles = {
        "highkick": "high",
        "reach_high": "high",
        "frontlunge": "frontlunge",
        "swipe_up": "up",
        "swipe_down": "down",
    }
    style = text.removeprefix(STYLE) if text.startswith(STYLE) else about.style
    return replace(about, style=styles.get(text, style))


_PUSHED_FROM: dict[str, Direction] = {
    **dict.fromkeys(("own_left", "right", "on_right_side", "on_own_left_side"), Side.LEFT),
    **dict.fromkeys(("own_right", "left", "on_left_side", "on_own_right_side"), Side.RIGHT),
    **dict.fromkeys(("behind", "back", "rear"), Way.FORWARDS),
    "front": Way.BACKWARDS,
}
