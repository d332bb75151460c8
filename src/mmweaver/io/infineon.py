"""Recordings of Infineon's Radar SDK and Fusion GUI: a folder RadarIfxAvian_XX with config.json and radar.npy.

radar.npy holds uint16 of a 12-bit converter, (frame, receiver, chirp, sample), real samples. config.json has the chirp
as device_config / fmcw_single_shape; older versions of the SDK call its ends lower_frequency_Hz, upper_frequency_Hz.

Reference: Infineon Radar Development Kit, ifxJsonConfiguration and recording classes; recordings on GitHub.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import PRESETS
from mmweaver.core.errors import InputError, file_named
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.safe_files.safe_arrays import read_npy
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.io.radar_options import RadarOptions
from mmweaver.io.raw_npy import adc_of_array

SETTINGS, SAMPLES, AXES = "config.json", "radar.npy", "frame,rx,loop,sample"
BOARD = PRESETS["bgt60"]  # its antennas, and what a configuration does not state
FULL_SCALE = 4096


def is_infineon(values: Any) -> bool:
    """Whether decoded JSON is a configuration of the Radar SDK."""
    return isinstance(values, dict) and isinstance(values.get("device_config"), dict)


def infineon_folder(path: Path) -> Path | None:
    """The folder with config.json and radar.npy: the path itself, or the only one RadarIfxAvian_XX in it.

    Args:
        path: A folder.

    Returns:
        The folder; None if there is no recording of the SDK in it.

    Raises:
        InputError: If it contains several.
    """
    found = [one for one in (path, *sorted(path.glob("RadarIfxAvian_*"))) if (one / SAMPLES).is_file()]
    found = [one for one in found if (one / SETTINGS).is_file() and is_infineon(read_json(one / SETTINGS))]
    if len(found) > 1:
        raise InputError(f"{path} holds several recordings; give one of {', '.join(one.name for one in found)}")
    return found[0] if found else None


def read_infineon_config(path: Path, options: RadarOptions | None = None) -> RadarConfig:
    """Reads the radar of a config.json.

    Args:
        path: The file.
        options: Antennas of another board. Default: the L of the BGT60TR13C.

    Returns:
        The radar.

    Raises:
        InputError: If a key is missing or malformed, or the radar is impossible.
    """
    with file_named(path):
        try:
            return (options or RadarOptions()).applied(_radar(read_json(path)["device_config"]["fmcw_single_shape"]))
        except KeyError as error:
            raise InputError(
                f"{path} is a config.json of Infineon's Radar SDK, but lacks {error.args[0]}; only fmcw_single_shape"
                " is read"
            ) from None
        except (AttributeError, TypeError, ValueError, OverflowError, ZeroDivisionError) as error:
            raise InputError(f"{path} is no config.json of Infineon's Radar SDK ({error})") from None


def read_infineon(folder: Path, config: RadarConfig | None = None, frames: slice = slice(None)) -> AdcCube:
    """Reads a recording.

    Args:
        folder: Folder with config.json and radar.npy.
        config: The radar. Default: that of config.json.
        frames: Range of frames. Default: all.

    Returns:
        Samples in counts; the scale is unknown (nan).

    Raises:
        InputError: If a file is malformed, or the two do not fit.
    """
    config = read_infineon_config(folder / SETTINGS) if config is None else config
    values = read_npy(folder / SAMPLES, mapped=True)
    if values.dtype.kind == "f" and values.ndim == 4 and values.size and float(np.max(values[:1])) <= 1:
        values = values * FULL_SCALE  # some versions store 0 to 1
    return adc_of_array(folder / SAMPLES, values, config, AXES, frames)


def _radar(chirp: Any) -> RadarConfig:
    start_hz, end_hz = (
        float(chirp[name] if name in chirp else chirp[older])
        for name, older in (
            ("start_frequency_Hz", "lower_frequency_Hz"),
            ("end_frequency_Hz", "upper_frequency_Hz"),
        )
    )
    samples, rate_hz = int(chirp["num_samples_per_chirp"]), float(chirp["sample_rate_Hz"])
    receivers = [int(number) - 1 for number in chirp["rx_antennas"]]
    if len(chirp["tx_antennas"]) != 1:
        raise InputError(f"{len(chirp['tx_antennas'])} transmitters; only boards with one are read")
    if not receivers or not set(receivers) <= set(range(BOARD.num_rx)):
        raise InputError(f"receivers {chirp['rx_antennas']}; a BGT60TR13C has 1 to {BOARD.num_rx}")
    sampled_s = samples / rate_hz
    return replace(
        BOARD,
        name="bgt60",
        start_frequency_hz=start_hz,
        chirp_slope_hz_per_s=(end_hz - start_hz) / sampled_s,
        idle_time_s=float(chirp["chirp_repetition_time_s"]) - sampled_s,
        ramp_end_time_s=sampled_s,
        num_samples=samples,
        sample_rate_hz=rate_hz,
        num_loops=int(chirp["num_chirps_per_frame"]),
        frame_period_s=float(chirp["frame_repetition_time_s"]),
        rx_position_m=tuple(BOARD.rx_position_m[number] for number in receivers),
        first_range_bin=0,
        num_range_bins=samples // 2,
    )
