"""The formats that results are exported to: each is one function, declared by one decorator.

@export_format("mat", "MATLAB", ending=".mat")
def write_mat(result: StoredResult, out: Path) -> str: ...
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mmweaver.io.stored_result import StoredResult

Write = Callable[[StoredResult, Path], str]  # writes into a folder, and reports what
WritePair = Callable[[StoredResult, StoredResult, Path], str]


@dataclass(frozen=True, kw_only=True)
class ExportFormat:
    """One format: what it is, and the functions that write it into a folder."""

    what: str
    write: Write
    needs_samples: bool
    ending: str  # of the one file that it writes, "" where it writes more
    write_pair: WritePair | None  # for two radars of one scene


FORMATS: dict[str, ExportFormat] = {}


def export_format(
    name: str, what: str, *, needs_samples: bool = False, ending: str = "", write_pair: WritePair | None = None
) -> Callable[[Write], Write]:
    """Declares the function that writes a format.

    Args:
        name: Name for `--to`.
        what: What it is, for people.
        needs_samples: Whether a result without raw samples cannot be written so.
        ending: Suffix of result.SUFFIX, where that is the one file that is written.
        write_pair: Function for two radars of one scene.

    Returns:
        A decorator that leaves the function as it is.
    """

    def register(write: Write) -> Write:
        FORMATS[name] = ExportFormat(
            what=what, write=write, needs_samples=needs_samples, ending=ending, write_pair=write_pair
        )
        return write

    return register
