"""Errors caused by bad input, which the user can correct."""

import contextlib
import re
from collections.abc import Iterator, Mapping
from typing import Any

MAX_CHARACTERS = 500
_LONG_WORD = re.compile(r"\S{121,}")


class InputError(ValueError):
    """Bad input: one line of at most 500 characters stating what was wrong and what to do.

    Line breaks and control characters of quoted values are escaped, and long values are shortened. The command line
    prints the line as is and exits with status 2; any other exception is a bug.
    """

    code = "input"  # which kind of mistake, for readers that have words of their own, such as the studio's page

    def __init__(self, message: object = ""):
        super().__init__(one_line(str(message)))


@contextlib.contextmanager
def file_named(path: object) -> Iterator[None]:
    """Context that prefixes InputErrors raised inside with a file name unless they start with it.

    Args:
        path: The file.

    Raises:
        InputError: With the prefixed message.
    """
    try:
        yield
    except InputError as error:
        text = str(error)
        raise InputError(text if text.startswith(str(path)) else f"{path}: {text}") from None


@contextlib.contextmanager
def error_code(code: str) -> Iterator[None]:
    """Context that gives InputErrors raised inside a code, unless they have one.

    Args:
        code: The code.

    Raises:
        InputError: The same, with the code.
    """
    try:
        yield
    except InputError as error:
        if error.code == InputError.code:
            error.code = code
        raise


class NoRoomError(InputError):
    """A motion does not fit into a room; `recovery_options` lists what would help.

    Keys, where known: `nearest_place_m` (x, y); `range_m`, the (near, far) range window that place needs, None if the
    radar cannot provide it; `radars`, names of presets that can.
    """

    code = "no_room"

    def __init__(self, message: str, *, recovery_options: Mapping[str, Any] | None = None) -> None:
        self.recovery_options: dict[str, Any] = dict(recovery_options or {})
        super().__init__(message + _advice(self.recovery_options))


def _advice(recovery_options: Mapping[str, Any]) -> str:
    if not recovery_options:
        return ""
    x, y = recovery_options["nearest_place_m"]
    radars = f"--radar {' or '.join(recovery_options['radars'])}" if recovery_options["radars"] else ""
    if recovery_options["range_m"] is None:
        return f"; the nearest free place is {x:g},{y:g}: try {radars}"
    near_m, far_m = recovery_options["range_m"]
    radars = f" (or without it {radars})" if radars else ""
    return f"; the nearest free place is {x:g},{y:g}: try --range {near_m:g},{far_m:g}{radars}"


def one_line(text: str, limit: int = MAX_CHARACTERS) -> str:
    r"""Formats a text as one printable line; shortens long words first, then cuts the middle.

    Args:
        text: Any text.
        limit: Maximum number of characters. Default: 500.

    Returns:
        One line without control characters.

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
