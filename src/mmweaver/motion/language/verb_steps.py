"""From a verb and the modifiers of its clause to a Step, or an error if it cannot be shown."""

from dataclasses import replace
from itertools import pairwise, takewhile
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, BY_KEY, words_in
from mmweaver.motion.language.described_person import PERSON_NOUNS
from mmweaver.motion.language.lexicon import ARMS, BASE_VERB_SPEED, LEGS, OWN, RADAR, TARGETS, TIMES
from mmweaver.motion.language.places import AIM
from mmweaver.motion.language.plan import HOPPING, Shape, Side, Step, Way
from mmweaver.motion.language.words import Word

ON_ONE_LEG = frozenset(["leg", "foot", "left_leg", "right_leg"])
THINGS_LIFTED = frozenset(["something", "item", "object", "box", "thing", "weight", "weights", "bag", "chair"])
SIDES: dict[Any, float] = {Side.LEFT: 1.0, Side.RIGHT: -1.0}
SEVERAL_TIMES = 3  # "repeatedly", "several times"
SLIGHT_TURN_DEG = 45.0  # "turns a little to the left"
AROUND = frozenset(["past", "behind", "between", "around", "along", "beside"])  # not to a seat
_TOWARDS = frozenset(["to", "towards", "toward", "at"])
AIMED = ("point", "look_around")
_EXERCISES = ("squat", "lunge", "jump", "kick", "side_lunge")
# Activities that a noun in the singular names once: "a punch", "does a squat".
_SINGLE = words_in(
    """
    punch jab cross hook uppercut kick squat jump leap hop hop_one_leg jumping_jacks push_ups throw lunge side_lunge
    stomp
    """
)
_HOPPED = (Way.FORWARDS, Way.TOWARDS, Way.AWAY, *Side)  # directions of hopping on one leg
_AS_HOPPED = {Shape.SPOT: None, Way.BACK: Way.BACKWARDS}
_AS_STUMBLED = {Way.BACK: Way.BACKWARDS, Way.TOWARDS: Way.FORWARDS, Way.AWAY: Way.BACKWARDS}
GAITS = ("walk", "jog", "limp", "stagger", "crawl", "walking_lunge")


def step_of(words: list[Word], at: int, about: Step, clause_text: str) -> Step:
    """The step of a verb.

    Args:
        words: Words of the verb's part of the clause.
        at: Index of the verb.
        about: Modifiers of this part.
        clause_text: Text of the clause.

    Raises:
        InputError: If it would be acted out as something else.
    """
    word = words[at]
    lower, upper = ("walk", "") if word.is_going else ACTIVITY_OF_LEMMA[word.lemma]
    texts = {other.text for other in words}
    step = replace(about, lower=lower or "stand", upper=upper, clause=clause_text)
    if word.lemma in BASE_VERB_SPEED:
        step = replace(step, speed=step.speed or BASE_VERB_SPEED[word.lemma])
    if word.lemma in ("jog", "trot"):
        step = replace(step, style="jog")
    if step.upper == "raise" and _lifts_a_thing(words[at + 1 : at + 4]):
        raise InputError(f"{step.clause!r}: only a hand, an arm or a leg can be raised; say which")
    step = _times_of_a_walk(_arms_step(step, texts), texts)
    if _is_of_several(step, words, at):
        step = replace(step, count=2) if step.style else replace(step, several=True)
    elif _is_a_single_one(step, words, at):
        step = replace(step, count=1)
    if step.lower == "stand" and step.upper and step.seat and texts & {"on", "in"}:
        step = replace(step, lower="sit")  # "reads a book on the sofa"
    if step.upper == "carry" and step.lower == "stand" and _goes_somewhere(step, words):
        walk = _going_step(replace(step, lower="walk", upper=""), words, at)
        return replace(walk, upper="carry", hand=step.hand)
    if step.lower in ("walk", "jog") and texts & {"drunken", "drunk"}:
        step = replace(step, lower="stagger")
    if step.lower in _BY_LOWER:
        step = _BY_LOWER[step.lower](step, words, at)
    elif lower in ("stand", "sit", "squat", "jumping_jacks") or upper:
        step = _stationary_step(step, words)
    else:
        step = step.straight(facing=facing_of(words))
    if "repeatedly" in texts and not (step.count or step.seconds or step.lower in GAITS):
        counted = BY_KEY[step.upper or step.lower].counted_s is not None
        step = replace(step, count=SEVERAL_TIMES if counted else 0)
    return replace(step, on_feet=lower == "stand" and word.lemma == "stand")


def _is_of_several(step: Step, words: list[Word], at: int) -> bool:
    """Whether an exercise is a plural without a number ("does squats"), or "jumps up and down"."""
    word = words[at]
    if word.lemma == "jump" and any(one.text == "up_and_down" for one in words[at + 1 : at + 2]):
        is_said = any(one.text == "repeatedly" for one in words)
        return not (step.upper or step.count or step.style or step.direction or is_said)
    can_be = step.lower in _EXERCISES and not (step.upper or step.count)
    can_be &= not (step.style or step.lower == "side_lunge") or (step.style != "high" and not step.foot)
    return can_be and word.text == f"{word.lemma}s" and any(one.lemma in ("do", "perform") for one in words[:at])


_NO_ADJECTIVES = frozenset({"to", *PERSON_NOUNS.split("|")})


def _is_a_single_one(step: Step, words: list[Word], at: int) -> bool:
    """Whether a movement is a noun in the singular: "a right punch", "performs one high jump"."""
    if step.count or words[at].form != "base" or (step.upper or step.lower) not in _SINGLE:
        return False
    before = [word.text for word in takewhile(lambda word: not word.is_verb, reversed(words[max(at - 5, 0) : at]))]
    article = next((place for place, text in enumerate(before) if text in ("a", "an", "another")), None)
    if article is None or _NO_ADJECTIVES & {*before[:article]}:  # "a person seems to jump"
        return False
    return before[article + 1 : article + 2] not in (["in"], ["into"], ["from"])  # a posture: "is in a squat"


def _lifts_a_thing(following: list[Word]) -> bool:
    """Whether the words after "lifts" name a thing before any limb."""
    kinds = [word.text in THINGS_LIFTED for word in following if word.text in THINGS_LIFTED | ARMS | LEGS]
    return bool(kinds) and kinds[0]


def _times_of_a_walk(step: Step, texts: set[str]) -> Step:
    """'Walks three times' does not count paces; in a circle it counts the rounds."""
    if (
        step.lower not in (*GAITS, *HOPPING)
        or not step.count
        or not texts & {*TIMES, "times"}
        or texts & {"step", "steps"}
    ):
        return step
    if step.direction != Shape.CIRCLE:
        return replace(step, count=0) if step.lower in GAITS else step
    side = 1.0 if step.arc_deg >= 0 else -1.0
    return replace(step, count=0, arc_deg=side * 360.0 * step.count, either_side=step.either_side or not step.arc_deg)


def _arms_step(step: Step, texts: set[str]) -> Step:
    """The hand that moves; raising a leg is another activity."""
    if step.upper == "raise" and not texts & ARMS:
        if texts & LEGS:
            return replace(step, lower="raise_leg", upper="", hand="")
        raise InputError(f"{step.clause!r}: only a hand, an arm or a leg can be raised; say which")
    if step.upper in ("", "clap") and step.lower not in ("pick_up", "put_down", "functional_reach", "seated_reach"):
        step = replace(step, hand="")
    return step


def _goes_somewhere(step: Step, words: list[Word]) -> bool:
    """Whether somebody who carries something walks: a direction or a destination is named."""
    return bool(target_of(words)) or step.direction not in (None, Shape.SPOT, Way.BACKWARDS)


def _roll_over(step: Step, words: list[Word], at: int) -> Step:
    del words, at
    lower = "roll_in_bed" if step.seat else "roll_over"
    return replace(step, lower=lower, style="", direction=step.direction if isinstance(step.direction, Side) else None)


def _forward_roll(step: Step, words: list[Word], at: int) -> Step:
    del at
    return step.straight(Way.FORWARDS, hand="", foot="", facing=facing_of(words))


def _stationary_step(step: Step, words: list[Word]) -> Step:
    facing = facing_of(words) or step.facing
    if step.upper in AIMED:
        facing = step.facing or (step.direction if isinstance(step.direction, Side) else "")
        facing = facing or ("towards" if step.upper == "point" and {w.text for w in words} & RADAR else "")
    if not facing and step.upper and {w.text for w in words} & RADAR and {w.text for w in words} & _TOWARDS:
        facing = "towards"  # "pushes a hand towards the radar"
    kept = step.upper == "arms_out" and step.direction == Way.FORWARDS
    kept |= step.upper == "swipe" and isinstance(step.direction, Side)
    sit_down = step.lower == "sit" and any(word.lemma == "sit_down" for word in words)
    lower = "sit_down" if sit_down else step.lower
    return step.straight(step.direction if kept else None, facing=facing, lower=lower)


def _going_step(step: Step, words: list[Word], at: int) -> Step:
    texts, direction = {word.text for word in words}, step.direction
    if direction == Shape.AROUND:
        direction = Shape.PACING
    if step.seat and direction in (None, Way.BACKWARDS, Way.FORWARDS, Way.TOWARDS) and not texts & AROUND:
        direction = Way.SEAT
    target = target_of(words)
    step = replace(step, direction=direction, hand="", target=target, facing=facing_of(words))
    aside = any(other.text == "sideways" and before.text not in ARMS for before, other in pairwise(words))
    if (aside and step.lower == "walk") or _is_step_aside(step, words, at):
        return _sideways_step(replace(step, lower="sidestep"), words, at)
    if direction == Shape.SPOT:
        still = {"walk": "march", "walking_lunge": "lunge"}.get(step.lower, step.lower)
        return step.straight(step.direction, lower=still)
    return _bent(step)


def _bent(step: Step) -> Step:
    """Angles of a walk bend its path; left and right are then the person's own, as in a turn."""
    angle = step.arc_deg or step.turn_deg
    if not angle or step.direction == Shape.CIRCLE:
        return replace(step, turn_deg=0.0)
    side = SIDES.get(step.direction, 0.0)
    direction = Way.BACKWARDS if step.direction in (Way.BACKWARDS, Way.BACK) else None
    either_side = step.either_side or not side
    return replace(step, arc_deg=abs(angle) * (side or 1.0), turn_deg=0.0, direction=direction, either_side=either_side)


def _is_step_aside(step: Step, words: list[Word], at: int) -> bool:
    """Whether it is a sidestep: 'takes one step to the left', but not 'walks to the left'."""
    noun = words[at].lemma == "step"
    if noun and at + 1 < len(words) and any(word.text in ("step", "steps") for word in words[at + 1 :]):
        return (
            isinstance(step.direction, Side) and step.lower == "walk" and not step.arc_deg
        )  # "steps to the right three steps"
    few = step.count in (0, 1, 2) if words[at].text in ("step", "steps") else step.count in (1, 2)
    return noun and few and isinstance(step.direction, Side) and step.lower == "walk" and not step.arc_deg


def target_of(words: list[Word]) -> str:
    """The landmark that a walk leads to: 'to the door', 'towards the open window', 'reaches the table'.

    Args:
        words: Words of the clause.

    Returns:
        Kind of the landmark, or "".
    """
    for i, word in enumerate(words):
        if word.text in ("to", "towards", "toward", "reaches", "reach", "at", "for", "approaches", "approaching"):
            for after in words[i + 1 : i + 5]:
                if after.text in TARGETS:
                    return TARGETS[after.text]
                if after.text in ("the", "a", "an") or after.text in OWN or not after.is_verb:
                    continue
                break
    return ""


def _turning_step(step: Step, words: list[Word], at: int) -> Step:
    word, texts = words[at], {other.text for other in words}
    aimless = step.straight()
    facing = step.facing or ("towards" if texts & RADAR and step.direction != Way.AWAY else "")
    if not facing and (step.direction == Way.AWAY or word.lemma == "face"):
        ahead = step.direction in (None, Way.FORWARDS)
        facing = "towards" if ahead else "" if step.direction == Way.BACKWARDS else str(step.direction)
    if facing or word.lemma == "face":
        return replace(aimless, facing=facing)
    angle = step.turn_deg or step.arc_deg or (360.0 if step.direction == Shape.CIRCLE or word.lemma == "spin" else 0.0)
    side, times = SIDES.get(step.direction, 0.0), step.count if texts & {*TIMES, "times", "turns"} else 0
    step = step.straight(step.direction, count=0)
    if times > 1:  # "turns around twice"
        angle = times * (angle or (90.0 if side and "around" not in texts else 180.0))
    about = "around" in texts or angle == 180.0 or not side
    if side and not angle and "around" not in texts and texts & {"slightly", "little", "bit"}:
        return replace(step, direction=None, turn_deg=SLIGHT_TURN_DEG * side)
    if angle in (0.0, 180.0) and about and side:
        return replace(step, direction=None, turn_deg=180.0 * side)
    if angle in (0.0, 180.0):
        return replace(step, direction=Shape.AROUND if about else step.direction)
    if angle == 90.0 and side:
        return step
    return replace(step, direction=None, turn_deg=angle * (side or 1.0), either_side=not side)


def _jumping_step(step: Step, words: list[Word], at: int) -> Step:
    """On the spot, somewhere, or on one leg."""
    texts = {word.text for word in words}
    if step.direction == Shape.CIRCLE and step.lower == "hop":
        return step
    if step.turn_deg or step.arc_deg or step.direction in (Shape.CIRCLE, Shape.AROUND, Shape.PACING):
        raise InputError(f"{step.clause!r}: jumping with a turn is not known; say 'jumps, then turns'")
    direction = _AS_HOPPED.get(step.direction, step.direction)
    if texts & ON_ONE_LEG:
        direction = direction if direction in _HOPPED else None
        return replace(step, lower="hop_one_leg", direction=direction, facing="" if direction else facing_of(words))
    direction = Side.RIGHT if "sideways" in texts and not direction else direction
    if direction in (*_HOPPED, Way.BACKWARDS):
        return replace(step, lower="leap", direction=direction)
    return replace(step, direction=None, facing=facing_of(words))


def _stumbling_step(step: Step, words: list[Word], at: int) -> Step:
    direction = _AS_STUMBLED.get(step.direction, step.direction)
    known = (*Side, Way.FORWARDS, Way.BACKWARDS)
    side = step.style == "side" or "sideways" in {word.text for word in words}
    style = "side" if side and direction not in known else ""
    direction = direction if direction in known else Way.FORWARDS if words[at].lemma == "trip" and not side else None
    return step.straight(direction, style=style, count=0, hand="", foot="")


def _floor_step(step: Step, words: list[Word], at: int) -> Step:
    """Lying and falling: on the back unless the clause names forwards, belly or one's own side."""
    if step.seat and step.lower in ("lie", "lie_down"):
        lower = "lie_on_seat" if step.lower == "lie" else "recline"
        return step.straight(lower=lower, count=0)
    if step.seat:
        raise InputError(f"{step.clause!r}: falling is known on the floor and off a seat; leave out the {step.seat}")
    if step.lower == "fall" and (isinstance(step.direction, Side) or "sideways" in {word.text for word in words}):
        own_side = step.direction if isinstance(step.direction, Side) else "right"
        return step.straight(style=own_side, count=0)
    style = step.style or ("front" if step.direction in (Way.FORWARDS, Way.TOWARDS) else "back")
    return step.straight(style=style, count=0)


def _falling_off_step(step: Step, words: list[Word], at: int) -> Step:
    """To the named own side, else to the right; out of a bed along which one lies, onto the left one."""
    if step.seat == "bed":
        return step.straight(lower="fall_out_of_bed", style="left", count=0)
    style = step.direction if isinstance(step.direction, Side) else "right"
    return step.straight(style=style, count=0)


def _kneeling_step(step: Step, words: list[Word], at: int) -> Step:
    word = words[at]
    still = word.lemma == "kneel" and word.form == "ing"
    lower = "kneel_up" if word.lemma == "kneel_up" else "kneel" if still else "kneel_down"
    style = "knee" if {other.text for other in words} & (ON_ONE_LEG | {"one_knee"}) else step.style
    return step.straight(lower=lower, style=style, count=0)


def _leg_step(step: Step, words: list[Word], at: int) -> Step:
    onward = {"way", "direction", "off"} & {word.text for word in words} and step.direction != Shape.SPOT
    if step.lower == "march" and (onward or step.direction not in (None, Shape.SPOT, Shape.AROUND)):
        return _going_step(replace(step, lower="walk"), words, at)
    if step.lower == "kick" and step.direction in (Way.BACK, Way.BACKWARDS):
        step = replace(step, style="back")
    return step.straight(hand="", facing=facing_of(words))


def _sideways_step(step: Step, words: list[Word], at: int) -> Step:
    if step.direction == Way.BACK:
        raise InputError(f"{step.clause!r}: say to which side, left or right, the person steps back")
    return step.straight(step.direction, hand="")


def _leaning_step(step: Step, words: list[Word], at: int) -> Step:
    """To the named own side, or back; otherwise to both sides in turn."""
    direction = Way.BACKWARDS if step.direction in (Way.BACK, Way.BACKWARDS) else step.direction
    direction = direction if direction in (*SIDES, Way.BACKWARDS) else None
    return step.straight(direction, hand="", foot="")


def facing_of(words: list[Word]) -> str:
    """What the person faces during another activity: 'waves facing the radar', 'facing left'.

    Args:
        words: Words of the clause.

    Returns:
        towards, left, right, away, a kind of landmark, or "".
    """
    for i, word in enumerate(words):
        if word.text in ("facing", "faces"):
            texts = {other.text for other in words[i + 1 : i + 4]}
            aimed = [text for text in texts if text.startswith(AIM)]
            if aimed:
                return aimed[0].removeprefix(AIM)
            if texts & RADAR:
                return "towards"
            return next((side for side in ("left", "right", "away") if side in texts), "")
    return ""


def _slip_step(step: Step, words: list[Word], at: int) -> Step:
    return step.straight(style="back", count=0)


def _collapse_step(step: Step, words: list[Word], at: int) -> Step:
    """Onto the named own side, else the right one; on the back or the belly if that is said."""
    side = step.direction if isinstance(step.direction, Side) else "right"
    style = {Way.FORWARDS: "front", Way.BACKWARDS: "back", Way.BACK: "back"}.get(step.direction, step.style or side)
    return step.straight(style=style, count=0)


_BY_LOWER = {
    "slip": _slip_step,
    "collapse": _collapse_step,
    **dict.fromkeys(GAITS, _going_step),
    "turn": _turning_step,
    **dict.fromkeys(("jump", "hop"), _jumping_step),
    "stumble": _stumbling_step,
    **dict.fromkeys(("lie", "lie_down", "fall", "get_up"), _floor_step),
    **dict.fromkeys(("kneel", "kneel_up"), _kneeling_step),
    "fall_off": _falling_off_step,
    **dict.fromkeys(
        ("toe_tap", "leg_aside", "calf_stretch", "knee_extension", "cross_legs", "lying_leg_raise"), _leg_step
    ),
    **dict.fromkeys(("kick", "roundhouse", "side_kick", "stomp", "raise_leg", "one_leg", "lunge", "march"), _leg_step),
    "sidestep": _sideways_step,
    "lean": _leaning_step,
    "roll_over": _roll_over,
    "forward_roll": _forward_roll,
}
