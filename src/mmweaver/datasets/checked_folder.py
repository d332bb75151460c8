"""A folder of a data set whose files are checked against SHA256SUMS before they are used."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.checksums import SUMS_FILE, damage_of_file, read_sums
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_zarr import ZarrFolder


@dataclass(frozen=True, kw_only=True)
class CheckedFolder:
    """A room, or the root of a data set; without checksums, as in sets of mmweaver before 1.0, all is accepted."""

    folder: Path
    sums: dict[str, str] | None
    made_by: str  # the command that makes damaged rooms anew

    @classmethod
    def of(cls, folder: Path, made_by: str) -> "CheckedFolder":
        """Reads the checksums. Raises InputError where their list is damaged."""
        return cls(folder=folder, sums=read_sums(folder), made_by=made_by)

    def check(self, *below: str, but: tuple[str, ...] = ()) -> None:
        """Checks all files whose name begins with one of `below` (default: all) and with none of `but`.

        A file is read once a process, and again when it has changed. Raises InputError for the first that is damaged.
        """
        for name, expected in (self.sums or {}).items():
            if name.startswith(below or "") and not name.startswith(but or "/"):
                found = damage_of_file(self.folder, name, expected)
                if found is not None:
                    raise self.damaged(str(found))

    def require_sums(self) -> None:
        """Raises InputError where the checksums are missing from a room that was written with them."""
        if self.sums is None:
            raise self.damaged(f"{self.folder / SUMS_FILE} is missing")

    def damaged(self, what: str) -> InputError:
        """The error for something damaged."""
        return InputError(f"{what}; make it anew with: {self.made_by}")

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Whatever Zarr raises over damaged files becomes an InputError."""
        try:
            yield
        except (InputError, MemoryError):
            raise
        except Exception as error:  # Zarr and its codecs raise some twenty kinds
            reason = " ".join(str(error).split())[:120] or type(error).__name__
            raise self.damaged(f"{self.folder} is damaged ({reason})") from error


def stored_sequence(
    files: CheckedFolder, arrays: ZarrFolder, below: str, name: str, index: int, shape: tuple[int, ...], **limits: float
) -> np.ndarray:
    """One sequence of an array that `zarr_arrays.put_sequences` wrote, float32 of `shape`.

    `below`: where its group lies in the folder, ending in "/"; only the shard that holds the sequence is checked and
    read. `limits`: `low` and `high` of its numbers. Raises InputError where it is damaged.
    """
    files.check(f"{below}{name}/zarr.json")
    with files.reading():
        files.check(f"{below}{name}/c/{index // arrays.rows_a_file(name)}/")
        return arrays.row(name, index, shape, kinds="f", **limits).astype(np.float32)


def stored_iq(
    files: CheckedFolder, arrays: ZarrFolder, below: str, index: int, shape: tuple[int, ...], scale: float
) -> np.ndarray:
    """The signals of one sequence of a group, complex64 (frame, range, doppler, antenna), in sqrt(mW)."""
    pairs = stored_sequence(files, arrays, below, "iq", index, (*shape, 2))
    return np.ascontiguousarray(pairs * np.float32(scale)).view(np.complex64)[..., 0]
