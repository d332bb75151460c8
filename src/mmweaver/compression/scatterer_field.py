"""ScattererField: a radar sequence as point scatterers over a static layer. Read this file first.

Scatterers can be rendered anywhere: between bins, between antennas, at other instants (each is propagated with its own
velocity and phase until the next frame's take over), and for another radar (`for_radar`).
"""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from jaxtyping import Complex
from torch import Tensor

from mmweaver.compression.field_file import FieldFile
from mmweaver.compression.scatterers.fit_window import FitWindow, long_window, overlap_hop
from mmweaver.compression.scatterers.fitting import FitRecipe, Progress, fitted
from mmweaver.compression.scatterers.layers import Layers, cell_noise, no_points, overlapping_noise, rendered
from mmweaver.compression.signal_field import Coordinates, SignalField, cells_at, coordinates_on
from mmweaver.core.constants import SPEED_OF_LIGHT_MPS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import CubeValues
from mmweaver.signal.point_response import PointResponse, Points
from mmweaver.signal.windows import doppler_window, doppler_window_middle

POINTS_A_FRAME = 83  # of six values: about the 10,018 values of the paper's INR in 20 frames
SAMPLES_AT_ONCE = 1 << 14
POINT_TENSORS = ("range_bin", "doppler_bin", "direction")  # stored as they are
STATIC_POINTS = 200  # scatterers that replace the static layer for another radar


class ScattererField(SignalField):
    """Points and static layer (`layers`), their working frames (`fit_window`), and the amplitude of 1.0 (`peak`)."""

    def __init__(self, layers: Layers, fit_window: FitWindow, grid: CubeGrid, scale: float, peak: float):
        self.layers, self.fit_window = layers, fit_window
        self.config, self.grid, self.scale, self.peak = fit_window.config, grid, scale, peak

    @classmethod
    def fit(
        cls, cube: RadarCube, recipe: FitRecipe | None = None, progress: Progress | None = None
    ) -> "ScattererField":
        """Fits scatterers to a cube.

        Args:
            cube: the sequence.
            recipe: budget and effort; by default 83 points per frame and a static layer.
            progress: called with stage, number of stages and error in dB.

        Raises:
            InputError: where the cube is all zeros or not finite.
        """
        values = cube.values
        if not np.isfinite(values).all():
            raise InputError("the cube holds values that are not finite; repair the recording")
        peak = float(np.abs(values).max(initial=0.0))
        if peak == 0.0:
            raise InputError("the cube is all zeros: there is nothing to fit")
        fit_window = FitWindow.of(cube.config, len(values), overlap_hop(cube))
        working = fit_window.working(values / np.float32(peak))
        recipe = recipe or FitRecipe(num_points=POINTS_A_FRAME * len(values), with_static=len(values) > 1)
        return cls(fitted(working, fit_window, recipe, progress), fit_window, cube.grid, cube.scale, peak)

    @classmethod
    def of(cls, file: FieldFile) -> "ScattererField":
        """The field of a file."""
        held, about = file.tensors, file.about
        points = Points(
            **{name: held[name] for name in POINT_TENSORS}, amplitude=torch.view_as_complex(held["amplitude"])
        )
        layers = Layers(
            points=points, static=torch.view_as_complex(held["static"]),
            calibration=torch.view_as_complex(held["calibration"]), noise_power=about["noise_power"],
            active_beams=held["active_beams"].bool().numpy() if "active_beams" in held else None,
        )  # fmt: skip
        fit_window = FitWindow.of(file.config, file.grid.shape[0], about["hop"])
        return cls(layers, fit_window, file.grid, file.scale, about["peak"])

    def save(self, path: Path | str) -> None:
        """Writes the field as safetensors; see `SignalField.save`."""
        layers = self.layers
        tensors = {name: getattr(layers.points, name) for name in POINT_TENSORS}
        parts = {"amplitude": layers.points.amplitude, "static": layers.static, "calibration": layers.calibration}
        tensors |= {name: torch.view_as_real(part.resolve_conj()) for name, part in parts.items()}
        if layers.active_beams is not None:
            tensors["active_beams"] = torch.from_numpy(layers.active_beams.astype(np.uint8))
        FieldFile(
            kind=type(self).__name__, tensors=tensors, config=self.config, grid=self.grid, scale=self.scale,
            about={"noise_power": layers.noise_power, "hop": self.fit_window.hop, "peak": self.peak},
        ).write(path)  # fmt: skip

    @property
    def num_values(self) -> int:
        return self.layers.num_values(self.fit_window.response)

    def native(self, threads: int = 1) -> CubeValues:
        """Values on the native grid, complex64 (frame, range, doppler, antenna); frames are divided among `threads`."""
        fit_window = self.fit_window
        phasor = fit_window.phasor * self.peak
        if fit_window.hop:
            with torch.inference_mode():
                working = rendered(self.layers, fit_window.response, fit_window.axes)
            return fit_window.cube_values(working * self.peak)
        out = np.empty((fit_window.num_frames, *phasor.shape), np.complex64)
        parts = np.array_split(np.arange(fit_window.num_frames), min(fit_window.num_frames, max(4, threads)))

        def fill(part: np.ndarray) -> None:
            with torch.inference_mode():
                some = replace(self.layers, points=self.layers.points[int(part[0]) : int(part[-1]) + 1])
                cells = rendered(some, fit_window.response, fit_window.axes)
                torch.mul(cells, phasor, out=torch.from_numpy(out[part[0] : part[-1] + 1]))

        if threads == 1:
            for part in parts:
                fill(part)
            return out
        before = torch.get_num_threads()
        torch.set_num_threads(1)
        try:
            with ThreadPoolExecutor(threads) as pool:
                list(pool.map(fill, parts))
        finally:
            torch.set_num_threads(before)
        return out

    def values_on(self, grid: CubeGrid) -> CubeValues:
        """Values at the cells of any grid of this radar; see `SignalField.values_on`."""
        if grid is self.grid:
            return self.native()
        frame, range_cell, _, antenna = coordinates_on(self.grid, grid)
        response = PointResponse(self.config)
        axes = response.axes(grid)
        gains = interpolate(self.layers.calibration, antenna)
        static = interpolate(interpolate(self.layers.static, range_cell, is_signal=True).T, antenna).T
        with torch.inference_mode():
            points = self._at(np.clip(frame, -0.5, len(self.grid.frame_time_s) - 0.5), response)
            cells = torch.cat([response.render(part, axes) for part in _each(points)])
            cells += static[:, None] * response.doppler_kernel(axes.doppler_bin)[0][:, None]
            return (cells * gains * response.phasor(axes) * self.peak).numpy()

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        """Values at any coordinates; see `SignalField.sample`."""
        out = np.empty(len(coordinates), np.complex64)
        for frame in np.unique(coordinates[:, 0]):
            at = np.flatnonzero(coordinates[:, 0] == frame)
            for first in range(0, len(at), SAMPLES_AT_ONCE):
                part = at[first : first + SAMPLES_AT_ONCE]
                out[part] = self._cells(coordinates[part], frame)
        return out

    def with_noise(self, cube: RadarCube, seed: int) -> RadarCube:
        """A rendered cube plus receiver noise of the fitted power: white before windowing, so neighbours correlate.

        Overlapping frames share the noise of their chirps. Raises InputError where the cube is not on the
        native grid.
        """
        config, shape = self.config, cube.values.shape
        if shape != self.grid.shape:
            raise InputError(
                f"noise is known on the native cells, {self.grid.shape}, not on {shape}; render with cube()"
            )
        rng, hop = stream(seed, "scatterer field noise"), self.fit_window.hop
        noise = overlapping_noise(rng, config, shape[0], hop) if hop else cell_noise(rng, config, shape[0])
        noise *= np.float32(self.peak * math.sqrt(self._cell_noise()))
        noise += cube.values
        return replace(cube, values=noise)

    def for_radar(self, config: RadarConfig, num_frames: int | None = None, *, first_frame_s: float = 0.0) -> RadarCube:
        """The cube of another radar (bandwidth, chirps, array) at the same place, without fitting again.

        Its first frame starts `first_frame_s` after the field's. The static layer is converted to points first; learned
        antenna gains belong to the fitted array and are dropped.
        """
        num_frames = num_frames or max(1, round(self._span_s() / config.frame_period_s))
        grid = CubeGrid.of(config, num_frames)
        grid = replace(grid, frame_time_s=grid.frame_time_s + first_frame_s)
        response = PointResponse(config)
        axes = response.axes()
        time_s = grid.frame_time_s - self.grid.frame_time_s[0]
        with torch.inference_mode():
            points = self._at(_frames_at(self.grid, time_s), response)
            static = _propagated(self._static_points(), self.fit_window.response, response, torch.zeros(1))
            cells = torch.cat([response.render(part, axes) for part in _each(points)]) + response.render(static, axes)
            values = (cells * response.phasor(axes) * self.peak).numpy()
        return RadarCube(values=values, grid=grid, config=config, scale=self.scale)

    def _at(self, frame: np.ndarray, response: PointResponse) -> Points:
        """Points (sample, point) propagated to fractional frames, in units of another response."""
        starts = np.arange(self.fit_window.num_frames)
        if self.fit_window.hop:
            index = np.zeros(len(frame), int)
            step_s = self.fit_window.hop * self.config.loop_period_s
            middle_s = self.fit_window.response.doppler_kernel.middle * self.config.loop_period_s
        else:
            index = np.abs(frame[:, None] - starts).argmin(axis=1)
            time_s = self.grid.frame_time_s
            step_s = time_s[1] - time_s[0] if len(time_s) > 1 else 0.0
            middle_s = doppler_window_middle(self.config.num_loops) * self.config.loop_period_s
        late_s = (frame - index) * step_s + response.doppler_kernel.middle * response.config.loop_period_s - middle_s
        return _propagated(
            self.layers.points[torch.from_numpy(index)], self.fit_window.response, response, torch.from_numpy(late_s)
        )

    def _cells(self, coordinates: Coordinates, frame: float) -> np.ndarray:
        """Values (point,) of one frame, cell by cell."""
        response = PointResponse(self.config)
        axes = response.axes(cells_at(self.grid, coordinates))
        with torch.inference_mode():
            points = self._at(np.array([frame]), response)
            static = interpolate(self.layers.static, coordinates[:, 1], is_signal=True)
            static = (static * line_weights(coordinates[:, 3], static.shape[1]).to(static.dtype)).sum(1)
            total = response.cells(points, axes)[0] + static * response.doppler_kernel(axes.doppler_bin)[0]
            total *= interpolate(self.layers.calibration, coordinates[:, 3])
            return (total * response.phasor(axes, is_grid=False) * self.peak).numpy()

    def _static_points(self) -> Points:
        """The static layer as points (1, point)."""
        response, axes = self.fit_window.response, self.fit_window.axes
        static = self.layers.static[None, :, None, :] * response.doppler_kernel(axes.doppler_bin)[0][:, None]
        if not bool((static != 0).any()):
            return no_points(1)
        one = replace(self.fit_window, num_frames=1)
        recipe = FitRecipe(num_points=STATIC_POINTS, with_static=False, least_gain=0.0)
        points = fitted(static, one, recipe).points
        return replace(points, doppler_bin=torch.zeros_like(points.doppler_bin))

    def _cell_noise(self) -> float:
        """Noise power per cell of the native grid, in units of peak squared."""
        if not self.fit_window.hop:
            return self.layers.noise_power
        window = doppler_window(self.config.num_loops)
        long = long_window(self.config.num_loops, self.fit_window.num_frames, self.fit_window.hop)
        return self.layers.noise_power * float(
            np.sum(window**2) / window.sum() ** 2 / (np.sum(long**2) / long.sum() ** 2)
        )

    def _span_s(self) -> float:
        time_s = self.grid.frame_time_s
        step_s = time_s[1] - time_s[0] if len(time_s) > 1 else self.config.frame_period_s
        return float(time_s[-1] - time_s[0] + step_s)


def _propagated(points: Points, own: PointResponse, other: PointResponse, late_s: Tensor) -> Points:
    """Points in units of another response, propagated by `late_s` (frame,) seconds from the middle of their frame.

    Range and phase follow the velocity; the phase is that of the other radar's carrier at that range.
    """
    late_s = late_s[:, None].double()
    velocity_mps = points.doppler_bin.double() * own.velocity_a_bin_mps
    range_m = (points.range_bin.double() - own.coupling * points.doppler_bin) * own.range_a_bin_m
    later_m = range_m + velocity_mps * late_s
    before, after = own.config, other.config
    cycles = 2 * velocity_mps * late_s / after.wavelength_m
    if after is not before:
        delay_s = 2 * range_m / SPEED_OF_LIGHT_MPS
        cycles = cycles + (after.centre_frequency_hz - before.centre_frequency_hz) * delay_s
        cycles = cycles - (after.chirp_slope_hz_per_s - before.chirp_slope_hz_per_s) * delay_s**2 / 2
    angle = 2 * math.pi * (cycles - cycles.round())
    phasor = torch.polar(torch.ones_like(angle), angle).to(torch.complex64)
    doppler_bin = velocity_mps / other.velocity_a_bin_mps
    return Points(
        range_bin=(later_m / other.range_a_bin_m + other.coupling * doppler_bin).float(),
        doppler_bin=doppler_bin.float(),
        direction=points.direction,
        amplitude=points.amplitude * phasor,
    )


def _each(points: Points) -> list[Points]:
    """Points frame by frame, which limits memory for many frames."""
    return [points[at : at + 1] for at in range(len(points.range_bin))]


def _frames_at(grid: CubeGrid, time_s: np.ndarray) -> np.ndarray:
    """Fractional frame indices of times since the first frame."""
    own_s = grid.frame_time_s
    return time_s / (own_s[1] - own_s[0]) if len(own_s) > 1 else np.zeros(len(time_s))


def interpolate(values: Tensor, cell: np.ndarray, *, is_signal: bool = False) -> Tensor:
    """Values (cell, ...) at fractional cells: linear, or band-limited (sinc) for a centred signal along range."""
    num = len(values)
    weights = torch.sinc(_distances(cell, num)) if is_signal else line_weights(cell, num)
    return (weights.to(values.dtype) @ values.reshape(num, -1)).reshape(-1, *values.shape[1:])


def line_weights(cell: np.ndarray, num: int) -> Tensor:
    """Weights (sample, cell) of linear interpolation between `num` cells; float64."""
    return (1 - _distances(cell, num).abs()).clamp(min=0)


def _distances(cell: np.ndarray, num: int) -> Tensor:
    return torch.from_numpy(np.asarray(cell, np.float64))[:, None] - torch.arange(num)
