"""Safe reading of .npy and .npz files: numbers and strings only, never a pickle."""

import zipfile
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError

Array = np.ndarray


def open_npy(path: Path) -> Array:
    """The array of a .npy file as float64. Raises InputError for anything else."""
    try:
        values = np.load(path, allow_pickle=False)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, EOFError, SyntaxError) as error:
        raise InputError(f"{path} is no .npy array of numbers ({_reason(error)})") from None
    if not isinstance(values, np.ndarray) or not np.issubdtype(values.dtype, np.number):
        raise InputError(f"{path} is no .npy array of numbers; save the joints alone with numpy.save")
    if np.iscomplexobj(values):
        raise InputError(f"{path} holds complex numbers; a motion has real ones")
    return values.astype(float)


def open_npz(path: Path, only: tuple[str, ...] | None = None) -> dict[str, Array]:
    """The arrays of a .npz; pickled ones (dtype object) are skipped. Raises InputError for what is no archive."""
    found: dict[str, Array] = {}
    try:
        with np.load(path, allow_pickle=False) as archive:
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise InputError(f"{path} is no .npz archive; is it a .npy?")
            for name in archive.files:
                if only is None or name in only:
                    try:
                        found[name] = archive[name]
                    except ValueError:
                        continue  # pickled, such as a gender stored as an object
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, EOFError, zipfile.BadZipFile, SyntaxError) as error:
        raise InputError(f"{path} is no .npz archive of arrays ({_reason(error)})") from None
    return found


def _reason(error: Exception) -> str:
    """A reason in our words: numpy's own message advises to allow pickles."""
    text = str(error).splitlines()[0]
    return "it holds pickled objects, which could run code and are not opened" if "pickle" in text else text
