"""A folder of a data set whose files are checked against SHA256SUMS before use."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from mmweaver.core.checksums import SUMS_FILE, damage_of_file, read_sums
from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import Place
from mmweaver.core.safe_files.safe_zarr import ZarrFolder


@dataclass(frozen=True, kw_only=True)
class CheckedFolder:
    """A room, or the root of a data set; without checksums, as before mmweaver 1.0, everything is accepted."""

    folder: Place
    sums: dict[str, str] | None
    made_by: str  # command that regenerates damaged rooms

    @classmethod
    def of(cls, folder: Place, made_by: str) -> "CheckedFolder":
        """Reads the checksums of a folder.

        Args:
            folder: The folder.
            made_by: Command that regenerates it.

        Returns:
            The folder.

        Raises:
            InputError: If the list of checksums is damaged.
        """
        return cls(folder=folder, sums=read_sums(folder), made_by=made_by)

    def check(self, *below: str, but: tuple[str, ...] = ()) -> None:
        """Checks files, each once per process unless it has changed since.

        Args:
            *below: Prefixes of the names to check. Default: all.
            but: Prefixes of the names to skip. Default: none.

        Raises:
            InputError: At the first damaged file.
        """
        for name, expected in (self.sums or {}).items():
            if name.startswith(below or "") and not name.startswith(but or "/"):
                found = damage_of_file(self.folder, name, expected)
                if found is not None:
                    raise self.damaged(str(found))

    def require_sums(self) -> None:
        """Raises InputError if a folder that was written with checksums lacks them."""
        if self.sums is None:
            raise self.damaged(f"{self.folder / SUMS_FILE} is missing")

    def damaged(self, what: str) -> InputError:
        """Error for damage, with the command that repairs it."""
        return InputError(f"{what}; make it anew with: {self.made_by}")

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Context that converts any exception of Zarr over damaged files to an InputError."""
        try:
            yield
        except (InputError, MemoryError):
            raise
        except Exception as error:  # Zarr and its codecs raise about twenty types
            reason = " ".join(str(error).split())[:120] or type(error).__name__
            raise self.damaged(f"{self.folder} is damaged ({reason})") from error


def stored_sequence(
    files: CheckedFolder, arrays: ZarrFolder, below: str, name: str, index: int, shape: tuple[int, ...], **limits: float
) -> np.ndarray:
    """Reads one sequence of an array that `zarr_arrays.put_sequences` wrote; only its shard is checked and read.

    Args:
        files: The folder.
        arrays: Its Zarr group.
        below: Path of the group in the folder, ending in "/".
        name: Name of the array.
        index: Index of the sequence.
        shape: Shape of one sequence.
        **limits: `low` and `high` of its values.

    Returns:
        The sequence, float32.

    Raises:
        InputError: If it is damaged.
    """
    files.check(f"{below}{name}/zarr.json")
    with files.reading():
        files.check(f"{below}{name}/c/{index // arrays.rows_a_file(name)}/")
        return arrays.row(name, index, shape, kinds="f", **limits).astype(np.float32)


def stored_iq(
    files: CheckedFolder, arrays: ZarrFolder, below: str, index: int, shape: tuple[int, ...], scale: float
) -> np.ndarray:
    """Reads the signals of one sequence.

    Args:
        files: The folder.
        arrays: Its Zarr group.
        below: Path of the group in the folder, ending in "/".
        index: Index of the sequence.
        shape: (frame, range, doppler, antenna).
        scale: Amplitude of 1.0 in sqrt(mW).

    Returns:
        Cube, complex64, in sqrt(mW).

    Raises:
        InputError: If it is damaged.
    """
    pairs = stored_sequence(files, arrays, below, "iq", index, (*shape, 2))
    return np.ascontiguousarray(pairs * np.float32(scale)).view(np.complex64)[..., 0]
