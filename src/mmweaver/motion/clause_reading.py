"""One clause -> the steps it names: its verbs, and around them direction, hand, speed, count and seat."""

from dataclasses import dataclass, field, replace

from mmweaver.core.errors import InputError
from mmweaver.motion.clauses import Clause
from mmweaver.motion.lexicon import (
    ARMS,
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
    TARGETS,
)
from mmweaver.motion.modifiers import modifiers
from mmweaver.motion.plan import Step
from mmweaver.motion.suggestions import not_known
from mmweaver.motion.verb_steps import LEGS, step_of
from mmweaver.motion.verbs import ACTIVITY_OF_LEMMA
from mmweaver.motion.words import Word

STEPPING = GOING | {"walk", "jog", "run", "jump", "hop", "turn", "advance", "march", "retreat", "sidestep", "stumble"}
DISTANCES = {"meters", "metres", "meter", "metre", "m", "cm", "centimeters", "feet", "yards"}
LEG_VERBS = {"kick", "raise", "lift", "stomp", "stamp", "one_leg_stand", "hop", "jump", "leap", "turn", "pivot", "rotate", "spin",
             "kneel_down", "kneel", "lunge", "limp", "hobble", "step", "walk", "limp"}
FLOOR_VERBS = {"lie", "lay", "lie_down", "fall", "collapse", "topple", "pick_up", "put_down", "get_up", "stand_up", "kneel",
               "kneel_down", "kneel_up", "stomp", "stamp", "look_around", "bend", "faint", "wipe", "clean", "point"}


@dataclass
class Reading:
    """What one clause says."""

    link: str
    text: str
    steps: list[Step] = field(default_factory=list)
    form: str = ""  # of the first verb: ing, s, ...
    forms: list[str] = field(default_factory=list)  # of each step's verb
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
    about = modifiers(words, clause.text, reading.notes)
    if not verbs:
        reading.about = about
        _note_unknown(words, clause, reading, has_verb=False)
        return reading
    _note_unknown(words, clause, reading, has_verb=True)
    reading.form = _form(words, verbs[0])
    for k, at in enumerate(verbs):
        reading.steps.append(step_of(words, at, about, clause.text))
        reading.forms.append(words[at].form if k else reading.form)
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
    lemmas = {word.lemma for word in clause.words if word.is_activity}
    other = [word.text for word in clause.words if word.text in OTHER_MOVEMENT and not _harmless(word, texts, lemmas)]
    if other:
        raise InputError(not_known(clause.text, other[0]))


def _harmless(word: Word, texts: set[str], lemmas: set[str]) -> bool:
    """Words that mean another movement only beside some verbs."""
    if word.text in LEGS and lemmas & LEG_VERBS:
        return True
    if word.text in ("over", "legs", "leg", "foot", "knees", "knee", "head", "shoulder", "shoulders"):
        lifted = texts & {"raise", "raises", "raising", "raised", "lift", "lifts", "lifting", "lifted"}
        jumped = texts & {"jump", "jumps", "jumping", "hop", "hops", "leaps"}
        if word.text in ("head", "shoulder", "shoulders"):
            return not lifted or "above" in texts or "over" in texts or bool(texts & ARMS)
        if word.text == "over":
            return not jumped and "chair" not in texts
        return not lifted and word.text not in ("leg", "foot", "knee") and "on" not in texts
    if word.text in ("floor", "ground"):
        return bool(lemmas & FLOOR_VERBS) or not texts & {"sit", "sits", "sitting", "seated", "sit_down", "sat"}
    if word.text == "ball":
        return bool(lemmas & {"throw", "toss", "hurl", "lob", "kick", "pick_up", "put_down", "carry"})
    return word.text == "against" and "pushed" in lemmas


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


def _note_unknown(words: list[Word], clause: Clause, reading: Reading, *, has_verb: bool) -> None:
    """Unknown words after a verb are told of, unless they look like another activity, which is an error."""
    unknown = [word.text for word in words if not _is_known(word)]
    if not has_verb:
        reading.unknown = unknown + [word.text for word in words if word.is_verb]
        return
    moved = next((i for i, word in enumerate(words) if word.lemma == "move"), None)
    if moved is not None and any(not _is_known(word) for word in words[moved + 1 : moved + 3]):
        raise InputError(not_known(clause.text, "move"))
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
            raise InputError(not_known(clause.text, text))
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
        or text in ("left", "right", "not", "without", "moving", "sideways", "on_spot", "lookdown")
        or text in TARGETS
        or text in LEGS
        or text.startswith(("arc", "deg", "from_", "on_", "fraction_"))
        or text in ("onback", "onbelly", "highkick")
        or text.replace(".", "").isdigit()
        or len(text) == 1
    )


