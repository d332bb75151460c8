"""The errors for bad input, which the user can correct."""

import contextlib
import re
from collections.abc import Iterator, Mapping
from typing import Any

MAX_CHARACTERS = 500
_LONG_WORD = re.compile(r"\S{121,}")


class InputError(ValueError):
    """Bad input: one line on what was wrong and what to do about it, of at most 500 characters.

    Line breaks and control characters of a value that is quoted are made harmless, and long values are shortened. The
    command line prints the line as it is and exits with status 2; anything else that is raised is a bug.
    """

    def __init__(self, message: object = ""):
        super().__init__(one_line(str(message)))


@contextlib.contextmanager
def file_named(path: object) -> Iterator[None]:
    """Puts a file's name before the InputErrors raised inside, where they lack it."""
    try:
        yield
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None


class NoRoomError(InputError):
    """A motion finds no room in a photo; `ways_on` says what would help.

    Keys, where known: `nearest_place_m` (x, y), `range_m` (near, far) of the window that it needs, None where the radar
    cannot have it, `radars` (names of presets that have such a window).
    """

    def __init__(self, message: str, *, ways_on: Mapping[str, Any] | None = None) -> None:
        self.ways_on: dict[str, Any] = dict(ways_on or {})
        super().__init__(message + _in_words(self.ways_on))


def _in_words(ways_on: Mapping[str, Any]) -> str:
    if not ways_on:
        return ""
    x, y = ways_on["nearest_place_m"]
    radars = f"--radar {' or '.join(ways_on['radars'])}" if ways_on["radars"] else ""
    if ways_on["range_m"] is None:
        return f"; the nearest free place is {x:g},{y:g}: try {radars}"
    near_m, far_m = ways_on["range_m"]
    radars = f" (or without it {radars})" if radars else ""
    return f"; the nearest free place is {x:g},{y:g}: try --range {near_m:g},{far_m:g}{radars}"


def one_line(text: str, limit: int = MAX_CHARACTERS) -> str:
    r"""A text as one printable line; long words are shortened first, then the middle is left out.

    >>> one_line("a\nb\x1b[31m")
    'a b\\x1b[31m'
    """
    text = " ".join(text.split())
    if len(text) > limit:
        text = _LONG_WORD.sub(lambda word: f"{word[0][:80]}...{word[0][-30:]}", text)
    if not text.isprintable():
        text = "".join(character if character.isprintable() else ascii(character)[1:-1] for character in text)
    if len(text) > limit:
        text = f"{text[: limit - 165]} ... {text[-160:]}"
    return text
