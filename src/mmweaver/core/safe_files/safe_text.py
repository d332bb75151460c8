"""Text, JSON and TOML files with bounded size and depth and finite numbers only."""

import json
import math
import re
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, Place, foreign_errors, read_bytes

MAX_TEXT_BYTES = 64 * MEGABYTE
MAX_JSON_BYTES = 16 * MEGABYTE
MAX_DEPTH = 50  # nesting of lists and objects; mmWeaver's own files stay below 10
MAX_KEYS = 50_000  # parts of the keys of a TOML file; each takes a kilobyte while it is parsed
_TOML_WORDS = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*"{3,5}|'
    r"'''(?:[^']|'(?!''))*'{3,5}|"
    r'"(?:[^"\\\n]|\\.)*"|'
    r"'[^'\n]*'|#[^\n]*|[^\s\"'#.=,\[\]{}]+|[.=,\[\]{}\n]",
    re.DOTALL,
)
MAX_DIGITS = 64  # of an integer; a float can represent its magnitude


def read_text(path: Place | str, *, max_bytes: int = MAX_TEXT_BYTES, errors: str = "strict") -> str:
    """Reads a UTF-8 text and drops a byte order mark.

    Args:
        path: The file.
        max_bytes: Size limit in bytes. Default: 64 MB.
        errors: "strict", or "replace" to accept invalid bytes, for example in comments.

    Returns:
        The text.

    Raises:
        InputError: If it is not UTF-8, or larger.
    """
    try:
        return read_bytes(path, max_bytes=max_bytes).decode("utf-8-sig", errors=errors)
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is no UTF-8 text (byte {error.start}); save it as plain text") from None


def read_json(path: Place | str, *, max_bytes: int = MAX_JSON_BYTES) -> Any:
    """Reads a JSON file.

    Args:
        path: The file.
        max_bytes: Size limit in bytes. Default: 16 MB.

    Returns:
        Decoded JSON.

    Raises:
        InputError: If it is larger, or `parse_json` rejects it.
    """
    return parse_json(read_text(path, max_bytes=max_bytes), str(path))


def parse_json(text: str | bytes, place: str) -> Any:
    """Parses JSON text.

    Args:
        text: JSON.
        place: Name of the source for error messages.

    Returns:
        Lists, dicts, texts and numbers.

    Raises:
        InputError: If it is not valid JSON, or contains nan, infinity, excessively long integers, nesting that is too
            deep, or unpaired surrogates.
    """
    with foreign_errors(place, "no JSON ({reason}); write it again"):
        text = text.decode("utf-8-sig") if isinstance(text, bytes) else text
        content = json.loads(text, parse_float=_float, parse_int=_int, parse_constant=_refuse)
        _check_content(content)
    return content


def read_toml(path: Path | str, *, max_bytes: int = MEGABYTE) -> dict[str, Any]:
    """Reads a TOML file with the limits of `parse_json`.

    Args:
        path: The file.
        max_bytes: Size limit in bytes. Default: 1 MB.

    Returns:
        Decoded TOML.

    Raises:
        InputError: If it is not valid TOML, or larger.
    """
    import tomllib

    text = read_text(path, max_bytes=max_bytes)
    with foreign_errors(path, "no TOML ({reason}); write lines such as: frames = 20"):
        _check_toml_keys(text)
        content = tomllib.loads(text, parse_float=_float)
        _check_content(content)
    return content


def _check_toml_keys(text: str) -> None:
    """Raises ValueError for dotted keys that are too deep or too many: tomllib takes memory by the square of a key."""
    parts = total = 0
    for word in _TOML_WORDS.finditer(text):
        kind = word[0]
        if kind == ".":
            parts += 1
            if parts > MAX_DEPTH:
                raise ValueError(f"a key has more than {MAX_DEPTH} parts")
        elif kind in "=]":
            parts, total = 0, total + parts + 1
        elif kind in ",[{}\n":
            parts = 0
        if total > MAX_KEYS:
            raise ValueError(f"it has more than {MAX_KEYS} keys")


def _check_content(content: Any) -> None:
    """Raises ValueError for nesting that is too deep, and for numbers or texts that cannot be serialised again."""
    level, depth = [content], 0
    while level:
        if depth > MAX_DEPTH:
            raise ValueError(f"lists and objects are nested more than {MAX_DEPTH} deep")
        inner: list[Any] = []
        for value in level:
            if isinstance(value, dict):
                inner += value
                inner += value.values()
            elif isinstance(value, list):
                inner += value
            elif isinstance(value, str):
                value.encode("utf-8")  # fails for unpaired surrogates
            elif isinstance(value, int) and value.bit_length() > 256:
                raise ValueError("a whole number is too large")
        level, depth = inner, depth + 1


def _float(digits: str) -> float:
    value = float(digits)
    if not math.isfinite(value):
        raise ValueError(f"{digits[:20]} is no finite number")
    return value


def _int(digits: str) -> int:
    if len(digits) > MAX_DIGITS:
        raise ValueError(f"a number has {len(digits)} digits")
    return int(digits)


def _refuse(name: str) -> float:
    raise ValueError(f"it holds {name}")
