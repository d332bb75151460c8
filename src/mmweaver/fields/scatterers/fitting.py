"""Fits scatterers to a cube: greedily where the most energy is left, then all together, and again."""

from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.fields.beams import beams_of
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.greedy import Beams, next_points
from mmweaver.fields.scatterers.layers import (
    Layers,
    at_rest,
    joined,
    no_points,
    static_cells,
    static_values,
    strongest,
    values_of_point,
)
from mmweaver.fields.scatterers.refinement import Damping, refined

DENSE_SHARE = 0.5  # of the stages; then the static layer loses the beams that are not worth their numbers
WEAK_SHARE = 0.05  # so many scatterers are weak


@dataclass(frozen=True, kw_only=True)
class FitRecipe:
    """How hard to try.

    `num_points` over all frames: where they are worth most, they go. A scatterer must take away `least_gain` times
    the noise power of a cell to be kept in the running; so frames of noise get none. `num_values`: the most numbers
    that points, static layer and gains may have together; the static layer then keeps only those of its beams that
    are worth their numbers, and points get the rest.
    """

    num_points: int
    num_values: int | None = None
    with_static: bool = True
    with_calibration: bool = False
    stages: int = 30
    steps_a_stage: int = 1
    last_steps: int = 8
    swaps: int = 0  # times the weakest are replaced by new ones
    swapped_share: float = 0.15
    largest_group: int = 160
    least_gain: float = 8.0


def fitted(target: Tensor, stretch: FitWindow, recipe: FitRecipe) -> Layers:
    """Layers whose rendering is close to the working frames `target`, in the least-squares sense."""
    with torch.no_grad():
        return _Fit(target, stretch, recipe).run()


class _Fit:
    """State of one fit. `residual` is always target / calibration - static - points."""

    def __init__(self, target: Tensor, stretch: FitWindow, recipe: FitRecipe):
        self.target, self.recipe, self.stretch = target, recipe, stretch
        self.response, self.axes = stretch.response, stretch.axes
        self.to_beams = torch.from_numpy(beams_of(stretch.config)).to(target.dtype)
        self.beams = Beams.over(self.axes, self.response.num_directions)
        self.calibration = torch.ones(target.shape[-1], dtype=target.dtype)
        self.points = no_points(len(target))
        self.damping = Damping.fresh(len(target))
        self.static = torch.zeros_like(target[0, :, 0])
        self.kept_beams: Tensor | None = None  # (range, beam) of the static layer; None = all
        self.residual = target.clone()
        self._rest()

    def run(self) -> Layers:
        recipe = self.recipe
        for stage in range(recipe.stages):
            if recipe.num_values is not None and stage >= DENSE_SHARE * recipe.stages:
                self.kept_beams = self._worth_keeping()
                self._rest()
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
            kept_beams=self.kept_beams,
        )  # fmt: skip

    def _fill(self, wanted: int) -> None:
        """As many scatterers as wanted: new ones, or without the weakest."""
        if int((self.points.amplitude != 0).sum()) > wanted:
            self.points = strongest(self.points, wanted)
            self.residual = self._without_static() - self.response.render(self.points, self.axes)
        self._add(wanted)

    def _add(self, wanted: int) -> None:
        have = int((self.points.amplitude != 0).sum())
        least = self.recipe.least_gain * self._noise_power()
        if wanted > have:
            new = next_points(self.residual, self.response, self.axes, self.beams, count=wanted - have, least=least)
            self.points = joined(self.points, new)

    def _refine(self, steps: int) -> None:
        if not self.points.amplitude.shape[1]:
            return
        self.points, self.residual = refined(
            self.points, self._without_static(), self.response, self.axes, self.damping,
            steps=steps, largest=self.recipe.largest_group,
        )  # fmt: skip
        if self.recipe.with_calibration:
            self._calibrate()
        self._rest()

    def _without_static(self) -> Tensor:
        return self.target / self.calibration - static_cells(self.static, self.response, self.axes)

    def _rest(self) -> None:
        """What is left at rest goes to the static layer."""
        if not self.recipe.with_static:
            return
        before = self.static
        self.static = before + at_rest(self.residual, self.response, self.axes)
        if self.kept_beams is not None:
            self.static = (self.static @ self.to_beams.T * self.kept_beams) @ self.to_beams.conj()
        self.residual = self.residual - static_cells(self.static - before, self.response, self.axes)

    def _worth_keeping(self) -> Tensor:
        """Beams of the static layer that take away more energy for their two numbers than a weak scatterer for its."""
        slow = float(self.response.doppler_kernel(self.axes.doppler_bin)[0].square().sum())
        fast = float(self.response.range_kernel(torch.arange(-2.0, 3.0))[0].square().sum())
        echo = self.points.amplitude.abs()
        echo = echo[echo > 0].square() * (len(self.calibration) * fast * slow)
        weak = float(echo.quantile(WEAK_SHARE)) if len(echo) else 0.0
        least = max(weak, self.recipe.least_gain * self._noise_power()) * 2 / values_of_point(self.response)
        beams = (self.static + at_rest(self.residual, self.response, self.axes)) @ self.to_beams.T
        return beams.abs().square() * (len(self.target) * slow) > least

    def _most_points(self) -> int:
        recipe = self.recipe
        if recipe.num_values is None:
            return recipe.num_points
        static = static_values(self.kept_beams, self.static.numel()) if recipe.with_static else 0
        gains = 2 * len(self.calibration) if recipe.with_calibration else 0
        return min(recipe.num_points, (recipe.num_values - static - gains - 1) // values_of_point(self.response))

    def _calibrate(self) -> None:
        """Gain of each antenna that suits the points best; the mean gain stays 1."""
        heard = self._without_static()
        model = heard - self.residual
        gain = (model.conj() * heard).sum((0, 1, 2)) / model.abs().square().sum((0, 1, 2)).clamp(min=1e-30)
        gain = gain / gain.abs().mean().clamp(min=1e-6)
        self.calibration = self.calibration * gain
        self.static = self.static / gain
        self.residual = self._without_static() - model

    def _noise_power(self) -> float:
        """Of one cell: the median of a chi-squared with two degrees of freedom is ln 2 of its mean."""
        power = torch.view_as_real(self.residual).square().sum(-1)
        return float(power.flatten()[:: max(1, power.numel() // 100_000)].median()) / 0.6931
