"""What is printed holds no control characters: names of files, sentences and radars come from anywhere."""

import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from typing import Any

_LINES = "\n\t"
# Control characters, bidirectional marks and unpaired surrogates, written as JSON writes them: a summary that is
# printed as JSON keeps its values.
ESCAPES = {
    code: f"\\u{code:04x}"
    for code in (*range(0x20), *range(0x7F, 0xA0), 0x61C, *range(0x200B, 0x2070), *range(0xD800, 0xE000), 0xFEFF)
    if unicodedata.category(chr(code)) in ("Cc", "Cf", "Cs", "Zl", "Zp")
}
_IN_TEXT = {code: text for code, text in ESCAPES.items() if chr(code) not in _LINES}


def printable(name: object) -> str:
    r"""A name of a file, a radar or a label, as it may be printed.

    >>> printable("a\x1b[2Jb\n")
    'a\\u001b[2Jb\\u000a'
    """
    return str(name).translate(ESCAPES)


class _Printed:
    """A text stream without control characters; those that its encoding lacks are escaped, too."""

    def __init__(self, stream: Any, *, has_bar: bool):
        self._stream, self._has_bar = stream, has_bar

    def write(self, text: str) -> int:
        start = "\r" if self._has_bar and text.startswith("\r") else ""  # as a progress bar begins
        shown = start + text[len(start) :].translate(_IN_TEXT)
        encoding = getattr(self._stream, "encoding", None) or "utf-8"
        self._stream.write(shown.encode(encoding, "backslashreplace").decode(encoding))
        return len(text)

    def writelines(self, lines: Any) -> None:
        for line in lines:
            self.write(line)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def safe_printing() -> Iterator[None]:
    """Context in which nothing that is printed holds control characters but line breaks and tabs."""
    out: Any = sys.stdout and _Printed(sys.stdout, has_bar=False)
    err: Any = sys.stderr and _Printed(sys.stderr, has_bar=True)
    with redirect_stdout(out), redirect_stderr(err):
        yield
