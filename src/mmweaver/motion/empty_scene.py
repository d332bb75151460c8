"""Recognizes sentences of an empty scene, without a person."""

import re

NOBODY = "nobody"  # canonical form, used in task files, requests and meta.json
_ANYBODY = r"(?:nobody|no ?-?one|no (?:person|people|human))"
_PLACE = r"(?:room|place|scene|floor|house|kitchen|bedroom|bathroom|office|hall|corridor|(?:living|dining) room)"
_EMPTY = re.compile(
    rf"(?:there (?:is|are) |there's )?{_ANYBODY}(?: is| are)?(?: there| here| present| around)?"
    rf"(?: (?:in|inside) (?:the|this|my|it|an?)?(?: empty)? ?{_PLACE}?)?"
    rf"|(?:(?:the|this|my|an?) )?{_PLACE}(?: (?:is|stays|remains|that is))? empty"
    rf"|(?:(?:the|this|my|an) )?empty {_PLACE}(?: with {_ANYBODY}(?: in it| there)?)?"
    rf"|(?:(?:the|this|my|an?) )?{_PLACE} (?:with|without) (?:{_ANYBODY}|people|anyone|anybody|a person)(?: in it)?"
)


def says_nobody(text: str) -> bool:
    """Whether a whole sentence describes an empty scene.

    Args:
        text: The sentence.

    >>> says_nobody("nobody"), says_nobody("An empty room."), says_nobody("nobody waves")
    (True, True, False)
    """
    words = " ".join(text.lower().strip().rstrip(".!").split())
    return bool(_EMPTY.fullmatch(words))
