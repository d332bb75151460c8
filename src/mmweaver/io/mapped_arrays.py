"""Raw samples in a MATLAB file, HDF5 file or .npy of any project, by a short TOML file that says what is where.

    array = "radar"                        # name of the array; in HDF5 with its groups, such as "adc/samples"
    axes = "frame,loop,antenna,sample"     # as for --layout; "iq" is an axis of length 2, I then Q
    imag = "radar_q"                       # optional: array of Q, if `array` holds I alone
    radar = "profile.cfg"                  # optional: preset or file next to this one; --radar overrides it

MATLAB files of version 7.3 are HDF5 with axes in reverse order; `axes` are those that MATLAB shows. h5py is needed for
HDF5 (extra `hdf5`). Examples for RaDICaL and RADDet: docs/formats.md.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.optional_packages import need
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.regular_files import check_regular, foreign_errors, open_regular
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.io.raw_npy import adc_of_array

KEYS = ("array", "axes", "imag", "radar")
HDF5 = b"\x89HDF\r\n\x1a\n"
HDF5_AT = (0, 512)  # byte offset of its mark; MATLAB puts a text of 512 bytes before it
SUFFIXES = (".mat", ".h5", ".hdf5", ".npy")
MAX_BYTES = 8_000_000_000


@dataclass(frozen=True, kw_only=True)
class ArrayMapping:
    """Content of a mapping file."""

    path: Path
    axes: str
    array: str | None = None
    imag: str | None = None
    radar: str | None = None


def read_mapping(path: Path) -> ArrayMapping:
    """Reads a mapping file.

    Args:
        path: The .toml.

    Returns:
        Its content; a radar's file is relative to it.

    Raises:
        InputError: If it has other keys, values that are no texts, or no axes.
    """
    values = read_toml(path)
    if unknown := sorted(set(values) - set(KEYS)):
        raise InputError(f"{path} has the key {unknown[0]!r}; known are {', '.join(KEYS)}")
    if wrong := [key for key, value in values.items() if not isinstance(value, str)]:
        raise InputError(f"{path}: {wrong[0]} must be a text in quotes")
    if "axes" not in values:
        raise InputError(f'{path} lacks axes; write for example axes = "frame,loop,antenna,sample"')
    radar = values.get("radar")
    if radar is not None and radar.split("#")[0] not in PRESETS:
        values["radar"] = str(path.parent / radar)
    return ArrayMapping(path=path, **values)


def read_mapped(path: Path, mapping: ArrayMapping, config: RadarConfig, frames: slice = slice(None)) -> AdcCube:
    """Reads samples as a mapping says.

    Args:
        path: .mat, .h5, .hdf5 or .npy.
        mapping: Names and axes of its arrays.
        config: The radar.
        frames: Range of frames. Default: all.

    Returns:
        Samples in the unit of the file.

    Raises:
        InputError: If an array is missing, or does not match the axes and the radar.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{path}: a mapping file is for {', '.join(SUFFIXES)}")
    names = [name.strip() for name in mapping.axes.split(",")]
    values = _complex(_array(path, mapping.array))
    if mapping.imag is not None:
        values = values + 1j * np.asarray(_array(path, mapping.imag))
    if "iq" in names:
        axis = names.index("iq")
        if values.ndim != len(names) or values.shape[axis] != 2:
            raise InputError(f"{path}: axis iq of {mapping.axes} has shape {values.shape}; it must have length 2")
        values = np.take(values, 0, axis) + 1j * np.take(values, 1, axis)
        names.remove("iq")
    return adc_of_array(path, values, config, ",".join(names), frames)


def _array(path: Path, name: str | None) -> np.ndarray:
    """The array of that name, in the axis order that the program that wrote it shows."""
    if path.suffix.lower() == ".npy":
        return read_npy(path)
    if name is None:
        raise InputError(f"{path} holds arrays by name; the mapping file needs array")
    with open_regular(path) as file:
        head = file.read(1024)
    if any(head[at : at + 8] == HDF5 for at in HDF5_AT):
        return _hdf5(path, name, is_matlab=path.suffix.lower() == ".mat")
    from scipy import io

    if check_regular(path) > MAX_BYTES:
        raise InputError(f"{path} is larger than {MAX_BYTES / 1e9:g} GB; save the array as .npy")
    with foreign_errors(path, "no MATLAB file that can be read ({reason}); save it with -v7.3 or as .npy"):
        held = io.loadmat(path, variable_names=[name])
        known = [one for one, _, _ in io.whosmat(path)]
    return _checked(path, name, held.get(name), known)


def _hdf5(path: Path, name: str, *, is_matlab: bool) -> np.ndarray:
    need("hdf5", str(path), "h5py")
    import h5py

    with (
        foreign_errors(path, "no HDF5 file that can be read ({reason}); save the array as .npy"),
        h5py.File(path) as file,
    ):
        found: Any = file.get(name)
        if isinstance(found, h5py.Dataset) and found.nbytes > MAX_BYTES:
            raise InputError(f"{path}: {name} is larger than {MAX_BYTES / 1e9:g} GB; save a part of it as .npy")
        values = found[()] if isinstance(found, h5py.Dataset) else None
        known = list(file)
    values = _checked(path, name, values, known)
    return values.T if is_matlab else values


def _checked(path: Path, name: str, values: Any, known: list[str]) -> np.ndarray:
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "iufcV":
        raise InputError(f"{path} holds no array of numbers {name!r}; it has {', '.join(known[:12]) or 'nothing'}")
    return values


def _complex(values: np.ndarray) -> np.ndarray:
    """Complex numbers of records with a real and an imaginary part, as HDF5 writers store them."""
    if values.dtype.names is None:
        return values
    parts = [name for name in values.dtype.names if values[name].dtype.kind in "iuf"]
    if len(parts) != 2:
        raise InputError(f"records with {', '.join(values.dtype.names)} are no complex numbers")
    return values[parts[0]] + 1j * values[parts[1]]
