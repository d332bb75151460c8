"""Power maps of a cube: range-Doppler, range-azimuth and range-elevation."""

import math

import numpy as np
from jaxtyping import Bool, Complex, Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import PerAngle, PerIndex, RangeAngleMap, RangeDopplerMap
from mmweaver.core.virtual_array import azimuth_row, elevation_columns, has_elevation

__all__ = [
    "azimuth_axis_rad",
    "elevation_axis_rad",
    "has_elevation",
    "moving_doppler",
    "noise_power",
    "range_azimuth_power",
    "range_doppler_power",
    "range_elevation_power",
]


def range_doppler_power(cube: RadarCube) -> RangeDopplerMap:
    """Range-Doppler power, averaged over the antennas.

    Args:
        cube: The cube.

    Returns:
        |value|^2, float64 (frame, range, doppler), in squared units of the cube.
    """
    values = cube.values
    real, imaginary = np.real(values), np.imag(values)
    power = np.einsum("frda,frda->frd", real, real, dtype=np.float64)
    power += np.einsum("frda,frda->frd", imaginary, imaginary, dtype=np.float64)
    return power / values.shape[-1]


def azimuth_axis_rad(num: int = 91, limit_deg: float = 60.0) -> PerAngle:
    """Azimuth angles in rad, positive to the right.

    Args:
        num: Number of angles.
        limit_deg: Largest angle in degrees; the axis is symmetric.
    """
    return np.linspace(-math.radians(limit_deg), math.radians(limit_deg), num)


def elevation_axis_rad(num: int = 61, limit_deg: float = 40.0) -> PerAngle:
    """Elevation angles in rad, positive upwards.

    Args:
        num: Number of angles.
        limit_deg: Largest angle in degrees; the axis is symmetric.
    """
    return np.linspace(-math.radians(limit_deg), math.radians(limit_deg), num)


def moving_doppler(cube: RadarCube) -> Bool[np.ndarray, " doppler"]:
    """Mask (doppler,) of the Doppler bins without Hann-windowed static clutter: all but zero and its two neighbours.

    With fewer than five loops, only bin zero is excluded.
    """
    num = cube.values.shape[2]
    return np.abs(np.arange(num) - num // 2) > (1 if num >= 5 else 0)


def noise_power(cube: RadarCube) -> float | None:
    """Noise power per cell: the median outside the Doppler bins of static clutter; None for a radar with one loop."""
    moving = moving_doppler(cube)
    return float(np.median(range_doppler_power(cube)[:, :, moving])) if moving.any() else None


def range_azimuth_power(cube: RadarCube, azimuth_rad: PerAngle, *, moving_only: bool = False) -> RangeAngleMap:
    """Beamforming on the array's horizontal row, with power summed over Doppler.

    Args:
        cube: The cube.
        azimuth_rad: Angles (azimuth,), positive to the right.
        moving_only: Whether the Doppler bins of static clutter are omitted.

    Returns:
        Power (frame, range, azimuth): a single scatterer of amplitude a at every antenna gives a^2 (summed over
        its Doppler cells) at its angle.
    """
    row = azimuth_row(cube.grid.antenna_position_m, cube.grid.wavelength_m)
    direction = np.stack([np.sin(azimuth_rad), np.cos(azimuth_rad), np.zeros_like(azimuth_rad)])
    return _beam_power(cube, [row], direction, moving_only)


def range_elevation_power(cube: RadarCube, elevation_rad: PerAngle, *, moving_only: bool = False) -> RangeAngleMap:
    """Beamforming within columns, with power summed over Doppler and averaged over columns.

    Each of the tallest columns is beamformed separately, so the target's azimuth does not matter; columns of two
    antennas give a wide beam.

    Args:
        cube: Cube of a radar with elevation.
        elevation_rad: Angles (elevation,), positive upwards.
        moving_only: Whether the Doppler bins of static clutter are omitted.

    Returns:
        Power (frame, range, elevation).

    Raises:
        InputError: For an array without elevation (see `has_elevation`).
    """
    columns = elevation_columns(cube.grid.antenna_position_m, cube.grid.wavelength_m)
    if not columns:
        raise InputError(
            f"the array of radar {cube.config.name!r} has no column of two antennas, so it has no elevation;"
            " use a radar with an elevated transmitter, such as awr1843"
        )
    direction = np.stack([np.zeros_like(elevation_rad), np.cos(elevation_rad), np.sin(elevation_rad)])
    return _beam_power(cube, columns, direction, moving_only)


def steering(
    cube: RadarCube, antennas: PerIndex, direction: Float[np.ndarray, "3 angle"]
) -> Complex[np.ndarray, "_ angle"]:
    """Steering phasors exp(+j 2 pi / wavelength u.p), which align the signal of a far target.

    Args:
        cube: The cube, for its antenna positions.
        antennas: Indices of the antennas.
        direction: Unit vectors u (3, angle).

    Returns:
        Phasors (antenna, angle), complex.
    """
    path_m = cube.grid.antenna_position_m[antennas] @ direction
    return np.exp(2j * np.pi / cube.grid.wavelength_m * path_m)


def _beam_power(cube: RadarCube, groups: list[PerIndex], direction: np.ndarray, moving_only: bool) -> RangeAngleMap:
    """Power beamformed coherently within each group and averaged over groups.

    Uses the covariance summed over Doppler, so the cost per angle is small.
    """
    bins = moving_doppler(cube) if moving_only else slice(None)
    power = np.zeros((*cube.values.shape[:2], direction.shape[1]))
    for antennas in groups:
        signal = cube.values[:, :, bins][..., antennas].astype(np.complex128)
        covariance = signal.swapaxes(-1, -2) @ signal.conj()
        weight = steering(cube, antennas, direction) / len(antennas)
        # sum over a, b of w_a R_ab conj(w_b)
        outer = (weight[:, None, :] * weight.conj()[None, :, :]).reshape(len(antennas) ** 2, -1)
        flat = covariance.reshape(*covariance.shape[:2], -1)
        power += flat.real @ outer.real - flat.imag @ outer.imag
    return np.maximum(power / len(groups), 0)
