"""Raw ADC samples in a .npy file with named axes."""

from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.io.dca1000 import by_transmitter, upright

# Dimensions that an axis combines, slowest first; transmitters in firing order.
DIMENSIONS = {
    "frame": ("frame",),
    "loop": ("loop",),
    "tx": ("tx",),
    "rx": ("rx",),
    "sample": ("sample",),
    "chirp": ("loop", "tx"),
    "antenna": ("tx", "rx"),
    "vrx": ("tx", "rx"),
}
MAX_SAMPLE = 1e12  # in any unit; powers and sums stay finite in float32
ORDER = ("frame", "loop", "tx", "rx", "sample")


def read_adc_npy(path: Path | str, config: RadarConfig, axes: str, *, frames: slice = slice(None)) -> AdcCube:
    """Reads samples from an array with named axes.

    Args:
        path: The file. Real samples must be real numbers; their mean over each chirp is removed, and int16 stored as
            uint16 (values above 32767) is converted back.
        config: The radar.
        axes: Names in order, such as "frame,loop,tx,rx,sample" or "loop,antenna,sample". `tx` is in firing order
            (`config.tx_order`; slots of a coded radar), `antenna` (or `vrx`) = tx * num_rx + rx and
            `chirp` = loop * num_tx + tx with the same tx. Axes that are not named have size 1.
        frames: Range of frames; if "frame" is the first axis, only these are read. Default: all.

    Returns:
        Samples in the unit of the file; the scale is unknown (nan).

    Raises:
        InputError: If the array does not match the axes and the radar.
    """
    return adc_of_array(Path(path), read_npy(path, mapped=frames != slice(None)), config, axes, frames)


def adc_of_array(
    path: Path, values: np.ndarray, config: RadarConfig, axes: str, frames: slice = slice(None)
) -> AdcCube:
    """Converts an array from a file to samples.

    Args:
        path: The file, for error messages.
        values: The array.
        config: The radar.
        axes: Names of the axes, as in `read_adc_npy`.
        frames: Range of frames. Default: all.

    Returns:
        Samples in the unit of the array.

    Raises:
        InputError: If the array does not match the axes and the radar.
    """
    names = [name.strip() for name in axes.split(",")]
    sizes = {"loop": config.num_loops, "tx": config.num_slots, "rx": config.num_rx, "sample": config.num_samples}
    parts = _checked_axes(path, names, values.shape, sizes)
    if not values.size:
        raise InputError(f"{path} is empty: its shape is {values.shape}")
    if "frame" in names:
        axis = names.index("frame")
        values = values[(slice(None),) * axis + (frames,)]
        sizes["frame"] = values.shape[axis]
    else:
        sizes["frame"] = 1
    values = _numbers(path, values, config)
    values = values.reshape([sizes[part] for part in parts])
    missing = [name for name in ORDER if name not in parts]
    values = values.reshape(values.shape + (1,) * len(missing))
    values = values.transpose([(parts + missing).index(name) for name in ORDER])
    if not config.complex_samples:
        values = values - values.mean(axis=-1, keepdims=True)
    samples = upright(by_transmitter(values, config).astype(np.complex64), config)
    return AdcCube(samples=np.ascontiguousarray(samples), config=config, scale=float("nan"))


def _checked_axes(path: Path, names: list[str], shape: tuple[int, ...], sizes: dict[str, int]) -> list[str]:
    if unknown := [name for name in names if name not in DIMENSIONS]:
        raise InputError(f"unknown axis {unknown[0]!r}; known: {', '.join(DIMENSIONS)}")
    parts = [part for name in names for part in DIMENSIONS[name]]
    if len(set(parts)) < len(parts):
        raise InputError(f"the axes {','.join(names)} name the same dimension twice")
    expected = [
        str(int(np.prod([sizes[part] for part in DIMENSIONS[name]]))) if name != "frame" else "any" for name in names
    ]
    wanted = ", ".join(f"{name} {size}" for name, size in zip(names, expected, strict=True))
    if missing := [name for name in ORDER if name not in parts and sizes.get(name, 1) != 1]:
        hint = "; vrx is tx and rx in one" if missing[0] in ("tx", "rx") else ""
        raise InputError(
            f"the axes {','.join(names)} lack {missing[0]}, of which the radar has {sizes[missing[0]]}{hint}"
        )
    fits = len(shape) == len(names) and all(
        size in ("any", str(length)) for size, length in zip(expected, shape, strict=True)
    )
    if not fits:
        raise InputError(f"{path} has shape {shape}; the radar and the named axes need ({wanted})")
    return parts


def _numbers(path: Path, values: np.ndarray, config: RadarConfig) -> np.ndarray:
    if config.complex_samples:
        if values.dtype.kind != "c":
            raise InputError(f"{path} holds {values.dtype}, but radar {config.name!r} has complex samples (I + jQ)")
    elif values.dtype.kind not in "iuf":
        raise InputError(f"{path} holds {values.dtype}, but radar {config.name!r} has real samples")
    if values.dtype == np.uint16 and values.max() > np.iinfo(np.int16).max:
        values = values.astype(np.int16)
    values = values.astype(np.complex128 if config.complex_samples else np.float64)
    return ArrayChecks(path).numbers("the array", values, kinds="fc", low=-MAX_SAMPLE, high=MAX_SAMPLE)
