"""Tables of numbers that scans bring as text."""

from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_text


def number_table(path: Path, *, allow_infinite: bool = False) -> np.ndarray:
    """Rows of numbers between commas or spaces; lines of words at the top and comments (#) are left out.

    Raises InputError where the rest is no table.
    """
    lines = [line for line in read_text(path).splitlines() if line.strip() and not line.lstrip().startswith("#")]
    if lines and not _numbers(lines[0]):
        lines = lines[1:]
    found = [_numbers(line) for line in lines]
    if not found or any(len(row) != len(found[0]) or not row for row in found):
        raise InputError(f"{path} holds no table of numbers")
    rows = np.array(found)
    if not allow_infinite and not np.isfinite(rows).all():
        raise InputError(f"{path} holds no table of numbers")
    return rows


def _numbers(line: str) -> list[float]:
    """The numbers of a line; none where a word is not one."""
    try:
        return [float(word) for word in line.replace(",", " ").split()]
    except ValueError:
        return []
