"""Repetition of a whole sentence: 'repeats this twice', 'three times, a person ...'."""

import re
from dataclasses import dataclass

from mmweaver.motion.language.lexicon import NUMBERS

_SOME = 3  # several, many, multiple times
_TIMES = r"(once|twice|thrice|(?:\w+) (?:more )?times)"
_ALL_OF_IT = (
    r"(?:it|this|that|them|these|everything"
    r"|(?:the|this) (?:whole |entire |same )?(?:process|motion|movements?|sequence|exercise|steps))"
)
_AT_END = re.compile(
    rf"(?:[,;.]|\band\b|\bthen\b|\s)*\b(repeats?|repeating|does|do|doing)\b ?({_ALL_OF_IT})?"
    rf" ?(?:once )?(again|more)? ?(?:for )?{_TIMES}?(?: in a row| again| more| in total)?\s*[.!]?\s*$",
    re.IGNORECASE,
)
_AT_START = re.compile(rf"^\s*{_TIMES},? (?=(?:an?|the|some(?:one|body)|he|she)\b)", re.IGNORECASE)


_SIT_TO_STAND = re.compile(
    r"(?:\b(?:does|performs|do|perform) )?(?:\b(\w+) )?\bsit[- ]to[- ]stands?\b"
    r"(?:,? (?:for )?(\w+) (?:reps?|repetitions?|times)\b)?",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class RepeatedSentence:
    """The sentence to repeat, the total number of times, and the words that state it."""

    text: str
    times: int = 1
    words: str = ""


def repetition_of(text: str) -> RepeatedSentence:
    """Splits off the words that repeat the whole sentence.

    Args:
        text: The sentence.

    >>> repetition_of("a person bows, then claps and repeats this twice")
    RepeatedSentence(text='a person bows, then claps', times=3, words='repeats this twice')
    """
    found = _SIT_TO_STAND.search(text)
    if found:
        word = next((word for word in (found[2], found[1]) if word and (word in NUMBERS or word.isdigit())), "1")
        rest = f"{text[: found.start()]}sits down, then stands up{text[found.end() :]}"
        return RepeatedSentence(rest, max(_number(word), 1), found[0].strip())
    found = _AT_START.match(text)
    if found:
        return RepeatedSentence(text[found.end() :], max(_number(found[1]), 1), found[0].strip(" ,"))
    found = _AT_END.search(text)
    does = found is not None and found[1].lower().startswith("do")
    if found is None or not found.start() or (does and not (found[2] and (found[3] or found[4]))):
        return RepeatedSentence(text)
    more = _number(found[4]) if found[4] else 1
    in_all = found[0].rstrip(" .!").endswith("in total") or (does and not found[3] and "more" not in found[0])
    words = found[0][found.start(1) - found.start() :].strip(" .!")
    return RepeatedSentence(text[: found.start()].rstrip(" ,;."), max(more if in_all else more + 1, 1), words)


def _number(words: str) -> int:
    first = words.lower().split()[0]
    return NUMBERS.get(first, int(first) if first.isdigit() and len(first) < 3 else _SOME)
