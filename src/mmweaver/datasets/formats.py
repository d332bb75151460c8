"""Export formats of results: one decorated function per format.

@export_format("mat", "MATLAB", ending=".mat")
def write_mat(result: StoredResult, out: Path) -> str: ...
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mmweaver.io.stored_result import StoredResult

Write = Callable[[StoredResult, Path], str]  # writes into a folder and describes what was written
WritePair = Callable[[StoredResult, StoredResult, Path], str]


@dataclass(frozen=True, kw_only=True)
class ExportFormat:
    """One export format with the functions that write it into a folder."""

    what: str
    write: Write
    needs_samples: bool
    ending: str  # suffix of a single-file format, else ""
    write_pair: WritePair | None  # for two radars of one scene


FORMATS: dict[str, ExportFormat] = {}


def export_format(
    name: str, what: str, *, needs_samples: bool = False, ending: str = "", write_pair: WritePair | None = None
) -> Callable[[Write], Write]:
    """Decorator that registers the function that writes a format.

    Args:
        name: Name for `--to`.
        what: Description for messages.
        needs_samples: Whether the format requires raw samples. Default: False.
        ending: Suffix of the single file result.SUFFIX. Default: several files.
        write_pair: Function for two radars of one scene. Default: none.

    Returns:
        A decorator that leaves the function unchanged.
    """

    def register(write: Write) -> Write:
        FORMATS[name] = ExportFormat(
            what=what, write=write, needs_samples=needs_samples, ending=ending, write_pair=write_pair
        )
        return write

    return register
