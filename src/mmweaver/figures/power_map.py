"""A map of radar power in decibels, and its colour bar."""

from typing import TYPE_CHECKING

import numpy as np

from mmweaver.figures.power_scale import PowerScale
from mmweaver.figures.theme import POWER_MAP, colour_bar

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Extent = tuple[float, float, float, float]  # left, right, bottom, top, in units of the axes


def draw_power_map(axes: "Axes", scale: PowerScale, power_db: np.ndarray, extent: Extent) -> None:
    """Draws decibels (y, x), the first row at the bottom, each cell in one colour."""
    axes.imshow(
        power_db, origin="lower", aspect="auto", extent=extent, cmap=POWER_MAP, vmin=scale.low_db, vmax=scale.high_db,
        interpolation="nearest",
    )  # fmt: skip


def scale_bar(axes: "Axes", scale: PowerScale, *, share: float = 1.0) -> None:
    """The colour bar of a scale of decibels; `share` as in `colour_bar`."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    mappable = ScalarMappable(norm=Normalize(scale.low_db, scale.high_db), cmap=matplotlib.colormaps[POWER_MAP])
    mark = None if scale.noise_db is None else (scale.noise_db, "noise")
    colour_bar(axes, mappable, scale.unit, mark=mark, share=share)
