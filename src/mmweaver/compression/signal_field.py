"""The interface of all fields, a radar sequence as a function of continuous coordinates, and the grids they sample.

Reference: paper, "Sampling" and "Data Augmentation".
"""

from abc import ABC, abstractmethod
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Complex, Float

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import AntennaPositions, CubeValues

Axis = Float[np.ndarray, "_"]
Axes = tuple[Axis, Axis, Axis, Axis]
Coordinates = Float[np.ndarray, "point 4"]
Places = Float[np.ndarray, "place 3"]

OFF_THE_LINE = 1e-3  # of a wavelength
CHUNK_POINTS = 1 << 18  # points of a grid that are sampled together


class SignalField(ABC):
    """One radar sequence, f(frame, range, doppler, antenna) -> I + jQ, in the phase and scale of a RadarCube.

    Coordinates are in cells of the native grid (`grid`), fractions included: (frame, range bin, Doppler bin, antenna),
    the first cell of each axis at 0. `grid`, `config` and `scale` are those of the represented cube. Between bins, a
    field approximates the same radar's Fourier transforms there, windows and TDM compensation included; phase-centring
    is internal to a field.
    """

    config: RadarConfig
    grid: CubeGrid
    scale: float

    @property
    @abstractmethod
    def num_values(self) -> int:
        """Number of real parameters stored for this sequence (a complex number counts twice)."""

    @abstractmethod
    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        """Values at any coordinates.

        Args:
            coordinates: (point, 4) in cells of `grid`.

        Returns:
            (point,), complex64.
        """

    def values_on(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid; fields with a faster way than point by point override this.

        Args:
            grid: of the same radar.

        Returns:
            (frame, range, doppler, antenna), complex64.

        Raises:
            InputError: where an antenna of the grid lies off the line through the field's antennas.
        """
        axes = coordinates_on(self.grid, grid)
        values = np.empty(grid.shape, np.complex64)
        flat = values.reshape(-1)
        for first in range(0, flat.size, CHUNK_POINTS):
            index = np.unravel_index(np.arange(first, min(first + CHUNK_POINTS, flat.size)), grid.shape)
            points = np.stack([axis[at] for axis, at in zip(axes, index, strict=True)], axis=1)
            flat[first : first + CHUNK_POINTS] = self.sample(points)
        return values

    def cube(self, grid: CubeGrid | None = None) -> RadarCube:
        """The field as a RadarCube, on its native grid or on another."""
        grid = self.grid if grid is None else grid
        return RadarCube(values=self.values_on(grid), grid=grid, config=self.config, scale=self.scale)

    def on_grid(self, n_r: float | int = 1, n_d: float | int = 1, n_a: float | int = 1) -> RadarCube:
        """The field sampled n_r, n_d, n_a times finer: super-resolution, of N_new = n_r n_d n_a N_orig samples.

        Args:
            n_r: Along range.
            n_d: Along Doppler.
            n_a: Along antennas.

        Returns:
            The cube on `finer_grid`.

        Raises:
            InputError: for a factor below 1.
        """
        return self.cube(finer_grid(self.grid, n_r=n_r, n_d=n_d, n_a=n_a))

    def jitter(self, radius: float, seed: int = 0) -> RadarCube:
        """The field sampled at random within a radius of its cells: the paper's augmentation, see `sampled_grid`.

        Args:
            radius: In cells, below 1; the paper's r / 8.
            seed: Of the coordinates.

        Returns:
            A cube of the native shape.

        Raises:
            InputError: for another radius.
        """
        return self.cube(sampled_grid(self.grid, radius, seed))

    def save(self, path: Path | str) -> None:
        """Writes the field as safetensors; `mmweaver.inr.load` reads it back, bit for bit.

        Args:
            path: the file.

        Raises:
            InputError: if it cannot be written, or the field is a file already.
        """
        raise InputError(f"a {type(self).__name__} is a file already; copy it")


def finer_grid(grid: CubeGrid, *, n_r: float | int = 1, n_d: float | int = 1, n_a: float | int = 1) -> CubeGrid:
    """The grid over the same extent, in steps n times smaller.

    Range and Doppler: n cells for each original one, as a radar of n times the bandwidth or loops has (so the last
    ones lie beyond the last original centre, by less than one original cell). Antennas: positions on the line from each
    antenna to the next, ends included. For integer n, every n-th cell is an original one. Raises InputError for a
    factor below 1.
    """
    for name, factor in (("n_r", n_r), ("n_d", n_d), ("n_a", n_a)):
        if not (np.isfinite(factor) and factor >= 1):
            raise InputError(f"{name} must be a number of at least 1, not {factor}")
    native_m = grid.antenna_position_m
    return replace(
        grid,
        range_m=_refined(grid.range_m, n_r),
        radial_velocity_mps=_refined(grid.radial_velocity_mps, n_d),
        antenna_position_m=antenna_at(native_m, np.arange(int((len(native_m) - 1) * n_a + 1e-9) + 1) / n_a),
    )


def sampled_grid(grid: CubeGrid, radius: float, seed: int) -> CubeGrid:
    """Range, Doppler and antenna coordinates sampled uniformly from [j, j + radius], one for each index j.

    The last index of each axis is unchanged. Raises InputError for a radius that is negative or not below 1.
    Reference: paper, "Data Augmentation" (sampling radius, in eighths).
    """
    if not 0 <= radius < 1:
        raise InputError(f"the sampling radius is 0 or more and below 1 (cells), not {radius:g}")

    def sampled(axis: str, num: int) -> Axis:
        offset = stream(seed, "sampling radius", axis).random(num) * radius
        offset[-1] = 0.0
        return np.arange(num) + offset

    def along(values: Axis, axis: str) -> Axis:
        at = sampled(axis, len(values))
        return np.interp(at, np.arange(len(values)), values)

    place = antenna_at(grid.antenna_position_m, sampled("antenna", len(grid.antenna_position_m)))
    return replace(
        grid,
        range_m=along(grid.range_m, "range"),
        radial_velocity_mps=along(grid.radial_velocity_mps, "doppler"),
        antenna_position_m=place,
    )


def coordinates_on(native: CubeGrid, grid: CubeGrid) -> Axes:
    """The axes of `grid` in cells of `native`, the first cell at 0: (frame, range, doppler, antenna).

    Coordinates along an axis of a single native cell are 0. Raises InputError where an antenna lies off
    the line through the native antennas.
    """
    return (
        _cell_coordinates(native.frame_time_s, grid.frame_time_s),
        _cell_coordinates(native.range_m, grid.range_m),
        _cell_coordinates(native.radial_velocity_mps, grid.radial_velocity_mps),
        antenna_coordinate(native.antenna_position_m, grid.antenna_position_m, native.wavelength_m),
    )


def cells_at(native: CubeGrid, coordinates: Coordinates) -> CubeGrid:
    """The cells at coordinates (point, 4): a grid whose axes have one entry for each point, to be read side by side."""

    def along(values: Axis, cell: Axis) -> Axis:
        return values[0] + cell * (values[1] - values[0] if len(values) > 1 else 0.0)

    return replace(
        native,
        range_m=along(native.range_m, coordinates[:, 1]),
        radial_velocity_mps=along(native.radial_velocity_mps, coordinates[:, 2]),
        antenna_position_m=antenna_at(native.antenna_position_m, coordinates[:, 3]),
    )


def antenna_at(position_m: AntennaPositions, antenna: Axis) -> Places:
    """Positions (place, 3) in metres at fractional antenna indices, interpolated linearly between antennas."""
    index = np.arange(len(position_m))
    return np.stack([np.interp(antenna, index, position_m[:, axis]) for axis in range(3)], axis=1)


def antenna_coordinate(native_m: AntennaPositions, wanted_m: Places, wavelength_m: float) -> Axis:
    """The fractional antenna index of each position, the inverse of `antenna_at`.

    A position that coincides with an antenna gets its integer index. Raises InputError for a position off the line
    through the antennas.
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
        is_between = distance.min(axis=1) > limit_m
        number = np.where(is_between, segment + share[every, segment], number)
        gap_m = np.minimum(off_m.min(axis=1), distance.min(axis=1))
    else:
        gap_m = distance.min(axis=1)
    if (gap_m > limit_m).any():
        worst = int(gap_m.argmax())
        raise InputError(
            f"antenna {worst} of the grid lies {gap_m[worst] * 1e3:.2f} mm off the line through the field's antennas;"
            " sample at positions between neighbouring antennas, or use a scatterer field"
        )
    return number


def _refined(values: Axis, factor: float | int) -> Axis:
    num = int(len(values) * factor + 1e-9)
    step = values[1] - values[0] if len(values) > 1 else 0.0
    return values[0] + np.arange(num) * (step / factor)


def _cell_coordinates(native: Axis, wanted: Axis) -> Axis:
    if len(native) < 2:
        return np.zeros(len(wanted))
    return (wanted - native[0]) / (native[1] - native[0])
