"""One clause -> the steps it names: its verbs, and around them direction, hand, speed, count and seat."""

from dataclasses import dataclass, field, replace

from mmweaver.core.errors import InputError
from mmweaver.motion.clauses import Clause
from mmweaver.motion.lexicon import (
    ACTIVITY_OF_LEMMA,
    ARMS,
    BASE_VERB_SPEED,
    BOTH,
    DIRECTIONS,
    FILLERS,
    GOING,
    MANY,
    NEGATIONS,
    NOT_HUMAN,
    NUMBERS,
    OTHER_MOVEMENT,
    OWN,
    RADAR,
    SEATS,
    SPEEDS,
    TIMES,
)
from mmweaver.motion.plan import Step
from mmweaver.motion.words import Word

OPPOSITE = {"left": "right", "right": "left"}
MOST_TIMES = 60
STEPPING = GOING | {"walk", "jog", "run", "jump", "hop", "turn", "advance", "march", "retreat"}
DISTANCES = {"meters", "metres", "meter", "metre", "m", "cm", "centimeters", "feet", "yards"}


@dataclass
class Reading:
    """What one clause says."""

    link: str
    text: str
    steps: list[Step] = field(default_factory=list)
    form: str = ""  # of the first verb: ing, s, ...
    about: Step = field(default_factory=Step)  # direction, hand, speed, ... of a clause without a verb
    notes: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)

    @property
    def adds_nothing(self) -> bool:
        """It names no activity, only how: "and slowly", "and arm"."""
        return not self.steps and not self.unknown

    @property
    def is_empty(self) -> bool:
        return self.adds_nothing and replace(self.about, clause="") == Step()

    def absorb(self, more: "Reading") -> None:
        """Takes over what a clause without an activity says about the last step."""
        last, about = self.steps[-1], more.about
        if last.direction and about.direction and last.direction != about.direction:
            raise InputError(
                f"{self.text!r} and {more.text!r} name two directions; say which movement goes where, with 'then'"
            )
        self.steps[-1] = replace(
            last,
            hand="both" if {last.hand, about.hand} == {"left", "right"} else last.hand or about.hand,
            direction=last.direction or about.direction,
            speed=last.speed or about.speed,
            count=last.count or about.count,
            seat=last.seat or about.seat,
            seconds=last.seconds or about.seconds,
        )


def read_clause(clause: Clause) -> Reading:
    """Reads verbs and modifiers; raises InputError for what must not be acted out as if it were something known."""
    words = clause.words
    reading = Reading(clause.link, clause.text)
    _refuse(clause)
    verbs = _verbs(words)
    about = _modifiers(words, reading)
    if not verbs:
        reading.about = about
        _note_unknown(words, clause, reading, has_verb=False)
        return reading
    _note_unknown(words, clause, reading, has_verb=True)
    reading.form = _form(words, verbs[0])
    for k, at in enumerate(verbs):
        reading.steps.append(_step(words, at, about, clause, first=k == 0))
    return reading


def _refuse(clause: Clause) -> None:
    texts = {word.text for word in clause.words}
    still = texts & {"moving", "movement", "motion"} and texts & {"without", "not", "no"}
    if texts & NEGATIONS and not still:
        raise InputError(f"{clause.text!r} says what is not done; say what the person does instead")
    if texts & MANY or {"of", "them"} <= texts or "guys" in texts:
        raise InputError(f"{clause.text!r} speaks of several people; only one person can be shown")
    if texts & NOT_HUMAN:
        raise InputError(f"{clause.text!r} is not about a person alone; only one person can be shown")
    other = [word.text for word in clause.words if word.text in OTHER_MOVEMENT and not _harmless(word, texts)]
    if other:
        raise InputError(f"{clause.text!r}: {other[0]!r} is not among the movements that are known; known: {KNOWN}")


def _harmless(word: Word, texts: set[str]) -> bool:
    """Words that mean another movement only beside some verbs."""
    if word.text in ("over", "legs", "leg", "foot", "knees", "knee", "head", "shoulder", "shoulders"):
        lifted = texts & {"raise", "raises", "raising", "raised", "lift", "lifts", "lifting", "lifted"}
        jumped = texts & {"jump", "jumps", "jumping", "hop", "hops", "leaps"}
        if word.text in ("head", "shoulder", "shoulders"):
            return not lifted or "above" in texts or "over" in texts or bool(texts & ARMS)
        if word.text == "over":
            return not jumped and "chair" not in texts
        return not lifted and word.text not in ("leg", "foot", "knee") and "on" not in texts
    if word.text == "quarterturn":
        return bool(texts & {"turn", "turns", "turning", "turned", "rotates", "rotate", "rotating", "pivots"})
    if word.text in ("floor", "ground"):
        return not texts & {"sit", "sits", "sitting", "seated", "sit_down", "sat"}
    return False


def _verbs(words: list[Word]) -> list[int]:
    """Places of the words that name an activity; light verbs and nouns that only repeat a verb are left out."""
    found: list[int] = []
    texts = {word.text for word in words}
    for i, word in enumerate(words):
        if word.lemma == "move" and texts & ARMS:
            continue  # it is the arm that moves, and how is not known
        goes_somewhere = bool(texts & set(DIRECTIONS) or texts & RADAR or texts & SEATS)
        if (word.is_going and goes_somewhere) or (word.is_activity and not _is_noun(words, i, found)):
            found.append(i)
    if len(found) > 1 and words[found[0]].lemma in ("stop", "halt") and words[found[1]].form == "ing":
        return found[:1]  # "stops walking" is standing still
    return found


def _is_noun(words: list[Word], i: int, found: list[int]) -> bool:
    """'drinks a drink', 'box' as a thing, 'the hand wave': a noun after another verb of the clause."""
    word, before = words[i], words[i - 1].text if i else ""
    if word.lemma == "face":
        return bool(found) or before in OWN or before in ("the", "a")
    if word.form == "ing" or word.lemma in ("sit_down", "stand_up", "jumping_jack", "seated"):
        return False
    if word.lemma == "box" and word.form == "base":
        return before in ("a", "the", "this", "that")
    if word.lemma == "seat" and word.form != "past":
        return True
    if word.lemma in ("drink", "stop") and before in ("a", "the", "his", "her", "their"):
        return bool(found)
    if word.lemma == "step" and found and words[found[-1]].lemma in STEPPING:
        return True
    same = any(ACTIVITY_OF_LEMMA.get(words[k].lemma) == ACTIVITY_OF_LEMMA[word.lemma] for k in found)
    return same


def _form(words: list[Word], at: int) -> str:
    light = next((word for word in words[:at] if word.is_verb and not word.is_activity), None)
    return light.form if light else words[at].form


def _modifiers(words: list[Word], reading: Reading) -> Step:
    """Everything of the clause that says how, as a Step without a verb."""
    about = Step(clause=reading.text)
    for i, word in enumerate(words):
        text, after = word.text, words[i + 1].text if i + 1 < len(words) else ""
        before = words[i - 1].text if i else ""
        if text in SPEEDS:
            about = replace(about, speed=SPEEDS[text])
        elif text in ("left", "right"):
            about = _left_or_right(about, text, before, after, words, i, reading)
        elif text in BOTH or (text == "two" and after in ARMS):
            about = replace(about, hand=about.hand or "both")
        elif text in SEATS:
            about = replace(about, seat=text)
        elif text in DIRECTIONS:
            about = _direction(about, text, words, i)
        elif text in TIMES or text in NUMBERS or text.replace(".", "").isdigit():
            about = _number(about, text, words, i)
    return about


def _left_or_right(
    about: Step, text: str, before: str, after: str, words: list[Word], i: int, reading: Reading
) -> Step:
    """Before an arm it names the arm; else it is a direction, the viewer's unless said to be the person's own."""
    if about.direction == "circle":
        reading.notes.append("which way round a circle goes is left to chance")
        return about
    if after in ARMS or after.removesuffix("s") in ("punch", "jab", "hook") or _arm_soon(words, i):
        return replace(about, hand="both" if about.hand and about.hand != text else text)
    if before in OWN and not any(word.lemma in ("turn", "rotate", "pivot") for word in words):
        reading.notes.append(
            f"'{before} {text}' is taken as the {text} of a person who faces the radar, {OPPOSITE[text]} in the photo"
        )
        text = OPPOSITE[text]
    return replace(about, direction=text)


def _arm_soon(words: list[Word], i: int) -> bool:
    """'his left hand', 'the left or ... arm', 'arm on the left': an arm within two words after."""
    return any(word.text in ARMS for word in words[i + 1 : i + 3]) and not any(
        word.text in ("with", "and", "using") for word in words[i + 1 : i + 2]
    )


def _direction(about: Step, text: str, words: list[Word], i: int) -> Step:
    direction = DIRECTIONS[text]
    following = {word.text for word in words[i + 1 : i + 4]}
    if text == "back" and not any(word.lemma in ("step", "lean") for word in words):
        direction = "back"
    if text == "straight" and any(word.lemma in ("stand", "sit", "raise", "jump", "punch") for word in words):
        return about
    if text == "towards" or text == "toward":
        if following & SEATS:
            return replace(about, direction=about.direction or "seat")
        if following & {"left", "right"}:
            return about
    if text == "away" and following & {"left", "right"}:
        return about
    if direction == "forwards" and about.direction:
        return about
    if about.direction in ("left", "right") and direction == "spot":
        return about
    if about.direction in ("left", "right") and direction in ("around", "backwards"):
        return replace(about, direction=about.direction if direction == "around" else direction)
    return replace(about, direction=direction)


def _number(about: Step, text: str, words: list[Word], i: int) -> Step:
    """'three times', 'two steps', 'five squats' count; 'two seconds' is a duration; 'one hand' is neither."""
    value = float(NUMBERS[text]) if text in NUMBERS else float(text)
    following = [word.text for word in words[i + 1 : i + 4]]
    if text in TIMES:
        return replace(about, count=int(value))
    if any(word in ("second", "seconds", "sec", "secs", "s") for word in following[:2]):
        return replace(about, seconds=value)
    if (following[:1] and following[0] in ARMS) or following[:1] == ["of"]:
        return about
    counted = any(word == "times" or word == "time" for word in following[:2]) or any(
        word.is_activity or word.text in ("steps", "repetitions", "reps") for word in words[i + 1 : i + 4]
    )
    if not counted or text == "another":
        return about
    if value != int(value) or not 1 <= value <= MOST_TIMES:
        raise InputError(f"{text} times is not possible; say a whole number from 1 to {MOST_TIMES}")
    return replace(about, count=int(value))


def _note_unknown(words: list[Word], clause: Clause, reading: Reading, *, has_verb: bool) -> None:
    """Unknown words after a verb are told of, unless they look like another activity, which is an error."""
    unknown = [word.text for word in words if not _is_known(word)]
    if not has_verb:
        reading.unknown = unknown + [word.text for word in words if word.is_verb]
        return
    moved = next((i for i, word in enumerate(words) if word.lemma == "move"), None)
    if moved is not None and any(not _is_known(word) for word in words[moved + 1 : moved + 3]):
        raise InputError(f"the clause {clause.text!r} names no activity that is known; known: {KNOWN}")
    for text in unknown:
        doing = (text.endswith("ing") and len(text) > 4) or (text.endswith("ed") and len(text) > 3)
        if doing and text not in (
            "ceiling",
            "evening",
            "morning",
            "bed",
            "red",
            "building",
            "wing",
            "king",
            "tired",
            "something",
            "anything",
            "everything",
            "during",
        ):
            raise InputError(
                f"the clause {clause.text!r} names an activity that is not known ({text!r}); known: {KNOWN}"
            )
    if {word.text for word in words} & DISTANCES:
        reading.notes.append(f"the distance in {clause.text!r} is not kept: time and speed give it")
    if unknown:
        listed = ", ".join(repr(text.replace("_", " ").replace("-", " ")) for text in unknown)
        reading.notes.append(f"of the text, {listed} says nothing that can be acted out and was left aside")


def _is_known(word: Word) -> bool:
    text = word.text
    return (
        word.is_verb
        or text in FILLERS
        or text in DIRECTIONS
        or text in SPEEDS
        or text in NUMBERS
        or text in SEATS
        or text in ARMS
        or text in RADAR
        or text in OWN
        or text in BOTH
        or text in ("left", "right", "not", "without", "moving")
        or text.replace(".", "").isdigit()
        or len(text) == 1
    )


def _step(words: list[Word], at: int, about: Step, clause: Clause, *, first: bool) -> Step:
    """The step of one verb with the clause's modifiers."""
    word = words[at]
    lower, upper = ("walk", "") if word.is_going else ACTIVITY_OF_LEMMA[word.lemma]
    texts = {other.text for other in words}
    step = replace(about, lower=lower or "stand", upper=upper, clause=clause.text)
    if word.lemma in BASE_VERB_SPEED:
        step = replace(step, speed=step.speed or BASE_VERB_SPEED[word.lemma])
    if lower == "sit" and word.lemma == "sit_down":
        step = replace(step, lower="sit_down")
    if upper == "raise" and not texts & ARMS:
        raise InputError(f"{clause.text!r}: only a hand or an arm can be raised; say which")
    if upper in ("", "clap", "drink") and upper != "drink":
        step = replace(step, hand="")
    if upper:
        step = _arms_step(step, upper, texts)
    if lower in ("walk", "jog"):
        step = _going_step(step, words, first)
    elif lower == "turn":
        step = _turning_step(step, word, texts)
    elif lower in ("jump", "squat", "jumping_jacks") and step.direction not in ("", "spot", "around"):
        raise InputError(f"{clause.text!r}: {step.name} is done on the spot only; leave the direction out")
    elif lower in ("stand", "sit", "squat", "jump", "jumping_jacks") or upper:
        step = replace(step, direction="", facing=_facing(words))
    return replace(step, on_feet=lower == "stand" and word.lemma == "stand")


def _arms_step(step: Step, upper: str, texts: set[str]) -> Step:
    """A hand for each: raising without a side is the seed's choice, punching alternates."""
    if upper == "drink" and step.hand == "both":
        return replace(step, hand="")
    return step


def _going_step(step: Step, words: list[Word], first: bool) -> Step:
    lemmas = {word.lemma for word in words}
    direction = step.direction
    if not direction and lemmas & {"approach"}:
        direction = "towards"
    if not direction and lemmas & {"retreat"}:
        direction = "away"
    if not direction and lemmas & {"advance"}:
        direction = "forwards"
    if not direction and {word.text for word in words} & RADAR and "to" in {word.text for word in words}:
        direction = "towards"
    if direction == "around":
        direction = "pacing"
    if step.seat and direction in ("", "backwards", "forwards"):
        direction = "seat"
    return replace(step, direction=direction, hand="")


def _turning_step(step: Step, word: Word, texts: set[str]) -> Step:
    facing = "towards" if texts & RADAR and step.direction != "away" else ""
    if step.direction == "away" or word.lemma == "face":
        facing = facing or step.direction or "towards"
        return replace(step, facing=facing, direction="")
    if facing:
        return replace(step, facing=facing, direction="")
    direction = step.direction if step.direction in ("left", "right") and "around" not in texts else "around"
    return replace(step, direction=direction, count=0)


def _facing(words: list[Word]) -> str:
    """'facing the radar', 'facing left' beside another verb."""
    for i, word in enumerate(words):
        if word.text in ("facing", "faces"):
            texts = {other.text for other in words[i + 1 : i + 4]}
            if texts & RADAR:
                return "towards"
            return next((side for side in ("left", "right", "away") if side in texts), "")
    return ""
