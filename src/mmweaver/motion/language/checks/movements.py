"""The movements that a sentence names, in order and as often as it names them, against the steps."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from mmweaver.motion.language.accounts import alike
from mmweaver.motion.language.checks.given import LINKS, Given, Token
from mmweaver.motion.language.checks.matching import not_shown_as_often, out_of_order
from mmweaver.motion.language.lexicon import LIGHT, NUMBERS, SIZES
from mmweaver.motion.language.named_steps import in_turn
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA, words_in
from mmweaver.motion.language.words import word_of

_NOT_COUNTED = words_in(
    "stand stretch face dance breathe look_around point text type phone comb read"
)  # shown by staying, or by several steps
_GOES_ON = words_in(
    "keep keeps kept keeping continue continues continued continuing resume resumes still carries on"
    " stop stops stopped stopping"
)
_DETERMINERS = words_in(
    "a an the his her their its some few several many multiple another other single each every more"
)
_ADJECTIVES = SIZES | words_in(
    "quick slow fast sharp short little side left right forward backward full half couple of"
)
_NO_ADJECTIVES = LINKS | words_in(
    "person man woman he she it they someone somebody is are was were to of in on with for from then who that arms"
    " hands"
)
_PREPOSITIONS = words_in("in of with for on from by as without no like into to")
# (movement, next movement) of which the first is how the second begins, or the second how the first goes on.
_ONE_MOVEMENT = {
    ("raise", "wave"), ("bend", "pick_up"), ("crouch", "pick_up"), ("squat", "pick_up"), ("reach", "pick_up"),
    ("pick_up", "carry"), ("bow", "bend"), ("bend", "reach"), ("lean", "pick_up"), ("fall", "lie"), ("walk", "carry"),
    ("raise", "throw"), ("bend", "put_down"), ("crouch", "put_down"),
}  # fmt: skip
_POINTING = words_in("that this which a some few")
_KIND = r"(?:dance|pose|stance|position|motion|movement|manner|fashion|style|exercise|move)"
_NAMED = re.compile(
    rf"\b(?:the|a|an|his|her|their|some) (?:[a-z]+ )??([a-z]+ing|side ?step|[a-z]+)(?: ([a-z]+))?? {_KIND}\b"
)
_BOTH_AFTER = re.compile(r"\w \bafter (?:[a-z]+ )?[a-z]+ing\b[^,.;]*\band [a-z]+ing\b")
_ORDERING = words_in("after before until when once having following while as since whilst")


@dataclass(frozen=True)
class _Mention:
    token: Token
    activity: str


def movements_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for movements that no step of their own shows, or not in their order."""
    mentions = list(_mentions(given))
    slots = [
        [frozenset(i for i, one in enumerate(mentions) if alike(one.activity, key, step)) for key in _keys(step)]
        for step in given.steps
    ]
    lemmas = [one.token.word.lemma for one in mentions]
    for i, how in not_shown_as_often([one.token.text for one in mentions], lemmas, slots):
        if mentions[i].token.clause not in given.otherwise:
            yield mentions[i].token.clause, how
    yield from _otherwise_ordered(given)
    yield from _of_a_name(given)
    if _BOTH_AFTER.search(given.text) and len(given.steps) > 2:
        yield given.tokens[-1].clause, f"the order shown is {in_turn(given.steps)}"
    late = out_of_order(len(mentions), slots)
    if late is not None and not says_its_order(given):
        yield mentions[late].token.clause, f"the order shown is {in_turn(given.steps)}"


def _otherwise_ordered(given: Given) -> Iterator[tuple[int, str]]:
    """Where "after" may be an adverb ("and after jumps", ", after he jumped") and the clauses were reordered by it."""
    first = [min(step.clauses) for step in given.steps if step.clauses]
    for token in given.tokens[1:]:
        before, following = given.texts(token.place - 1, token.place), given.texts(token.place + 1, token.place + 2)
        is_open = token.text == "after" and before in _ADDED and not {*following} & _POINTING
        if is_open and first != sorted(first):
            yield token.clause, f"the order shown is {in_turn(given.steps)}"


def _of_a_name(given: Given) -> Iterator[tuple[int, str]]:
    """A participle that only names a movement, and is shown as one more: "the running man dance"."""
    for found in _NAMED.finditer(given.text):
        name = found[1].replace(" ", "")
        token = next((one for one in given.tokens if one.text == found[1].split()[0]), None)
        keys = {key for key in ACTIVITY_OF_LEMMA.get(word_of(name).lemma, ()) if key not in ("", "stand")}
        shown = [step for step in given.steps if keys & {step.lower, step.upper}]
        if token is not None and shown and len(given.steps) > len(shown):
            yield token.clause, f"{found[1]!r} is shown as a movement of its own"


def says_its_order(given: Given) -> bool:
    """Whether a connective says which movement comes first, where the grammar reads it: not "and after jumps"."""
    return any(
        token.text in _ORDERING and not (token.text == "after" and given.texts(token.place - 1, token.place) in _ADDED)
        for token in given.tokens
    )


_ADDED = (["and"], [","])


def _keys(step: Step) -> list[str]:
    """What a step shows, as often as it shows it."""
    keys = [key for key in (step.lower, step.upper) if key and not (key == "stand" and step.upper)]
    keys += ["turn"] if step.arc_deg and step.lower != "turn" else []
    keys += ["walk"] if step.lower == "limp" and step.direction == "circle" else []  # "limping and going in a circle"
    return keys * max(step.count, 1) if step.lower not in ("walk", "sidestep", "jog") else keys


def _mentions(given: Given) -> Iterator[_Mention]:
    """The movements that the sentence names, without those that only say more of the one before."""
    found: list[_Mention] = []
    for token in given.tokens:
        activity = _activity(given, token)
        if not activity:
            continue
        one = _Mention(token, activity)
        if found and _says_more(given, found[-1], one):
            continue
        if found and (found[-1].activity, activity) in _ONE_MOVEMENT:
            found.pop()
        found.append(one)
    yield from found


def _activity(given: Given, token: Token) -> str:
    """The activity that a word names as a movement of the sentence, or ""."""
    word, place = token.word, token.place
    if not word.is_activity or place in given.compared:
        return ""
    lower, upper = ACTIVITY_OF_LEMMA[word.lemma]
    activity = upper or lower
    before = given.texts(place - 2, place)
    following = given.texts(place + 1, place + 2)
    is_compound = following[:1] == ["ups"] or (token.text == "push" and following[:1] == ["up"])
    is_compound |= word.lemma == "step" and bool(before[-1:]) and word_of(before[-1]).is_activity  # "dance steps"
    if is_compound or activity in _NOT_COUNTED or _GOES_ON & {*before} or before[-1:] == ["to"]:
        return ""
    if word.form in ("base", "s") and _is_noun(given, place):
        return activity if _is_done(given, token) else ""
    described = word.form in ("ing", "past") and _is_noun(given, place)
    return "" if described or (before[-1:] and before[-1] in _PREPOSITIONS) else activity


def _is_noun(given: Given, place: int) -> bool:
    """Whether a determiner, a number or an adjective stands before it, with at most two other words between."""
    for other in reversed(given.tokens[max(place - 3, 0) : place]):
        if other.text in _DETERMINERS | _ADJECTIVES or other.text in NUMBERS or other.text.isdigit():
            return True
        if other.word.is_verb or other.text in _NO_ADJECTIVES:
            return False
    return False


def _is_done(given: Given, token: Token) -> bool:
    """Whether a noun is what somebody does: "takes a step", not "walks two steps", "in a jump"."""
    for other in reversed(given.tokens[: token.place]):
        if other.part != token.part or other.text in _PREPOSITIONS - {"of"}:
            return False
        if other.word.is_verb and not (other.word.form == "base" and _is_noun(given, other.place)):
            return other.word.lemma in LIGHT
    return False


def _says_more(given: Given, before: _Mention, one: _Mention) -> bool:
    """Whether a movement is the one before: "walks, walking slowly", "is pushed and stumbles", "walks two steps"."""
    if not alike(before.activity, one.activity):
        return False
    same_part = before.token.part == one.token.part
    other_verb = before.token.word.lemma != one.token.word.lemma
    participle = one.token.word.form == "ing" and before.token.word.form != "ing"
    part = [token.text for token in given.tokens if token.part == one.token.part and token.text not in LINKS]
    participle |= one.token.word.lemma == "step" and part[0].endswith("ing")  # "walks, taking five steps"
    added = given.texts(one.token.place - 1, one.token.place) == [","]
    added |= participle and given.texts(one.token.place - 1, one.token.place) != ["and"] and part[0].endswith("ing")
    return same_part or (one.activity == "stumble" and other_verb) or (participle and added)
