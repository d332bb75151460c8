"""Tokenization: phrases become one token, inflected verbs are lemmatized."""

import re
from dataclasses import dataclass
from functools import lru_cache

from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA
from mmweaver.motion.language.described_person import strip_stature
from mmweaver.motion.language.lexicon import GOING, IRREGULAR, LIGHT
from mmweaver.motion.language.places import mark_places
from mmweaver.motion.language.rewrite_rules import rewritten

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
