"""Verbs with two senses: what a step shows of the word is not what the sentence means by it."""

import re
from collections.abc import Callable, Iterator

from mmweaver.motion.language.accounts import alike
from mmweaver.motion.language.checks.given import Given
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA
from mmweaver.motion.language.words import word_of

_FOOT = r"(?:foot|leg)"


def _is(*keys: str) -> Callable[[Step], bool]:
    return lambda step: step.lower in keys or step.upper in keys


def _is_one_gait_step(step: Step) -> bool:
    return step.lower in ("walk", "jog") and step.count == 1


# (words, the step of the other sense, what that step shows)
_SENSES: tuple[tuple[re.Pattern[str], Callable[[Step], bool], str], ...] = (
    (
        re.compile(
            rf"\b(?P<said>sweep\w*|swept)\b(?: (?!floor\b|broom\b|and\b|then\b)[a-z]+){{0,5}}? {_FOOT}\b"
            rf"|\b{_FOOT} (?P<noun>sweep\w*)\b"
        ),
        _is("sweep"),
        "sweeping the floor with both hands",
    ),
    (re.compile(rf"\b{_FOOT} (?P<said>ris(?:e|es|ing))\b"), _is("stand_up"), "standing up"),
    (
        re.compile(r"\buntil (?:he|she|they|it|the [a-z]+) (?P<said>reach(?:es|ed)?|arrives?)\b"),
        _is("reach"),
        "reaching out with a hand",
    ),
    (
        re.compile(r"\b(?P<said>pick(?:s|ing|ed)? up) (?:in |the |some |his |her |their )*(?:speed|pace|tempo)\b"),
        _is("pick_up"),
        "picking something up from the floor",
    ),
    (
        re.compile(r"\b(?P<said>(?:walk|run|jog)\w*) (?:in|to|into) (?:the other|that|this|each|any) one\b"),
        _is_one_gait_step,
        "one step",
    ),
    (
        re.compile(r"\b(?P<said>side (?:jump|hop|leap)s?)\b"),
        lambda step: step.lower in ("jump", "hop", "hop_one_leg") and not step.moves,
        "jumping on the spot",
    ),
    (re.compile(r"\b(?P<said>kick(?:s|ing)? steps)\b"), _is("kick"), "a kick before the steps"),
)


def senses_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for words that a step shows in another sense."""
    for pattern, is_other, shown in _SENSES:
        for found, token in given.matches(pattern):
            here = {token.clause, given.token_at(found.end() - 1).clause}
            own = [step for step in given.steps if here & {*step.clauses}]
            if any(map(is_other, own)):
                said = next(filter(None, found.groupdict().values()))
                yield token.clause, f"{said!r} is shown as {shown}"
    yield from _only_tried(given)


_TRIED = re.compile(
    r"\b(?:attempt(?:s|ed|ing)?|tr(?:y|ies|ied|ying)|struggl(?:es|ed|ing)) to (?:[a-z]+ly )?(?P<verb>[a-z]+)"
)

_RISING = ("get", "stand", "rise", "come", "straighten")


def _only_tried(given: Given) -> Iterator[tuple[int, str]]:
    """An attempt has a step that does it: "tries to stand up"."""
    for found, token in given.matches(_TRIED):
        word = word_of(found["verb"])
        lower, upper = ACTIVITY_OF_LEMMA.get(word.lemma, ("", "")) if word.is_activity else ("", "")
        own = given.of_clause(token.clause)
        keys = {key for step in own for key in (step.lower, step.upper) if key}
        is_shown = any(alike(upper or lower, key) for key in keys) if own else word.text in _RISING
        if is_shown or (word.text in _RISING and keys & {"stand_up", "get_up", "kneel_up", "sit_up"}):
            yield token.clause, f"{found[0]!r} is shown as done, not only tried"
