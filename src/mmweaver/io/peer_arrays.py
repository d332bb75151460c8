"""Arrays in which other projects store radar recordings: HuPR, CubeLearn, mmMesh and RF-Genesis.

HuPR: one .npy per frame, complex (doppler 16, range 64, azimuth 64, elevation 8): the middle 16 of 64 Doppler bins,
range from far to near, no windows, mean over loops removed, zero-padded angle FFTs, both angles reversed. The elevation
FFT was computed only at azimuth channels 2 to 5, where the array has two rows. All of these steps are invertible.
CubeLearn: real (I/Q, frame 20, loop 128, virtual antenna 12, sample 256).
mmMesh: complex (tx, rx, loop, sample) of one frame, or a stack of frames.
RF-Genesis: radar_frames.npy, complex (frame, tx, rx, loop, sample).
"""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Complex

from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.io.raw_npy import MAX_SAMPLE, adc_of_array, read_adc_npy
from mmweaver.io.ti_cfg import MAX_NAME

HUPR_SHAPE = (16, 64, 64, 8)
HUPR_ANTENNAS = (3, 4)
ADC_SHAPE = (3, 4, 128, 256)
CUBELEARN_SHAPE = (128, 12, 256)
POINT_COLUMNS = 6
# azimuth channel of receiver 0 per transmitter; the second transmitter forms the upper row
HUPR_FIRST_CHANNEL = (0, 2, 4)
UPPER_TX, BOTH_ROWS = 1, slice(2, 6)
MAX_RESIDUAL = 1e-3  # share of the energy allowed where the array has no antenna


def detect_layout(path: Path) -> str:
    """Detects the project from the shape of an array.

    Args:
        path: .npy file, or folder of HuPR frames.

    Returns:
        Key of `LAYOUTS`.

    Raises:
        InputError: If the shape matches no project, or several.
    """
    if path.is_dir():
        return "hupr"
    shape = read_npy(path, mapped=True).shape
    if shape == HUPR_SHAPE:
        return "hupr"
    if len(shape) == 5 and shape[0] == 2 and shape[2:] == CUBELEARN_SHAPE:
        return "cubelearn"
    if shape[-4:] == ADC_SHAPE:
        raise InputError(
            f"{path} has shape {shape}, as mmMesh and RF-Genesis have it; give --layout mmmesh or rf_genesis"
        )
    if len(shape) == 2 and shape[1] == POINT_COLUMNS:
        raise InputError(f"{path} has shape {shape}: points of a cloud, not samples; give the recording they came from")
    raise InputError(
        f"{path} has shape {shape}: name its axes, for example --layout frame,loop,tx,rx,sample, or whose"
        f" array it is with --layout {', '.join(LAYOUTS)}"
    )


def read_cubelearn(path: Path, config: RadarConfig) -> AdcCube:
    """Reads an array of CubeLearn: real (I/Q, frame, loop, virtual antenna, sample), antennas in firing order.

    Args:
        path: .npy file.
        config: TDM radar with complex samples.

    Returns:
        Samples in the unit of the file.

    Raises:
        InputError: If the array or the radar does not match.
    """
    values = read_npy(path)
    if values.ndim != 5 or len(values) != 2 or values.dtype.kind not in "fi":
        raise InputError(
            f"{path} has shape {values.shape} of {values.dtype}; CubeLearn's is (2, frame, loop, antenna, sample) of"
            " real numbers, I and Q"
        )
    if config.is_coded or not config.complex_samples:
        raise InputError(f"CubeLearn's radar is a TDM one with complex samples, not {config.name!r}")
    return adc_of_array(path, values[0] + 1j * values[1].astype(np.float64), config, "frame,loop,vrx,sample")


def read_mmmesh(path: Path, config: RadarConfig) -> AdcCube:
    """Reads one or several frames of mmMesh, transmitters in firing order.

    Args:
        path: .npy file.
        config: The radar.

    Returns:
        Samples in the unit of the file.

    Raises:
        InputError: If the array does not match.
    """
    frames = "frame," if read_npy(path, mapped=True).ndim == len(ADC_SHAPE) + 1 else ""
    return read_adc_npy(path, config, f"{frames}tx,rx,loop,sample")


def read_rf_genesis(path: Path, config: RadarConfig) -> AdcCube:
    """Reads samples of RF-Genesis, whose chirps are spread over the entire frame with simultaneous transmitters.

    Args:
        path: .npy file.
        config: The radar.

    Returns:
        Samples; the idle time of their radar is that implied by RF-Genesis, and they need no TDM compensation.

    Raises:
        InputError: If the array does not match.
    """
    adc = read_adc_npy(path, config, "frame,tx,rx,loop,sample")
    chirp_s = config.frame_period_s / (config.num_loops * config.num_tx)
    return replace(adc, config=replace(config, idle_time_s=chirp_s - config.ramp_end_time_s))


def read_hupr(path: Path, config: RadarConfig) -> RadarCube:
    """Reads one frame of HuPR, or a folder of frames in the order of their names.

    Args:
        path: .npy file or folder.
        config: The radar, with 64 range bins, 3 transmitters and 4 receivers.

    Returns:
        Cube in ADC counts (or HuPR's unit) without TDM compensation; Doppler bins that HuPR omits are zero.

    Raises:
        InputError: If an array is not HuPR's, or the radar does not match.
    """
    paths = sorted(path.glob("*.npy")) if path.is_dir() else [path]
    if not paths:
        raise InputError(f"{path} holds no .npy files; give HuPR's folder hori or vert, or one frame of it")
    kept, num_range = HUPR_SHAPE[:2]
    if (config.num_range_bins, config.num_tx, config.num_rx) != (num_range, *HUPR_ANTENNAS) or config.num_loops < kept:
        raise InputError(
            f"radar {config.name!r} cannot have made HuPR's arrays, which have {num_range} range bins, 3 TX and 4 RX;"
            " omit --radar, or give one that has them"
        )
    values = np.zeros((len(paths), num_range, config.num_loops, config.num_antennas), np.complex64)
    first = config.num_loops // 2 - kept // 2
    # normalised so that a tone of amplitude a peaks at a, as in our own cubes
    weight = 1 / (config.num_samples * config.num_loops)
    for frame, name in enumerate(paths):
        values[frame, :, first : first + kept] = weight * _hupr_antennas(name)
    return RadarCube(values=values, grid=CubeGrid.of(config, len(paths)), config=config, scale=float("nan"))


def _hupr_antennas(path: Path) -> Complex[np.ndarray, "range doppler antenna"]:
    """Inverts the angle FFTs of one frame."""
    array = read_npy(path, mapped=True)
    if array.shape != HUPR_SHAPE or array.dtype.kind != "c":
        raise InputError(f"{path} holds {array.dtype} of shape {array.shape}; HuPR's are complex {HUPR_SHAPE}")
    values = np.asarray(array, np.complex128)[:, ::-1, ::-1, ::-1]
    ArrayChecks(path).numbers("the array", values, kinds="c", low=-MAX_SAMPLE, high=MAX_SAMPLE)
    values = np.fft.ifftshift(values, axes=(2, 3))
    channels = np.fft.ifft(values, axis=2)  # doppler, range, channel, elevation
    channels[:, :, BOTH_ROWS] = np.fft.ifft(channels[:, :, BOTH_ROWS], axis=3)
    out = np.empty((*channels.shape[:2], *HUPR_ANTENNAS), complex)
    for tx, channel in enumerate(HUPR_FIRST_CHANNEL):
        own = slice(channel, channel + HUPR_ANTENNAS[1])
        out[:, :, tx] = channels[:, :, own, int(tx == UPPER_TX)]
    energy = np.sum(np.abs(channels) ** 2)
    if energy - np.sum(np.abs(out) ** 2) > MAX_RESIDUAL * energy:
        raise InputError(f"{path} has HuPR's shape, but its angle spectra are not those of HuPR's array")
    return out.reshape(*channels.shape[:2], -1).transpose(1, 0, 2)


def is_rf_genesis(values: Any) -> bool:
    """Whether decoded JSON is a configuration of RF-Genesis, such as its TI1843_config.json."""
    return isinstance(values, dict) and {"num_tx", "fc", "slope", "adc_samples", "tx_loc", "rx_loc"} <= set(values)


def read_rf_genesis_config(path: Path, values: dict[str, Any]) -> RadarConfig:
    """Converts a configuration of RF-Genesis: MHz/us, microseconds, ksps, positions (x, z, y) in half wavelengths.

    Args:
        path: The file, after which the radar is named.
        values: Its content.

    Returns:
        The radar; transmitters fire in the order of the file.

    Raises:
        InputError: If a value is missing or malformed, or the radar is impossible.
    """
    try:
        start_hz, slope = float(values["fc"]), float(values["slope"]) * 1e12
        samples, rate_hz = int(values["adc_samples"]), float(values["sample_rate"]) * 1e3
        adc_start_s = float(values["adc_start_time"]) * 1e-6
        middle_hz = start_hz + slope * (adc_start_s + samples / rate_hz / 2)
        half_m = SPEED_OF_LIGHT_MPS / middle_hz / 2
        tx, rx = (
            tuple((float(x) * half_m, float(y) * half_m, float(z) * half_m) for x, z, y in values[name])
            for name in ("tx_loc", "rx_loc")
        )
        return RadarConfig(
            name=path.stem[:MAX_NAME],
            start_frequency_hz=start_hz,
            chirp_slope_hz_per_s=slope,
            idle_time_s=float(values["idle_time"]) * 1e-6,
            adc_start_time_s=adc_start_s,
            ramp_end_time_s=float(values["ramp_end_time"]) * 1e-6,
            num_samples=samples,
            sample_rate_hz=rate_hz,
            num_loops=int(values["chirp_per_frame"]),
            frame_period_s=1 / float(values["frame_per_second"]),
            tx_position_m=tx,
            rx_position_m=rx,
            tx_order=tuple(range(len(tx))),
            first_range_bin=0,
            num_range_bins=samples,
        )
    except InputError:
        raise
    except (KeyError, TypeError, ValueError, ZeroDivisionError, OverflowError) as error:
        raise InputError(f"{path} is no configuration of RF-Genesis ({error})") from None


# reader per project, (path, radar) -> samples or cube
LAYOUTS: dict[str, Callable[[Path, RadarConfig], AdcCube | RadarCube]] = {
    "hupr": read_hupr,
    "mmmesh": read_mmmesh,
    "rf_genesis": read_rf_genesis,
    "cubelearn": read_cubelearn,
}
