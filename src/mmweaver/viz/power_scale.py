"""One scale of decibels, including the noise level, for all pictures of a cube: an echo has the same colour in each."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Array
from mmweaver.viz.theme import POWER_MAP, colour_bar

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

Extent = tuple[float, float, float, float]  # left, right, bottom, top, in units of the axes

BELOW_NOISE_DB = 5.0
MIN_ABOVE_NOISE_DB = 40.0  # so that noise alone looks like noise
MAX_SPAN_DB = 80.0
WITHOUT_NOISE_DB = 60.0  # shown below the peak of a cube without noise
TICK_DB = 5.0


@dataclass(frozen=True, kw_only=True)
class PowerScale:
    """Decibels from `low_db` to `high_db`: dBm at a receiver's port, or relative to a count of a recording.

    `noise_db` is the noise power per cell, None for a cube without noise.
    """

    factor: float  # from the cube's power to mW, or 1
    low_db: float
    high_db: float
    noise_db: float | None
    unit: str

    @classmethod
    def of(cls, peak: float, noise: float | None, scale: float) -> "PowerScale":
        """The scale that shows noise and peak.

        Args:
            peak: Peak power in squared units of the cube.
            noise: Noise power per cell in squared units of the cube, if known.
            scale: Sqrt(mW) per unit of the cube, as `RadarCube.scale`.
        """
        is_absolute = math.isfinite(scale) and scale > 0
        factor, unit = (scale**2, "dBm") if is_absolute else (1.0, "dB relative to one count")
        if not peak > 0:
            return cls(factor=factor, low_db=-MIN_ABOVE_NOISE_DB, high_db=0.0, noise_db=None, unit=unit)
        peak_db = 10 * math.log10(peak * factor)
        noise_db = 10 * math.log10(noise * factor) if noise else None
        if noise_db is None or noise_db < peak_db - 2 * MAX_SPAN_DB:
            noise_db, low_db = None, peak_db - WITHOUT_NOISE_DB
        else:
            low_db = noise_db - BELOW_NOISE_DB
        low_db = TICK_DB * math.floor(low_db / TICK_DB)
        high_db = max(peak_db, low_db + BELOW_NOISE_DB + MIN_ABOVE_NOISE_DB)
        high_db = TICK_DB * math.ceil(min(high_db, low_db + MAX_SPAN_DB) / TICK_DB)
        return cls(factor=factor, low_db=low_db, high_db=high_db, noise_db=noise_db, unit=unit)

    def decibels(self, power: Float[Array, "*any"]) -> Float[Array, "*any"]:
        """Power in squared units of the cube as decibels, at least `low_db`; nan stays nan."""
        least = 10 ** (self.low_db / 10) / self.factor
        return 10 * np.log10(np.maximum(np.asarray(power, np.float64), least) * self.factor)

    def draw(self, axes: "Axes", power_db: Float[Array, "y x"], extent: Extent) -> "AxesImage":
        """Draws decibels (y, x), the first row at the bottom, each cell in one colour, with fixed limits.

        Args:
            axes: Where to draw.
            power_db: Power (y, x) in dB.
            extent: Left, right, bottom and top edge, in units of the axes.
        """
        image = axes.imshow(
            power_db,
            origin="lower",
            aspect="auto",
            extent=extent,
            cmap=POWER_MAP,
            vmin=self.low_db,
            vmax=self.high_db,
            interpolation="nearest",
        )
        axes.autoscale(False)
        return image

    def bar(self, axes: "Axes", *, share: float = 1.0) -> None:
        """The colour bar of the scale, with the noise marked; `share` as in `colour_bar`."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        mark = None if self.noise_db is None else (self.noise_db, "noise")
        mappable = ScalarMappable(Normalize(self.low_db, self.high_db), POWER_MAP)
        colour_bar(axes, mappable, self.unit, mark=mark, share=share)
