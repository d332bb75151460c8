"""A fit of scatterers in a limited number of real parameters: points, static layer and gains together.

The static layer then keeps only the beams of the array that are worth their parameters, and points get the rest.
"""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.beams import beams_of
from mmweaver.compression.scatterers.fit_window import FitWindow
from mmweaver.compression.scatterers.fitting import FitRecipe, ScattererFit
from mmweaver.compression.scatterers.layers import Layers, values_of_point
from mmweaver.signal.point_response import PointResponse

Array = np.ndarray
DENSE_SHARE = 0.5  # share of the stages after which the static layer drops beams not worth their parameters
WEAK_SHARE = 0.05  # quantile of amplitudes that counts as weak
BITS_OF_VALUE = 32  # float32


@dataclass(frozen=True, kw_only=True)
class BudgetedRecipe(FitRecipe):
    """A recipe with a limit of real parameters; None sets none."""

    num_values: int | None = None


class BudgetedFit(ScattererFit):
    """A fit whose `active_beams` (range, beam) of the static layer are not zero; None = all."""

    def __init__(self, target: Tensor, fit_window: FitWindow, recipe: BudgetedRecipe):
        self.num_values, self.active_beams = recipe.num_values, None
        self.to_beams = beams_of(fit_window.config).astype(np.complex64)
        super().__init__(target, fit_window, recipe)

    def most_points(self, stage: int) -> int:
        recipe, point = self.recipe, values_of_point(self.response)
        if self.num_values is None:
            return recipe.num_points
        if stage - 1 >= DENSE_SHARE * recipe.stages:
            self.active_beams = self._worthwhile_beams()
            self.update_static()
        static = static_values(self.active_beams, self.static.size) if recipe.with_static else 0
        gains = 2 * len(self.calibration) if recipe.with_calibration else 0
        return min(recipe.num_points, (self.num_values - static - gains - 1) // point)

    def whole_static(self) -> Array:
        static = super().whole_static()
        if self.active_beams is None:
            return static
        return (static @ self.to_beams.T * self.active_beams) @ self.to_beams.conj()

    def _worthwhile_beams(self) -> Array:
        """Beams (range, beam) that explain more energy per parameter than a weak scatterer does."""
        slow = float(self.response.doppler_kernel(self.axes.doppler_bin)[0].square().sum())
        fast = float(self.response.range_kernel(torch.arange(-2.0, 3.0))[0].square().sum())
        echo = np.abs(self.points.amplitude[self.points.amplitude != 0])
        weak = float(np.quantile(np.square(echo), WEAK_SHARE)) if len(echo) else 0.0
        weak *= len(self.calibration) * fast * slow
        least = max(weak, self.recipe.least_gain * self.noise_power()) * 2 / values_of_point(self.response)
        beams = super().whole_static() @ self.to_beams.T
        return np.square(np.abs(beams)) * (len(self.target) * slow) > least


def num_values(layers: Layers, active_beams: Array | None, response: PointResponse) -> int:
    """Number of real parameters: points, static layer, learned gains, and the noise power."""
    points = int(layers.counts().sum()) * values_of_point(response)
    static = static_values(active_beams, layers.static.numel()) if bool((layers.static != 0).any()) else 0
    gains = 2 * layers.calibration.numel() if bool((layers.calibration != 1).any()) else 0
    return points + static + gains + 1


def static_values(active_beams: Array | None, num_cells: int) -> int:
    """Real parameters of a static layer: two per active beam, and one per 32 bits of the mask (range, beam)."""
    if active_beams is None:
        return 2 * num_cells
    return min(2 * num_cells, 2 * int(active_beams.sum()) + -(-num_cells // BITS_OF_VALUE))
