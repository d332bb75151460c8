"""Where to sample a field: finer grids, drawn grids, and a grid's places as coordinates.

Reference: paper, "Sampling" and "Data Augmentation".
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import AntennaPositions

Axis = Float[np.ndarray, "_"]
Axes = tuple[Axis, Axis, Axis, Axis]
Coordinates = Float[np.ndarray, "point 4"]
Places = Float[np.ndarray, "place 3"]

RADIUS_PARTS = 8  # the paper divides the step between two indices into eighths
OFF_THE_LINE = 1e-3  # of a wavelength


def finer_grid(grid: CubeGrid, *, n_r: float = 1.0, n_d: float = 1.0, n_a: float = 1.0) -> CubeGrid:
    """The same extent in steps n times smaller.

    Range and Doppler: n cells for each old one, as a radar of n times the bandwidth or loops has (so the last ones
    lie beyond the last old centre, by less than one old cell). Antennas: places on the line from each antenna to the
    next, the ends kept. With whole n every n-th cell is an old one. Raises InputError for a factor below 1.
    """
    for name, factor in (("n_r", n_r), ("n_d", n_d), ("n_a", n_a)):
        if not (np.isfinite(factor) and factor >= 1):
            raise InputError(f"{name} must be a number of at least 1, not {factor}")
    old = grid.antenna_position_m
    return replace(
        grid,
        range_m=_refined(grid.range_m, n_r),
        radial_velocity_mps=_refined(grid.radial_velocity_mps, n_d),
        antenna_position_m=antenna_at(old, np.arange(int((len(old) - 1) * n_a + 1e-9) + 1) / n_a),
    )


def sampled_grid(grid: CubeGrid, radius: int, seed: int) -> CubeGrid:
    """Range, Doppler and antenna coordinates drawn evenly from [j, j + radius / 8], one draw for each index j.

    The last index of each axis stays. Raises InputError for a radius outside 0 to 7.
    Reference: paper, "Data Augmentation" (sampling radius).
    """
    if not 0 <= radius < RADIUS_PARTS:
        raise InputError(f"the sampling radius goes from 0 to {RADIUS_PARTS - 1}, not {radius}")

    def drawn(axis: str, num: int) -> Axis:
        offset = stream(seed, "sampling radius", axis).random(num) * radius / RADIUS_PARTS
        offset[-1] = 0.0
        return np.arange(num) + offset

    def along(values: Axis, axis: str) -> Axis:
        at = drawn(axis, len(values))
        return np.interp(at, np.arange(len(values)), values)

    place = antenna_at(grid.antenna_position_m, drawn("antenna", len(grid.antenna_position_m)))
    return replace(
        grid,
        range_m=along(grid.range_m, "range"),
        radial_velocity_mps=along(grid.radial_velocity_mps, "doppler"),
        antenna_position_m=place,
    )


def coordinates_on(native: CubeGrid, grid: CubeGrid) -> Axes:
    """Each axis of `grid` in cells of `native`, the first cell at 0: (frame, range, doppler, antenna).

    An axis of a single cell counts from that cell, whatever is asked. Raises InputError where an antenna lies off
    the line through the native antennas.
    """
    return (
        _in_cells(native.frame_time_s, grid.frame_time_s),
        _in_cells(native.range_m, grid.range_m),
        _in_cells(native.radial_velocity_mps, grid.radial_velocity_mps),
        antenna_coordinate(native.antenna_position_m, grid.antenna_position_m, native.wavelength_m),
    )


def antenna_at(position_m: AntennaPositions, antenna: Axis) -> Places:
    """Places at fractional antenna numbers: straight lines from each antenna to the next."""
    index = np.arange(len(position_m))
    return np.stack([np.interp(antenna, index, position_m[:, axis]) for axis in range(3)], axis=1)


def antenna_coordinate(native_m: AntennaPositions, wanted_m: Places, wavelength_m: float) -> Axis:
    """The fractional antenna number of each wanted place, the inverse of `antenna_at`.

    A place that is an antenna gets that antenna's whole number. Raises InputError for a place off the line.
    """
    limit_m = OFF_THE_LINE * wavelength_m
    distance = np.linalg.norm(wanted_m[:, None] - native_m[None], axis=-1)
    number = distance.argmin(axis=1).astype(np.float64)
    if len(native_m) > 1:
        start, step = native_m[:-1], np.diff(native_m, axis=0)
        length_squared = np.maximum(np.sum(step**2, axis=1), 1e-300)
        share = np.clip(np.sum((wanted_m[:, None] - start) * step, axis=-1) / length_squared, 0.0, 1.0)
        off_m = np.linalg.norm(start + share[..., None] * step - wanted_m[:, None], axis=-1)
        segment = off_m.argmin(axis=1)
        every = np.arange(len(wanted_m))
        between = distance.min(axis=1) > limit_m
        number = np.where(between, segment + share[every, segment], number)
        gap_m = np.minimum(off_m.min(axis=1), distance.min(axis=1))
    else:
        gap_m = distance.min(axis=1)
    if (gap_m > limit_m).any():
        worst = int(gap_m.argmax())
        raise InputError(
            f"antenna {worst} of the grid lies {gap_m[worst] * 1e3:.2f} mm off the line through the field's antennas;"
            " sample on places between neighbouring antennas, or take a field that knows directions"
        )
    return number


def _refined(values: Axis, factor: float) -> Axis:
    num = int(len(values) * factor + 1e-9)
    step = values[1] - values[0] if len(values) > 1 else 0.0
    return values[0] + np.arange(num) * (step / factor)


def _in_cells(native: Axis, wanted: Axis) -> Axis:
    if len(native) < 2:
        return np.zeros(len(wanted))
    return (wanted - native[0]) / (native[1] - native[0])
