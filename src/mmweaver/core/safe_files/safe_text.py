"""Text, JSON and TOML from files: bounded in size and depth, all numbers finite."""

import json
import math
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, foreign_errors, read_bytes

MAX_TEXT_BYTES = 64 * MEGABYTE
MAX_JSON_BYTES = 16 * MEGABYTE
MAX_DEPTH = 50  # of lists and objects in each other; what mmWeaver reads has fewer than 10
MAX_DIGITS = 64  # of a whole number; a float holds every such number


def read_text(path: Path | str, *, max_bytes: int = MAX_TEXT_BYTES, errors: str = "strict") -> str:
    """A UTF-8 text, without a byte order mark.

    Args:
        path: The file.
        max_bytes: Largest size that is read.
        errors: "replace" accepts bytes that are no UTF-8, in comments for example.

    Returns:
        The text.

    Raises:
        InputError: where it is no UTF-8 text or larger.
    """
    try:
        return read_bytes(path, max_bytes=max_bytes).decode("utf-8-sig", errors=errors)
    except UnicodeDecodeError as error:
        raise InputError(f"{path} is no UTF-8 text (byte {error.start}); save it as plain text") from None


def read_json(path: Path | str, *, max_bytes: int = MAX_JSON_BYTES) -> Any:
    """The content of a JSON file, as `parse_json` gives it."""
    return parse_json(read_text(path, max_bytes=max_bytes), str(path))


def parse_json(text: str | bytes, place: str) -> Any:
    """The content of JSON text.

    Args:
        text: The JSON.
        place: What it is called in errors.

    Returns:
        Lists, dicts, texts and numbers.

    Raises:
        InputError: for what is no JSON, for NaN, infinity, numbers too long for a float, lists and objects nested too
            deeply, and text that cannot be written again.
    """
    with foreign_errors(place, "no JSON ({reason}); write it again"):
        text = text.decode("utf-8-sig") if isinstance(text, bytes) else text
        content = json.loads(text, parse_float=_float, parse_int=_int, parse_constant=_refuse)
        _check_content(content)
    return content


def read_toml(path: Path | str, *, max_bytes: int = MEGABYTE) -> dict[str, Any]:
    """The content of a TOML file, with the limits of `parse_json`. Raises InputError for anything else."""
    import tomllib

    text = read_text(path, max_bytes=max_bytes)
    with foreign_errors(path, "no TOML ({reason}); write lines such as: frames = 20"):
        content = tomllib.loads(text, parse_float=_float)
        _check_content(content)
    return content


def _check_content(content: Any) -> None:
    """Raises ValueError where lists and objects are nested too deeply, or a number or text cannot be written again."""
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
                value.encode("utf-8")  # half a surrogate pair is no text
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
