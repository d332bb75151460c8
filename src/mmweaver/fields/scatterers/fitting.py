"""Fits scatterers to a cube: alternates greedy selection with joint refinement."""

from dataclasses import dataclass, replace

import torch
from torch import Tensor

from mmweaver.fields.beams import beams_of
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.greedy import Beams, next_points
from mmweaver.fields.scatterers.layers import (
    Layers,
    fit_static,
    join_points,
    no_points,
    static_values,
    strongest,
    subtract_static,
    values_of_point,
)
from mmweaver.fields.scatterers.refinement import Damping, refined

DENSE_SHARE = 0.5  # share of the stages after which the static layer drops beams not worth their parameters
CALIBRATED_EVERY = 4  # stages: gains change slowly
NOISE_CELLS = 30_000  # of which the median tells the power of the noise
WEAK_SHARE = 0.05  # quantile of amplitudes that counts as weak


@dataclass(frozen=True, kw_only=True)
class FitRecipe:
    """Budget and effort of a fit.

    `num_points` is shared by all frames, wherever points explain most energy. A new scatterer must explain at least
    `least_gain` times the noise power of a cell, so frames of pure noise get none. `num_values` limits the parameters
    of points, static layer and gains together; the static layer then keeps only the beams worth their parameters, and
    points get the rest.
    """

    num_points: int
    num_values: int | None = None
    with_static: bool = True
    with_calibration: bool = False
    stages: int = 30
    steps_a_stage: int = 1
    last_steps: int = 8
    swaps: int = 0  # rounds in which the weakest points are replaced
    swapped_share: float = 0.15
    largest_group: int = 160
    least_gain: float = 8.0
    most_noise: float | None = None  # noise power of a cell, where it is known; the residual may show less


def fitted(target: Tensor, fit_window: FitWindow, recipe: FitRecipe) -> Layers:
    """Layers that approximate the working frames `target` (frame, range, doppler, antenna) in least squares."""
    with torch.no_grad():
        return _Fit(target, fit_window, recipe).run()


class _Fit:
    """State of one fit; invariant: `residual` = target / calibration - static - points."""

    def __init__(self, target: Tensor, fit_window: FitWindow, recipe: FitRecipe):
        self.target, self.recipe, self.fit_window = target, recipe, fit_window
        self.response, self.axes = fit_window.response, fit_window.axes
        self.to_beams = torch.from_numpy(beams_of(fit_window.config)).to(target.dtype)
        self.beams = Beams.over(self.axes, self.response.num_directions)
        self.calibration = torch.ones(target.shape[-1], dtype=target.dtype)
        self.points = no_points(len(target))
        self.damping = Damping.fresh(len(target))
        self.static = torch.zeros_like(target[0, :, 0])
        self.active_beams: Tensor | None = None  # (range, beam) of the static layer; None = all
        self.calibrated = target  # over the gains
        self.residual = target.clone()
        self.refinements = 0
        self._update_static()

    def run(self) -> Layers:
        recipe = self.recipe
        for stage in range(recipe.stages):
            if recipe.num_values is not None and stage >= DENSE_SHARE * recipe.stages:
                self.active_beams = self._worthwhile_beams()
                self._update_static()
            self._fill(round(self._most_points() * (stage + 1) / recipe.stages))
            self._refine(recipe.steps_a_stage)
        for _ in range(recipe.swaps):
            self.points = strongest(self.points, round(self._most_points() * (1 - recipe.swapped_share)))
            self.residual = self._without_static() - self.response.render(self.points, self.axes)
            self._refine(1)
            self._add(self._most_points())
            self._refine(max(2, recipe.steps_a_stage))
        self._refine(recipe.last_steps)
        return Layers(
            points=self.points, static=self.static, calibration=self.calibration, noise_power=self._noise_power(),
            active_beams=self.active_beams,
        )  # fmt: skip

    def _fill(self, wanted: int) -> None:
        """Adds new scatterers, or removes the weakest, up to the wanted number."""
        if int((self.points.amplitude != 0).sum()) > wanted:
            self.points = strongest(self.points, wanted)
            self.residual = self._without_static() - self.response.render(self.points, self.axes)
        self._add(wanted)

    def _add(self, wanted: int) -> None:
        have = int((self.points.amplitude != 0).sum())
        if wanted > have:
            least = self.recipe.least_gain * self._noise_power()
            new = next_points(self.residual, self.response, self.axes, self.beams, count=wanted - have, least=least)
            self.points = join_points(self.points, new)
            if new.amplitude.shape[1]:
                self.residual = self.response.render(replace(new, amplitude=-new.amplitude), self.axes, self.residual)

    def _refine(self, steps: int) -> None:
        if not self.points.amplitude.shape[1]:
            return
        self.points, self.residual = refined(
            self.points, self._without_static(), self.response, self.axes, self.damping,
            steps=steps, largest=self.recipe.largest_group, residual=self.residual,
        )  # fmt: skip
        self.refinements += 1
        if self.recipe.with_calibration and (steps > 1 or self.refinements % CALIBRATED_EVERY == 0):
            self._calibrate()
        self._update_static()

    def _without_static(self) -> Tensor:
        out = self.calibrated.clone()
        subtract_static(out, self.static, self.response, self.axes)
        return out

    def _update_static(self) -> None:
        """Moves the static part of the residual into the static layer."""
        if not self.recipe.with_static:
            return
        before = self.static
        self.static = before + fit_static(self.residual, self.response, self.axes)
        if self.active_beams is not None:
            self.static = (self.static @ self.to_beams.T * self.active_beams) @ self.to_beams.conj()
        subtract_static(self.residual, self.static - before, self.response, self.axes)

    def _worthwhile_beams(self) -> Tensor:
        """Beams (range, beam) that explain more energy per parameter than a weak scatterer does."""
        slow = float(self.response.doppler_kernel(self.axes.doppler_bin)[0].square().sum())
        fast = float(self.response.range_kernel(torch.arange(-2.0, 3.0))[0].square().sum())
        echo = self.points.amplitude.abs()
        echo = echo[echo > 0].square() * (len(self.calibration) * fast * slow)
        weak = float(echo.quantile(WEAK_SHARE)) if len(echo) else 0.0
        least = max(weak, self.recipe.least_gain * self._noise_power()) * 2 / values_of_point(self.response)
        beams = (self.static + fit_static(self.residual, self.response, self.axes)) @ self.to_beams.T
        return beams.abs().square() * (len(self.target) * slow) > least

    def _most_points(self) -> int:
        recipe = self.recipe
        if recipe.num_values is None:
            return recipe.num_points
        static = static_values(self.active_beams, self.static.numel()) if recipe.with_static else 0
        gains = 2 * len(self.calibration) if recipe.with_calibration else 0
        return min(recipe.num_points, (recipe.num_values - static - gains - 1) // values_of_point(self.response))

    def _calibrate(self) -> None:
        """Least-squares gain of each antenna; the mean gain stays 1."""
        received = self._without_static()
        model = received - self.residual
        gain = (model.conj() * received).sum((0, 1, 2)) / model.abs().square().sum((0, 1, 2)).clamp(min=1e-30)
        gain = gain / gain.abs().mean().clamp(min=1e-6)
        self.calibration = self.calibration * gain
        self.calibrated = self.target / self.calibration
        self.static = self.static / gain
        self.residual = self._without_static() - model

    def _noise_power(self) -> float:
        """Noise power per cell, from the median of a chi-squared with two degrees of freedom (ln 2 of its mean)."""
        some = self.residual.flatten()[:: max(1, self.residual.numel() // NOISE_CELLS)]
        found = float(torch.view_as_real(some).square().sum(-1).median()) / 0.6931
        most = self.recipe.most_noise
        return found if most is None else min(found, most)
