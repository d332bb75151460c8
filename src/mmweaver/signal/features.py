"""Features of a radar cube for recognition: maps in decibels, range-angle images, micro-Doppler, points.

The same functions serve generated sequences, recordings and data sets. Power is that at the receiver's port, in dBm,
where the cube's scale is known (|cube * scale|^2 in mW), otherwise in dB relative to a value of 1. Equations:
docs/features.md.
"""

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.core.shapes import Array
from mmweaver.signal.cube import remove_static
from mmweaver.signal.doppler_spectrogram import cube_spectrogram
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)

DRAI_SIZE = 32
POINT_COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
LOWEST_DB = -300.0  # of empty cells


def range_doppler_db(cube: RadarCube, *, moving: bool = False) -> Float[Array, "frame range doppler"]:
    """Range-Doppler power, averaged over the antennas.

    Args:
        cube: The cube.
        moving: Whether the mean chirp of each frame is removed.

    Returns:
        Power in dB, float32 (frame, range, doppler).
    """
    return _decibels(range_doppler_power(remove_static(cube) if moving else cube), cube)


def range_azimuth_db(
    cube: RadarCube, *, num_azimuths: int = 91, moving: bool = False
) -> Float[Array, "frame range azimuth"]:
    """Beamformed range-azimuth power, summed over Doppler.

    Args:
        cube: The cube.
        num_azimuths: Number of angles, evenly spaced from -60 to 60 degrees.
        moving: Whether the mean chirp of each frame is removed.

    Returns:
        Power in dB, float32 (frame, range, azimuth).
    """
    source = remove_static(cube) if moving else cube
    return _decibels(range_azimuth_power(source, azimuth_axis_rad(num_azimuths)), cube)


def range_elevation_db(
    cube: RadarCube, *, num_elevations: int = 61, moving: bool = False
) -> Float[Array, "frame range elevation"]:
    """Beamformed range-elevation power, summed over Doppler.

    Args:
        cube: Cube of a radar with elevation.
        num_elevations: Number of angles, evenly spaced from -40 to 40 degrees.
        moving: Whether the mean chirp of each frame is removed.

    Returns:
        Power in dB, float32 (frame, range, elevation).

    Raises:
        InputError: For an array without elevation.
    """
    source = remove_static(cube) if moving else cube
    return _decibels(range_elevation_power(source, elevation_axis_rad(num_elevations)), cube)


def dynamic_range_angle(cube: RadarCube, size: int = DRAI_SIZE) -> Float[Array, "frame range azimuth"]:
    """Dynamic range-angle images (DRAI): beamformed power without the mean chirp, in a square grid.

    Rows are means over equal spans of the range bins, columns azimuths evenly spaced from -60 to 60 degrees.
    Reference: Li et al., Towards Domain-Independent and Real-Time Gesture Recognition Using mmWave Signal (TMC 2023).

    Args:
        cube: The cube.
        size: Number of rows and of columns.

    Returns:
        Linear power, float32 (frame, size, size).
    """
    power = range_azimuth_power(remove_static(cube), azimuth_axis_rad(size))
    edges = np.linspace(0, power.shape[1], size + 1)
    spans = [slice(int(low), max(int(np.ceil(high)), int(low) + 1)) for low, high in pairwise(edges)]
    return np.stack([power[:, span].mean(axis=1) for span in spans], axis=1).astype(np.float32)


def micro_doppler_db(cube: RadarCube, *, window_loops: int | None = None) -> Float[Array, "window doppler"]:
    """Short-time Fourier transform over the chirps, summed over range.

    Windows overlap by half; Doppler bins increase with radial velocity up to the radar's own limit. The mean chirp of
    each frame is removed. Slow time is recovered from the cube by the inverse Doppler FFT.

    Args:
        cube: The cube.
        window_loops: Window length in loops; by default all loops of a frame.

    Returns:
        Power in dB, float32 (window, doppler).

    Raises:
        InputError: For windows of fewer than four loops, or of more than the frame has.
    """
    loops = cube.values.shape[2]
    width = loops if window_loops is None else window_loops
    if not min(4, loops) <= width <= loops:
        raise InputError(f"a window has 4 to {loops} loops of this radar, not {window_loops}")
    power = cube_spectrogram(remove_static(cube), width, max(width // 2, 1)).sum(axis=2)
    return _decibels(power.reshape(-1, width), cube)


def point_table(points: PointCloud, frame: int | None = None) -> Float[Array, "point 5"]:
    """Points as a table of x, y, z in metres, radial velocity in m/s and SNR in dB.

    Args:
        points: The points.
        frame: Frame to select; by default all frames.

    Returns:
        Table, float32 (point, 5).
    """
    own = points if frame is None else points.select(points.frame == frame)
    return np.stack([getattr(own, name) for name in POINT_COLUMNS], axis=-1).astype(np.float32).reshape(-1, 5)


def _decibels(power: Array, cube: RadarCube) -> Array:
    scale = cube.scale if np.isfinite(cube.scale) else 1.0
    lowest = 10 ** (LOWEST_DB / 10)
    return (10 * np.log10(np.maximum(power * scale**2, lowest))).astype(np.float32)
