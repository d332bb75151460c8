"""Tokenization: phrases become one token, inflected verbs are lemmatized.

Spelling correction: a long unknown word one edit away from exactly one known word is corrected to it.

In short words only slips are corrected that hardly ever form another English word: swapped neighbours, a doubled
letter, and a missing letter without which the word is unpronounceable ("wlks").
Reference: docs/decisions/reading-sentences.md.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA
from mmweaver.motion.language.described_person import strip_stature
from mmweaver.motion.language.lexicon import (
    ALL_WORDS,
    GOING,
    IRREGULAR,
    LIGHT,
    MORE_WORDS,
    OTHER_VERBS,
    OTHER_WORDS,
    RECOVERING,
)
from mmweaver.motion.language.places import mark_places
from mmweaver.motion.language.rewrite_rules import rewritten, words_of_phrases

LONG = 6  # letters; shorter words have too many neighbours
SHORTEST = 4
# No vowel, or two consonants that begin no English word.
UNSPEAKABLE = re.compile(
    r"[^aeiouy]+$|(?!b[lr]|c[hlr]|d[rw]|f[lr]|g[hlnr]|k[lnr]|p[hlrs]|rh|s[chklmnpqtvw]|t[hrsw]|w[hr])[^aeiouy]{2}"
)


def correct_spelling(text: str) -> tuple[str, list[str]]:
    """Corrects misspellings.

    Args:
        text: The sentence.

    Returns:
        The corrected text, and a note per correction.
    """
    notes: list[str] = []

    def replace_word(match: re.Match[str]) -> str:
        word = match.group()
        is_name = len(word) < LONG and word.istitle()
        better = "" if is_name else corrected_word(word.lower())
        if not better:
            return word
        notes.append(f"{word!r} is read as {better!r}")
        return better

    return re.sub(r"(?<![A-Za-z_])[A-Za-z]+(?![A-Za-z_])", replace_word, text), notes


@lru_cache(maxsize=4096)
def corrected_word(word: str) -> str:
    """The known word of which an unknown one is a misspelling, or "".

    Args:
        word: Word in lower case.

    >>> corrected_word("forwads"), corrected_word("walks"), corrected_word("sings"), corrected_word("wlks")
    ('forwards', '', '', 'walks')
    """
    known = _known()
    if len(word) < SHORTEST or {word, f"{word}s"} & known or word in OTHER_WORDS or word in _other_forms():
        return ""
    if len(word) < LONG:
        near = [other for other in _whole_words() if _is_slip(word, other)]
        near = near if len(near) == 1 else [other for other in near if other in _movements()]
    else:
        near = [other for other in known if other[0] == word[0] and len(other) >= 5 and _one_edit_apart(word, other)]
    return near[0] if len(near) == 1 else ""


def _is_slip(word: str, other: str) -> bool:
    """Whether a short word differs by swapped neighbours, a doubled letter, or a missing letter that it needs."""
    if len(other) < SHORTEST or other[0] != word[0] or not _one_edit_apart(word, other):
        return False
    if len(word) == len(other):
        return sorted(word) == sorted(other)
    if len(word) < len(other):
        return UNSPEAKABLE.match(word) is not None
    return any(one == next_ and word[:k] + word[k + 1 :] == other for k, (one, next_) in enumerate(pairwise(word)))


def _one_edit_apart(one: str, other: str) -> bool:
    """Whether one letter is inserted, deleted or replaced, or two neighbours are swapped."""
    if abs(len(one) - len(other)) > 1 or one == other:
        return False
    start = 0
    while start < min(len(one), len(other)) and one[start] == other[start]:
        start += 1
    a, b = one[start:], other[start:]
    return a[1:] == b or a == b[1:] or a[1:] == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:])


@lru_cache(maxsize=1)
def _known() -> frozenset[str]:
    """Every word that the parser knows in some form."""
    return _whole_words() | frozenset(word for word in words_of_phrases() if word.isalpha() and word.islower())


@lru_cache(maxsize=1)
def _whole_words() -> frozenset[str]:
    """The known words without the stems of patterns."""
    known = _movements() | _forms(LIGHT) | ALL_WORDS | RECOVERING | MORE_WORDS
    return frozenset(word for word in known if word.isalpha() and word.islower())


@lru_cache(maxsize=1)
def _movements() -> frozenset[str]:
    return _forms({*ACTIVITY_OF_LEMMA, *GOING}) | set(IRREGULAR)


def _forms(verbs: Iterable[str]) -> frozenset[str]:
    """Verbs with their regular inflections."""
    forms: set[str] = set()
    for verb in verbs:
        if verb.isalpha():
            stem, double = verb.removesuffix("e"), verb + verb[-1]
            if verb.endswith("y") and verb[-2] not in "aeou":
                forms |= {f"{verb[:-1]}ies", f"{verb[:-1]}ied"}
            forms |= {verb, f"{verb}s", f"{verb}es", f"{stem}ing", f"{stem}ed", f"{double}ing", f"{double}ed"}
    return frozenset(forms)


@lru_cache(maxsize=1)
def _other_forms() -> frozenset[str]:
    return _forms({*OTHER_VERBS, *(word for word in words_of_phrases() if len(word) > 2)})


def forget_known_words() -> None:
    """Clears the caches after a verb was added."""
    for remembered in (_movements, _whole_words, _known):
        remembered.cache_clear()
    corrected_word.cache_clear()


_TOKEN = re.compile(r"[a-z_']+[0-9_]*(?:-[a-z]+)*|\d+(?:\.\d+)?|[,;:.!?]")


@dataclass(frozen=True)
class Word:
    """One token of a sentence.

    Attributes:
        text: The text.
        lemma: Lemma of a known verb, else the text again.
        form: Verb form: base, s, ing or past; "" if it is no known verb.
    """

    text: str
    lemma: str
    form: str

    @property
    def is_verb(self) -> bool:
        return bool(self.form)

    @property
    def is_activity(self) -> bool:
        return self.lemma in ACTIVITY_OF_LEMMA and self.is_verb

    @property
    def is_going(self) -> bool:
        return self.lemma in GOING and self.is_verb


def words_of(text: str) -> list[Word]:
    """Words and punctuation marks of a sentence in lower case, known phrases as one token.

    Args:
        text: The sentence.
    """
    folded = text.lower().replace("\u2019", "'").replace("n't", " not")
    folded = rewritten(mark_places(strip_stature(folded)), "phrases")
    return [word_of(token) for token in _TOKEN.findall(folded)]


@lru_cache(maxsize=4096)
def word_of(token: str) -> Word:
    """Lemma and form of a token.

    Args:
        token: Token in lower case.

    >>> word_of("clapped")
    Word(text='clapped', lemma='clap', form='past')
    """
    if token in IRREGULAR:
        lemma = IRREGULAR[token]
        return Word(token, lemma, "s" if token in ("does", "has", "goes") else "past")
    for lemma, form in _candidates(token):
        if lemma in ACTIVITY_OF_LEMMA or lemma in GOING or lemma in LIGHT:
            return Word(token, lemma, form)
    return Word(token, token, "")


def _candidates(token: str) -> list[tuple[str, str]]:
    found = [(token, "base")]
    if token.endswith("s"):
        if len(token) > 4 and token[-2] == token[-3]:
            found.append((token[:-2], "s"))
        found += [(token[:-1], "s"), (token[:-2] if token.endswith("es") else token, "s")]
        if token.endswith("ies"):
            found.append((token[:-3] + "y", "s"))
    for ending, form in (("ing", "ing"), ("ed", "past")):
        if token.endswith(ending) and len(token) >= len(ending) + 2:
            stem = token[: -len(ending)]
            found += [(stem, form), (stem + "e", form)]
            if len(stem) > 2 and stem[-1] == stem[-2]:
                found.append((stem[:-1], form))
    return found
