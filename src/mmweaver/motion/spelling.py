"""Slips of the keyboard: a long unknown word that is one letter away from a single known one is read as that."""

import re
from functools import lru_cache

from mmweaver.motion.lexicon import (
    ARMS, BOTH, DIRECTIONS, FILLERS, GOING, IRREGULAR, LIGHT, MANY, NEGATIONS, NOT_HUMAN, NUMBERS, OTHER_MOVEMENT, RADAR, SEATS,
    SPEEDS, TARGETS,
)  # fmt: skip
from mmweaver.motion.verbs import ACTIVITY_OF_LEMMA, ACTIVITY_PHRASES, RECOVERING

SHORTEST = 6  # letters; shorter words have too many neighbours
# Words of the language that are one letter away from ours and mean something else.
OTHER_WORDS = frozenset(
    "clasps shaved showing shows showed shaving passes passed bowls shakes wakes slides rides stars starts stands stares staring planks waving weaving jumper walker runner"
    " turner stepper sitting setting hitting spitting falling calling filling standing landing lifting sifting rolling"
    " pulling polling pushing rushing wiping piping tipping ripping texting testing resting reading heading leading"
    " kicking licking picking packing pointing painting printing bending sending lending mending".split()
)
_WORD = re.compile(r"[a-z]+")


def corrected(text: str) -> tuple[str, list[str]]:
    """The text with slips mended, and a note for each."""
    notes: list[str] = []

    def mend(match: re.Match[str]) -> str:
        word = match.group()
        better = mended(word.lower())
        if not better:
            return word
        notes.append(f"{word!r} is read as {better!r}")
        return better

    return re.sub(r"[A-Za-z]+", mend, text), notes


@lru_cache(maxsize=4096)
def mended(word: str) -> str:
    """The known word that an unknown one is a slip of, or "".

    >>> mended("forwads"), mended("walks"), mended("sings")
    ('forwards', '', '')
    """
    known = _known()
    if len(word) < SHORTEST or word in known or word in OTHER_WORDS:
        return ""
    near = [other for other in known if other[0] == word[0] and len(other) >= 5 and _one_slip(word, other)]
    return near[0] if len(near) == 1 else ""


def _one_slip(one: str, other: str) -> bool:
    """One letter more, less, other, or two neighbours swapped."""
    if abs(len(one) - len(other)) > 1 or one == other:
        return False
    start = 0
    while start < min(len(one), len(other)) and one[start] == other[start]:
        start += 1
    a, b = one[start:], other[start:]
    return a[1:] == b or a == b[1:] or a[1:] == b[1:] or (a[:2] == b[1::-1] and a[2:] == b[2:])


@lru_cache(maxsize=1)
def _known() -> frozenset[str]:
    """Every word that the reading knows in some form."""
    verbs = set(ACTIVITY_OF_LEMMA) | set(GOING) | set(LIGHT)
    known = set(IRREGULAR) | set(RECOVERING)
    for verb in verbs:
        if verb.isalpha():
            stem = verb.removesuffix("e")
            known |= {
                verb,
                verb + "s",
                verb + "es",
                stem + "ing",
                stem + "ed",
                verb + verb[-1] + "ing",
                verb + verb[-1] + "ed",
            }
    for words in (
        ARMS,
        BOTH,
        DIRECTIONS,
        FILLERS,
        MANY,
        NEGATIONS,
        NOT_HUMAN,
        NUMBERS,
        OTHER_MOVEMENT,
        RADAR,
        SEATS,
        SPEEDS,
        TARGETS,
    ):
        known |= set(words)
    for pattern, _ in ACTIVITY_PHRASES:
        known |= set(_WORD.findall(re.sub(r"\\[a-z]|\(\?[:=!<]*", " ", pattern)))
    known |= set(
        "quarter quarters degrees degree circle circles clockwise counterclockwise anticlockwise forward backward".split()
    )
    return frozenset(word for word in known if word.isalpha() and word.islower())
