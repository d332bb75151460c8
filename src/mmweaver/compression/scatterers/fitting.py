"""Fits scatterers to a cube by alternating greedy selection and joint refinement.

Greedy selection of new scatterers: matched-filter peaks of the residual.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.quantised_cells import beams_of
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.layers import (
    Layers,
    compact,
    fit_static,
    no_points,
    static_response,
    static_values,
    strongest,
    subtract_static,
    values_of_point,
)
from mmweaver.compression.scatterers.point_factors import FactorAxes, PointFactors
from mmweaver.compression.scatterers.refinement import Damping, refined_factors
from mmweaver.signal.point_response import Axes, PointResponse

Array = np.ndarray
BEAMS_A_WAVELENGTH = 2.2  # slightly denser than the array's resolution
CELLS_A_POINT, CELLS_AT_ONCE = 12, 8192
MIN_BEND = 0.5  # of a parabola, relative to its peak
ROUNDED = 1e-4
PEAK_SHARE = 0.9  # share of the peak that a new scatterer receives, since neighbours share its energy
SIDES = (-1, 0, 1)


@dataclass(frozen=True, kw_only=True)
class Beams:
    """Grid of direction cosines (beam, 2) and unit-norm steering vectors (antenna, beam)."""

    direction: Tensor
    steer: Tensor

    @classmethod
    def covering(cls, axes: Axes, num_directions: int) -> "Beams":
        """Beams as dense as the aperture requires.

        Args:
            axes: Cells with the antenna positions.
            num_directions: Number of direction cosines that the array resolves; along others a single zero cosine is
                used.
        """
        sides = []
        for side in range(2):
            if side >= num_directions:
                sides.append(torch.zeros(1))
                continue
            aperture = float(axes.place[:, side].max() - axes.place[:, side].min())
            sides.append(torch.linspace(-0.95, 0.95, max(3, round(2 * BEAMS_A_WAVELENGTH * (aperture + 0.5)))))
        x, z = torch.meshgrid(*sides, indexing="ij")
        direction = torch.stack([x.flatten(), z.flatten()], dim=1)
        direction = direction[(direction**2).sum(1) <= 1]
        angle = 2 * torch.pi * (axes.place @ direction.T)
        return cls(direction=direction, steer=torch.polar(torch.ones_like(angle), angle) / len(axes.place) ** 0.5)


@dataclass(frozen=True, kw_only=True)
class NewPoints:
    """Scatterers to add, one row each, sorted by frame."""

    frame: Array
    bins: Array  # (2, point) range and Doppler
    direction: Array  # (point, 2)
    amplitude: Array  # (point,) complex64

    def __len__(self) -> int:
        return len(self.frame)


@dataclass(frozen=True, kw_only=True)
class Greedy:
    """Finds scatterers in residuals (frame, range, doppler, antenna)."""

    axes: FactorAxes
    beams: Beams
    taps: tuple[Array, Array] = field(init=False)  # matched filters along range and Doppler: main lobe, unit norm

    def __post_init__(self) -> None:
        object.__setattr__(self, "taps", tuple(_taps(kernel) for kernel in self._kernels))

    @classmethod
    def of(cls, response: PointResponse, axes: Axes) -> "Greedy":
        """A search with beams as dense as the array resolves."""
        return cls(axes=FactorAxes.of(response, axes), beams=Beams.covering(axes, response.num_directions))

    @property
    def _kernels(self):
        return self.axes.response.range_kernel, self.axes.response.doppler_kernel

    def matched_power(self, residual: Array, *, count: int, least: float) -> tuple[Array, Array]:
        """Energy that one scatterer per cell would explain, and its best beam.

        The matched filter of a cell is at most the sum of the magnitudes around it, and no beam has more than the
        energy of all antennas. Beams are formed in the cells where this bound is largest, in growing numbers.

        Args:
            residual: Residual (frame, range, doppler, antenna).
            count: Number of local maxima that must be exact.
            least: Energy up to which cells are ignored.

        Returns:
            Energy (frame, range, doppler), possibly 0 where it is at most `least` or below `count` local maxima, and
            the index of the beam.
        """
        bound = np.sqrt(np.einsum("...a,...a->...", *(2 * [residual.view(np.float32)])))
        bound = np.square(_along(_along(bound, self.taps[0], 1), self.taps[1], 2)) * np.float32(1 + ROUNDED)
        power, beam = np.zeros_like(bound), np.zeros(bound.shape, np.int64)
        done, wanted = 0, CELLS_A_POINT * count
        order = np.argsort(-bound, axis=None) if bound.size <= 4 * wanted else _largest(bound, 4 * wanted)
        while True:
            if wanted > len(order):
                order = np.argsort(-bound, axis=None)
            for first in range(done, min(wanted, len(order)), CELLS_AT_ONCE):
                self._beam(residual, order[first : min(first + CELLS_AT_ONCE, wanted)], power, beam)
            done = min(wanted, len(order))
            reached = float(bound.flat[order[done - 1]])
            if done == bound.size or reached <= least:
                return power, beam
            if np.count_nonzero(peaks(power) > max(reached, least)) >= count:
                return power, beam
            wanted = 2 * done

    def _beam(self, residual: Array, cells: Array, power: Array, beam: Array) -> None:
        """Computes the strongest beam of some cells."""
        found = _matched_filter(residual, cells, self.taps) @ self.beams.steer.numpy()
        each = np.square(found.real) + np.square(found.imag)
        best = each.argmax(axis=1)
        power.flat[cells], beam.flat[cells] = each[np.arange(len(best)), best], best

    def next_points(self, residual: Array, *, count: int, least: float) -> NewPoints:
        """The best new scatterers over all frames, local maxima over range and Doppler.

        Args:
            residual: Residual (frame, range, doppler, antenna).
            count: Maximum number of scatterers.
            least: Energy that each must explain.
        """
        least = max(least, 0.0)
        power, beam = self.matched_power(residual, count=count, least=least)
        top = peaks(power)
        cells = np.flatnonzero(top > least)
        if len(cells) > count:
            cells = cells[np.argpartition(-top.flat[cells], count)[:count]]
        cells.sort()
        frame, row, column = np.unravel_index(cells, power.shape)
        steer = self.beams.steer.numpy().T[beam.flat[cells]] / np.float32(len(self.axes.place) ** 0.5)
        offsets, amplitude = [], np.full(len(cells), np.float32(PEAK_SHARE), np.complex64)
        values = residual.reshape(-1, residual.shape[-1])
        peak = (values[cells] * steer).sum(axis=1)
        for kernel, index, stride, size in (
            (self._kernels[0], row, power.shape[2], power.shape[1]),
            (self._kernels[1], column, 1, power.shape[2]),
        ):
            offset = _offset(values, cells, steer, peak, index, stride, size)
            offsets.append(offset)
            amplitude /= kernel.bin_values(0.0, 1, offset)[0, :, 0]
        bins = np.stack([self.axes.first_range + row + offsets[0], self.axes.first_doppler + column + offsets[1]])
        return NewPoints(
            frame=frame,
            bins=bins.astype(np.float32),
            direction=self.beams.direction.numpy()[beam.flat[cells]],
            amplitude=amplitude * peak,
        )


def peaks(power: Array) -> Array:
    """Powers (frame, range, doppler) of local maxima over range and Doppler, 0 elsewhere."""
    most = power
    for axis in (1, 2):
        wider = most.copy()
        low, high = (_part(axis, slice(*ends)) for ends in ((None, -1), (1, None)))
        np.maximum(wider[low], most[high], out=wider[low])
        np.maximum(wider[high], most[low], out=wider[high])
        most = wider
    return np.where(power >= most, power, 0)


def _part(axis: int, own: slice) -> tuple[slice, ...]:
    return (*[slice(None)] * axis, own)


def _taps(kernel) -> Array:
    side, middle = kernel.bin_values(1.0, 1, np.zeros(1))[0, 0, 0], kernel.bin_values(0.0, 1, np.zeros(1))[0, 0, 0]
    taps = np.array([side, middle, side])
    return taps / np.float32(np.linalg.norm(taps))


def _along(values: Array, taps: Array, axis: int) -> Array:
    out = abs(taps[1]) * values
    low, high = (_part(axis, slice(*ends)) for ends in ((None, -1), (1, None)))
    out[low] += abs(taps[2]) * values[high]
    out[high] += abs(taps[0]) * values[low]
    return out


def _matched_filter(residual: Array, cells: Array, taps: tuple[Array, Array]) -> Array:
    """Matched filter of a residual at some cells, complex (cell, antenna)."""
    num_range, num_doppler, antennas = residual.shape[1:]
    rest, column = np.divmod(cells, num_doppler)
    row = rest % num_range
    places, weights = [], []
    for by_range, tap in zip(SIDES, taps[0], strict=True):
        has_row = (row + by_range >= 0) & (row + by_range < num_range)
        for by_doppler, other in zip(SIDES, taps[1], strict=True):
            inside = has_row & (column + by_doppler >= 0) & (column + by_doppler < num_doppler)
            places.append(np.where(inside, cells + by_range * num_doppler + by_doppler, cells))
            weights.append(tap * other * inside)
    near = residual.view(np.float32).reshape(-1, 2 * antennas).take(np.stack(places, axis=1), axis=0)
    return (np.stack(weights, axis=1, dtype=np.float32)[:, None] @ near)[:, 0].view(np.complex64)


def _largest(values: Array, count: int) -> Array:
    """Indices of the `count` largest values, in decreasing order."""
    found = np.argpartition(-values, count, axis=None)[:count]
    return found[np.argsort(-values.flat[found])]


def _offset(values: Array, cells: Array, steer: Array, peak: Array, index: Array, stride: int, size: int) -> Array:
    """Offset in bins of a parabola through each peak and its neighbours along an axis.

    `values` are (cell, antenna); `index` are the positions of the peaks along the axis of `size` cells, `stride` apart.
    """
    before, after = (
        ((values[cells + side * stride * inside] * steer).sum(axis=1) / np.where(peak, peak, 1)).real * inside
        for side, inside in ((-1, index > 0), (1, index < size - 1))
    )
    return ((after - before) / np.maximum(2 * (2 - after - before), MIN_BEND)).clip(-0.5, 0.5)


# minimum echo power of an antenna relative to the strongest, and minimum share received in phase with the model
MIN_SHARE = 0.05
DENSE_SHARE = 0.5  # share of the stages after which the static layer drops beams not worth their parameters
WEAK_SHARE = 0.05  # quantile of amplitudes that counts as weak
CALIBRATED_EVERY = 4  # stages: gains change slowly
NOISE_CELLS = 10_000  # sample size for the median noise power
MAX_GROUP = 160  # scatterers that are solved for jointly


Progress = Callable[[int, int, float], object]  # stage, stages, error in dB


@dataclass(frozen=True, kw_only=True)
class FitRecipe:
    """Budget and effort of a fit.

    `num_points` is shared by all frames, wherever points explain most energy. A new scatterer must explain at least
    `least_gain` times the noise power of a cell, so frames of pure noise get none. `num_values` limits the real
    parameters of points, static layer and gains together; the static layer then keeps only the beams of the array that
    are worth their parameters, and points get the rest.
    """

    num_points: int
    num_values: int | None = None
    with_static: bool = True
    with_calibration: bool = False
    stages: int = 30
    growth: float = 1.0  # exponent: after a share of the stages, that share to this power of all points is placed
    last_steps: int = 8
    least_gain: float = 8.0
    most_noise: float | None = None  # upper bound of the noise power per cell, where it is known


def fitted(target: Tensor, fit_window: FitWindow, recipe: FitRecipe, progress: Progress | None = None) -> Layers:
    """Least-squares approximation of working frames by layers.

    Args:
        target: Working frames (frame, range, doppler, antenna) in centred phase, complex64.
        fit_window: Fit window of these frames.
        recipe: Budget and effort.
        progress: Called with stage, number of stages and error in dB.

    Returns:
        Scatterers, static layer, antenna gains and noise power.
    """
    with torch.no_grad():
        return _Fit(target, fit_window, recipe).run(progress)


class _Fit:
    """State of one fit; invariants: `received` = target / calibration - static, `residual` = received - points."""

    def __init__(self, target: Tensor, fit_window: FitWindow, recipe: FitRecipe):
        self.target, self.recipe = target.contiguous().numpy(), recipe
        self.response, self.axes = fit_window.response, fit_window.axes
        self.to_beams = beams_of(fit_window.config).astype(np.complex64)
        self.active_beams: Array | None = None
        self.greedy = Greedy.of(self.response, self.axes)
        self.calibration = np.ones(target.shape[-1], np.complex64)
        self.points = PointFactors.of(no_points(len(target)), self.response, self.axes)
        self.damping = Damping.fresh(len(target))
        self.static = np.zeros(self.target.shape[1::2], np.complex64)
        self.static_response = static_response(self.response, self.axes)
        self.received, self.residual = self.target.copy(), self.target.copy()
        self.refinements = 0
        self._update_static()

    def run(self, progress: Progress | None = None) -> Layers:
        """Runs all stages and returns the layers."""
        recipe = self.recipe
        energy = float(np.sum(np.abs(self.target) ** 2, dtype=np.float64)) if progress else 0.0
        for stage in range(1, recipe.stages + 1):
            if recipe.num_values is not None and stage - 1 >= DENSE_SHARE * recipe.stages:
                self.active_beams = self._worthwhile_beams()
                self._update_static()
            self._fill(round(self._max_points() * (stage / recipe.stages) ** recipe.growth))
            self._refine(1)
            if progress is not None:
                error = float(np.sum(np.abs(self.residual) ** 2, dtype=np.float64))
                progress(stage, recipe.stages, 10 * math.log10(max(error / energy, 1e-30)))
        self._refine(recipe.last_steps)
        return Layers(
            points=compact(self.points.points()),
            static=torch.from_numpy(self.static),
            calibration=torch.from_numpy(self.calibration),
            noise_power=self._noise_power(),
            active_beams=self.active_beams,
        )

    def _max_points(self) -> int:
        """How many scatterers the fit may have after its last stage."""
        recipe = self.recipe
        if recipe.num_values is None:
            return recipe.num_points
        static = static_values(self.active_beams, self.static.size) if recipe.with_static else 0
        gains = 2 * len(self.calibration) if recipe.with_calibration else 0
        left = recipe.num_values - static - gains - 1
        return max(0, min(recipe.num_points, left // values_of_point(self.response)))

    @property
    def _num_points(self) -> int:
        return int(np.count_nonzero(self.points.amplitude))

    def _fill(self, wanted: int) -> None:
        """Adds new scatterers, or removes the weakest, to reach the wanted number."""
        if self._num_points > wanted:
            self._keep(wanted)
        self._add(wanted)

    def _keep(self, wanted: int) -> None:
        """Keeps the strongest scatterers."""
        kept = strongest(self.points.points(), wanted)
        self.points = PointFactors.of(kept, self.response, self.axes)
        self.residual = self.received - self.response.render(kept, self.axes).numpy()

    def _add(self, wanted: int) -> None:
        have = self._num_points
        if wanted <= have:
            return
        least = self.recipe.least_gain * self._noise_power()
        new = self.greedy.next_points(self.residual, count=wanted - have, least=least)
        before = self.points.counts().tolist()
        self.points = self.points.joined(new.frame, new.bins, new.direction, new.amplitude)
        rest = _matrices(self.residual)
        for frame, (first, count) in enumerate(zip(before, self.points.counts().tolist(), strict=True)):
            if count > first:
                rest[frame] -= self.points.rendered(frame, count, first)

    def _refine(self, steps: int) -> None:
        if not self._num_points:
            return
        self.points = refined_factors(
            self.points,
            _matrices(self.received),
            _matrices(self.residual),
            self.damping,
            steps=steps,
            largest=MAX_GROUP,
        )
        self.refinements += 1
        if self.recipe.with_calibration and (steps > 1 or self.refinements % CALIBRATED_EVERY == 0):
            self._calibrate()
        self._update_static()

    def _update_static(self) -> None:
        """Moves the static part of the residual into the static layer."""
        if not self.recipe.with_static:
            return
        before = self.static
        self.static = self._whole_static()
        if self.active_beams is not None:
            self.static = (self.static @ self.to_beams.T * self.active_beams) @ self.to_beams.conj()
        for values in (self.received, self.residual):
            subtract_static(values, self.static - before, self.static_response)

    def _whole_static(self) -> Array:
        """The static layer with what the residual holds of it."""
        return self.static + fit_static(self.residual, self.static_response)

    def _worthwhile_beams(self) -> Array:
        """Beams (range, beam) that explain more energy per parameter than a weak scatterer does."""
        slow = float(self.response.doppler_kernel(self.axes.doppler_bin)[0].square().sum())
        fast = float(self.response.range_kernel(torch.arange(-2.0, 3.0))[0].square().sum())
        echo = np.abs(self.points.amplitude[self.points.amplitude != 0])
        weak = float(np.quantile(np.square(echo), WEAK_SHARE)) if len(echo) else 0.0
        weak *= len(self.calibration) * fast * slow
        least = max(weak, self.recipe.least_gain * self._noise_power()) * 2 / values_of_point(self.response)
        return np.square(np.abs(self._whole_static() @ self.to_beams.T)) * (len(self.target) * slow) > least

    def _calibrate(self) -> None:
        """Least-squares gain of each antenna with a mean of 1. Antennas without echoes keep theirs."""
        model = self.received - self.residual
        flat, received = (values.reshape(-1, values.shape[-1]) for values in (model, self.received))
        power = np.einsum("caq,caq->a", *(2 * [flat.view(np.float32).reshape(*flat.shape, 2)]))
        product = np.einsum("ca,ca->a", flat.conj(), received)
        has_echo = (power > MIN_SHARE * power.max()) & (np.abs(product) > MIN_SHARE * power)
        if not has_echo.any():
            return
        gain = np.ones(len(power), np.complex64)
        gain[has_echo] = product[has_echo] / power[has_echo]
        gain[has_echo] /= np.abs(gain[has_echo]).mean()
        self.calibration = self.calibration * gain
        self.static = self.static / gain
        self.received = self.target * (1 / self.calibration)
        subtract_static(self.received, self.static, self.static_response)
        self.residual = self.received - model

    def _noise_power(self) -> float:
        """Noise power per cell, from the median of a chi-squared with two degrees of freedom (ln 2 of its mean)."""
        some = self.residual.reshape(-1)[:: max(1, self.residual.size // NOISE_CELLS)]
        found = float(np.median(np.square(some.real) + np.square(some.imag))) / 0.6931
        most = self.recipe.most_noise
        return found if most is None else min(found, most)


def _matrices(values: Array) -> Array:
    """Complex (frame, range, doppler, antenna) as a real view (frame, range, (doppler, antenna, part))."""
    return values.view(np.float32).reshape(*values.shape[:2], -1)
