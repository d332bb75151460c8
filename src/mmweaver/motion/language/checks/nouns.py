"""Things that a sentence names: each belongs to a step, says nothing about movement, or is named as not shown."""

import re
from collections.abc import Iterator
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.accounts import SHOWN_BY
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.checks.given import LINKS, Given, Token
from mmweaver.motion.language.lexicon import (
    ARMS,
    DIRECTIONS,
    DISTANCES,
    LIGHT,
    MANNERS,
    MANY,
    NUMBERS,
    OWN,
    PRONOUNS,
    RADAR,
    SEATS,
    SIZES,
    SPEEDS,
    TARGETS,
)  # fmt: skip
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verb_steps import LEGS
from mmweaver.motion.language.verbs import words_in

_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
_SILENT = frozenset().union(
    words_in(_TABLE["silent"]), *(words_in(words) for words, _ in SHOWN_BY), ARMS, LEGS, DIRECTIONS, DISTANCES, LIGHT,
    MANNERS, MANY, NUMBERS, OWN, PRONOUNS, RADAR, SIZES, SPEEDS,
)  # fmt: skip
_CARRIED = words_in(_TABLE["carried"])
_HANDLING = words_in(_TABLE["handling"])
_OF_ACTIVITY = {key: words_in(words) for key, words in _TABLE["of_activity"].items()}
_CURVES = words_in(_TABLE["curves"])
_PLACES = frozenset({*SEATS, *TARGETS})


def nouns_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for words that no step has to do with."""
    for token in given.tokens:
        if token.clause in given.otherwise or _is_shown(given, token):
            continue
        before = given.texts(token.place - 1, token.place)
        words = f"{before[0]} {token.text}" if before and before[0] in _QUALIFIERS else token.text
        yield token.clause, f"{words!r} is not shown"


_OPENING = words_in(
    "a an the his her their its my in of on with like from off over under through onto across by without"
)
_ARTICLES = words_in("a an the")  # "stands on a box"
_PEOPLE = words_in("person man woman he she it they someone somebody figure subject human guy girl boy who that which")
_ENDING = re.compile(r"[^a-z']|ly$|ing$")
_VERBS = words_in("is are was were does plays playing")
_QUALIFIERS = words_in("tight running imaginary balance")


def _is_shown(given: Given, token: Token) -> bool:
    text = token.text
    if text in _SILENT or not _is_noun(given, token):
        return True
    own = given.own(token)
    return any(_has_to_do_with(step, text) for step in own)


def _is_noun(given: Given, token: Token) -> bool:
    """Whether a word belongs to what a determiner or a preposition opens, before the next verb: "on a tight rope"."""
    before = given.tokens[: token.place]
    if not any(
        other.word.is_verb or other.word.is_going or other.text in _VERBS for other in before
    ):  # whoever does it
        return False
    for other in reversed(before):
        text = other.text
        if text in _OPENING:
            is_verb = (token.word.is_verb or token.word.is_going) and before[-1].text not in _ARTICLES
            return not is_verb and _ENDING.search(token.text) is None
        if text in LINKS or text in _PEOPLE or other.word.is_verb or other.word.is_going or text in ("to", "is", "are"):
            return False
    return False


def _has_to_do_with(step: Step, text: str) -> bool:
    keys = {step.upper} if step.upper and step.lower == "stand" else {step.lower, step.upper}
    if any(text in _OF_ACTIVITY.get(key, ()) for key in keys) or (text in _CARRIED and keys & _HANDLING):
        return True
    if text in _CURVES and (step.arc_deg or step.direction in ("circle", "around") or step.lower == "turn"):
        return True
    names = " ".join(BY_KEY[key].name for key in keys if key).split()
    stem = text.removesuffix("s")[:4]
    if step.place is not None and text.removesuffix("s") in re.findall("[a-z]+", step.place.words):
        return True  # the corner, the two chairs
    placed = step.target or step.place is not None or step.seat or step.uses_seat or step.facing
    return any(name.startswith(stem) for name in names) or (text in _PLACES and bool(placed or keys & _HANDLING))
