"""Spelling correction: a long unknown word one edit away from exactly one known word is read as that word.

Of short words only slips are corrected that hardly ever make another English word: neighbours swapped, a letter typed
twice, and a missing letter without which the word cannot be spoken ("wlks").
Reference: docs/decisions/reading-sentences.md.
"""

import re
from collections.abc import Iterable
from functools import lru_cache
from itertools import pairwise

from mmweaver.motion.language.gesture_phrases import GESTURE_PHRASES
from mmweaver.motion.language.lexicon import ALL_WORDS, GOING, IRREGULAR, LIGHT
from mmweaver.motion.language.phrases import ACTIVITY_PHRASES
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA, RECOVERING, words_in

LONG = 6  # letters; shorter words have too many neighbours
SHORTEST = 4
# No vowel, or two consonants with which no English word begins.
UNSPEAKABLE = re.compile(
    r"[^aeiouy]+$|(?!b[lr]|c[hlr]|d[rw]|f[lr]|g[hlnr]|k[lnr]|p[hlrs]|rh|s[chklmnpqtvw]|t[hrsw]|w[hr])[^aeiouy]{2}"
)
# Correct English words one edit away from words of the lexicon.
OTHER_WORDS = words_in(
    """
    shovel shovels shoveling shovelling jagged swagger swaggers
    sagging staging slapping clasping swaying strokes singing clasps shaved
    showing shows showed shaving passes passed bowls shakes wakes slides rides stars starts stands
    stares staring planks waving weaving jumper walker runner turner stepper sitting setting hitting spitting
    falling calling filling standing landing lifting sifting rolling pulling polling pushing rushing wiping piping
    tipping ripping texting testing resting reading heading leading kicking licking picking packing pointing
    painting printing bending sending lending mending
    angel baht beta booth clam clasp clod dose east fits garb garbs hoops juts leis lien lisp posse quiet resp spied
    spies steep sties tinny tort torts tried weer wheen writs rial maths paris moore donne angels boyd salas
    """
)
# Other verbs: their inflected forms are no misspellings of words of the lexicon.
OTHER_VERBS = words_in(
    """
    talk cook wash watch wish work warn warm weep whip shout shine shave shoot shop show sing sink slip slap sleep
    slide smell smile smoke sneeze sniff snore spit split spread squeeze steal sting strike string strip study
    swear sweep swim swing switch teach tear tell think tickle tie tighten tremble twist unpack vacuum visit wake
    want wear win wind wink worry yawn yell hide hit hug hurt hum hunt iron join juggle knit laugh lead learn
    leave lick light listen live load lock look lose love melt mend mix mop mow nail open order pack paint park
    pass paste pay peel pet pick plan plant play pour pray press print pump punish race rake reply rest ride ring
    roll row rub sail sew shake sharpen bake bathe beat beg bite blow brake break breathe build burn bury buy call
    camp care carve catch change charge chase chat check chew chop climb close coach collect cough count cover
    crash crawl creep cry curl cut dig dive draw dream dress drill drive drop drum dry escape exercise explode
    fail fan fasten feed fight fill film find fix flap float fly follow fry gather gaze glue grin grip groan guess
    joke fake spike smack mark sin lump trap map clip pat swat rot band sand bind wade fade thread pave rave starve
    graze lace lance sow saw claw paw lunch pinch match cull heal seal retch cope slope drape skim heap reap beep drawl
    list waste ease gasp skate
    handle hang wave wag speak stare store stir star strain train trim tap tape taste trade
    """
)
_MORE = (
    "quarter quarters degrees degree circle circles clockwise counterclockwise anticlockwise forward backward"
    " teenage teenaged gigantic adolescent infant dwarf"
)
_WORD = re.compile(r"[a-z]+")


def correct_spelling(text: str) -> tuple[str, list[str]]:
    """The text with misspellings corrected, and a note for each."""
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
    """The known word that an unknown one is a misspelling of, or "".

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
    """Whether a short word is another one with neighbours swapped, a letter twice or one missing that it needs."""
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
    return _whole_words() | frozenset(word for word in _of_patterns() if word.isalpha() and word.islower())


@lru_cache(maxsize=1)
def _whole_words() -> frozenset[str]:
    """The known words without the stems of patterns."""
    known = _movements() | _forms(LIGHT) | ALL_WORDS | RECOVERING | words_in(_MORE)
    return frozenset(word for word in known if word.isalpha() and word.islower())


@lru_cache(maxsize=1)
def _movements() -> frozenset[str]:
    return _forms({*ACTIVITY_OF_LEMMA, *GOING}) | set(IRREGULAR)


def _of_patterns() -> set[str]:
    """The words, and stems of words, that patterns of phrases are made of."""
    patterns = " ".join(pattern for pattern, _ in (*GESTURE_PHRASES, *ACTIVITY_PHRASES))
    return set(_WORD.findall(re.sub(r"\\[a-z]|\(\?[:=!<]*", " ", patterns)))


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
    return _forms({*OTHER_VERBS, *(word for word in _of_patterns() if len(word) > 2)})


def forget_known_words() -> None:
    """For when a verb was added."""
    for remembered in (_movements, _whole_words, _known):
        remembered.cache_clear()
    corrected_word.cache_clear()
