"""The sentence as it was given, word by word, with the clause and the steps that each word belongs to."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from mmweaver.motion.language.accounts import TOKEN, clause_of_each
from mmweaver.motion.language.mentions import without_no_limbs
from mmweaver.motion.language.plan import ClauseRecord, Step
from mmweaver.motion.language.spelling import correct_spelling
from mmweaver.motion.language.verbs import words_in
from mmweaver.motion.language.words import Word, word_of

LINKS = words_in(", . ; : and then while before after until but when")
_DENIED = re.compile(r"not|never|without|\w+n't")
_COMPARED = words_in("like though although if")  # what follows is no movement: "as if stumbling"


@dataclass(frozen=True, kw_only=True)
class Token:
    """One word: its place in the sentence, the number of its clause, and of its part between two connectives."""

    text: str
    place: int
    clause: int
    part: int

    @property
    def word(self) -> Word:
        return word_of(self.text)


@dataclass(frozen=True, kw_only=True)
class Given:
    """A sentence and its plan; `otherwise`: clauses whose record says already that something else is acted out."""

    text: str
    tokens: tuple[Token, ...]
    steps: tuple[Step, ...]
    otherwise: frozenset[int]

    def texts(self, start: int, end: int) -> list[str]:
        """The words from one place to another; nothing before the first."""
        return [token.text for token in self.tokens[max(start, 0) : max(end, 0)]]

    def token_at(self, position: int) -> Token:
        """The word that begins at a position of the text, or the next one."""
        place = len(TOKEN.findall(self.text[:position]))
        return self.tokens[min(place, len(self.tokens) - 1)]

    def matches(self, pattern: re.Pattern[str]) -> Iterator[tuple[re.Match[str], Token]]:
        """(match, its first word) for each place where the sentence has a pattern."""
        for found in pattern.finditer(self.text):
            yield found, self.token_at(found.start())

    def of_clause(self, number: int) -> list[Step]:
        """The steps of a clause."""
        return [step for step in self.steps if number in step.clauses]

    def own(self, token: Token) -> Sequence[Step]:
        """The steps of a word's clause, or all where it has none."""
        return self.of_clause(token.clause) or self.steps

    @cached_property
    def compared(self) -> frozenset[int]:
        """Places of words that say what a movement is like, or what is not done: "as if stumbling", "did not fall"."""
        places, is_open = set(), False
        for token in self.tokens:
            is_open = token.text not in LINKS and (is_open or token.text in _COMPARED)
            is_denied = any(_DENIED.fullmatch(text) for text in self.texts(token.place - 2, token.place))
            if is_open or is_denied:
                places.add(token.place)
        return frozenset(places)


def given(text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], otherwise: set[int]) -> Given:
    """The words of a sentence, after spelling correction, with their clauses."""
    folded = without_no_limbs(_corrected(text))
    texts = TOKEN.findall(folded)
    numbers, _ = clause_of_each(texts, records)
    tokens, part = [], 0
    for place, (one, number) in enumerate(zip(texts, numbers, strict=True)):
        part += one in LINKS
        tokens.append(Token(text=one, place=place, clause=number, part=part))
    return Given(text=folded, tokens=tuple(tokens), steps=tuple(steps), otherwise=frozenset(otherwise))


def _corrected(text: str) -> str:
    """The text with misspellings corrected; a plural stays one."""
    given_words, words = text.split(), correct_spelling(text)[0].split()
    return " ".join(
        old if old.lower().rstrip("s,.;") == new.lower().rstrip("s,.;") else new
        for old, new in zip(given_words, words, strict=True)
    )
