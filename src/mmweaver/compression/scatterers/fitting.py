"""Fits scatterers to a cube by alternating greedy selection and joint refinement."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.beams import beams_of
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.greedy import Greedy
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
from mmweaver.compression.scatterers.point_factors import PointFactors
from mmweaver.compression.scatterers.refinement import Damping, refined_factors

Array = np.ndarray

# minimum echo power of an antenna relative to the strongest, and minimum share received in phase with the model
MIN_SHARE = 0.05
DENSE_SHARE = 0.5  # share of the stages after which the static layer drops beams not worth their parameters
WEAK_SHARE = 0.05  # quantile of amplitudes that counts as weak
CALIBRATED_EVERY = 4  # stages: gains change slowly
NOISE_CELLS = 10_000  # sample size for the median noise power
MAX_GROUP = 160  # scatterers that are solved for jointly


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


def fitted(target: Tensor, fit_window: FitWindow, recipe: FitRecipe) -> Layers:
    """Least-squares approximation of working frames by layers.

    Args:
        target: Working frames (frame, range, doppler, antenna) in centred phase, complex64.
        fit_window: Fit window of these frames.
        recipe: Budget and effort.

    Returns:
        Scatterers, static layer, antenna gains and noise power.
    """
    with torch.no_grad():
        return _Fit(target, fit_window, recipe).run()


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

    def run(self) -> Layers:
        """Runs all stages and returns the layers."""
        recipe = self.recipe
        for stage in range(1, recipe.stages + 1):
            if recipe.num_values is not None and stage - 1 >= DENSE_SHARE * recipe.stages:
                self.active_beams = self._worthwhile_beams()
                self._update_static()
            self._fill(round(self._max_points() * (stage / recipe.stages) ** recipe.growth))
            self._refine(1)
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
        return min(recipe.num_points, (recipe.num_values - static - gains - 1) // values_of_point(self.response))

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
