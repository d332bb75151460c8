"""Common style of all figures: colour maps, ticks, colour bars, notes, and the writing of pages.

One scale of decibels, including the noise level, for all pictures of a cube: an echo has the same colour in each.
"""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.shapes import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage
    from matplotlib.ticker import MaxNLocator


POWER_MAP, TIME_MAP, VELOCITY_MAP = "inferno", "viridis", "coolwarm"
INK, PAPER = "#22262b", "#ffffff"
GROUND_TRUTH = "#7fe3ff"  # colour of the skeleton drawn over radar maps
# Colours of several people: bright over power maps and photos, dark on white.
PEOPLE = (GROUND_TRUTH, "#8dff7a", "#ff9df2", "#ffffff", "#ffd24d", "#b3a6ff", "#5dffd0", "#ff8f70")
PEOPLE_ON_WHITE = ("#0b7da3", "#1f8a0f", "#b02fa0", "#5b6168", "#a07400", "#5b48c9", "#00856a", "#c2431c")
CLEARANCE = 0.045  # distance between mark and ticks, as a share of a colour bar
_BEYOND_FONT = 0x2E80
_CORNERS = {"lower right": (0.98, 0.02), "upper right": (0.98, 0.97), "upper left": (0.02, 0.97)}

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "figure.facecolor": PAPER,
    "figure.dpi": 100,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.titlepad": 6.0,
    "axes.titley": 1.0,
    "axes.labelsize": 9.0,
    "axes.labelpad": 2.0,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.7,
    "axes.labelcolor": INK,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "xtick.color": INK,
    "ytick.color": INK,
    "grid.color": "#d8dce0",
    "grid.linewidth": 0.5,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.loc": "upper right",
    "legend.labelcolor": "linecolor",
    "legend.handlelength": 0.0,
    "legend.handletextpad": 0.2,
    "legend.borderaxespad": 0.2,
    "legend.labelspacing": 0.2,
    "text.color": INK,
    "text.parse_math": False,  # a name from a file may hold a $
}


def label_axes(axes: "Axes", title: str, x_label: str, y_label: str, *, grid: bool = False) -> None:
    """Title at the upper left, axis labels, and ticks at round numbers.

    Args:
        axes: The axes.
        title: Title.
        x_label: Quantity and unit of the x axis.
        y_label: Quantity and unit of the y axis.
        grid: Whether a grid is drawn.
    """
    axes.set(title=title, xlabel=x_label, ylabel=y_label)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(_round_numbers())
    axes.grid(grid)


def _round_numbers() -> "MaxNLocator":
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(5, steps=[1, 2, 5, 10])


def colour_bar(
    axes: "Axes", mappable: "ScalarMappable", label: str, *, mark: tuple[float, str] | None = None, share: float = 1.0
) -> None:
    """A thin colour bar at the right of the axes, without resizing them.

    Args:
        axes: Axes that it belongs to.
        mappable: Colours and limits.
        label: Quantity and unit.
        mark: A value with a name, which replaces ticks near it.
        share: Relative width, for axes that are wider than others.
    """
    place = axes.inset_axes((1 + 0.02 * share, 0.0, 0.035 * share, 1.0))
    bar = axes.figure.colorbar(mappable, cax=place, ticks=_round_numbers())
    bar.set_label(label, fontsize=8)
    place.tick_params(labelsize=7)
    if mark is not None:
        low, high = place.get_ylim()
        ticks = {tick: f"{tick:g}".replace("-", "\u2212") for tick in bar.get_ticks() if low <= tick <= high}
        kept = {tick: text for tick, text in ticks.items() if abs(tick - mark[0]) > CLEARANCE * (high - low)}
        bar.set_ticks([*kept, mark[0]], labels=[*kept.values(), mark[1]])


def note(axes: "Axes", text: str, corner: str = "lower right") -> None:
    """A small text: bright at the lower right of a map, dark in an upper corner outside a fan."""
    place, (vertical, horizontal) = _CORNERS[corner], corner.split()
    colour, ground = (GROUND_TRUTH, "black") if vertical == "lower" else (INK, PAPER)
    axes.text(
        *place,
        text,
        transform=axes.transAxes,
        ha=horizontal,
        va="bottom" if vertical == "lower" else "top",
        fontsize=7.5,
        color=colour,
        bbox={"facecolor": ground, "edgecolor": "none", "alpha": 0.6, "pad": 1.0},
    )


def person_colour(index: int, count: int, *, on_white: bool = False) -> str:
    """The colour of a person; a single person has the standard one.

    >>> person_colour(0, 1) == GROUND_TRUTH, person_colour(0, 1, on_white=True) == INK
    (True, True)
    """
    if on_white and count == 1:
        return INK
    return (PEOPLE_ON_WHITE if on_white else PEOPLE)[index % len(PEOPLE)]


def shortened(text: str, length: int) -> str:
    """Text of at most `length` characters, without glyphs missing in the font (emoji and the like).

    >>> shortened("a person walks", 10)
    'a perso...'
    >>> shortened("a person waves \U0001f44b", 20)
    'a person waves '
    """
    text = "".join(character for character in text if ord(character) < _BEYOND_FONT)
    return text if len(text) <= length else text[: length - 3] + "..."


@contextmanager
def page(path: Path | None, title: str, width: float, height: float) -> Iterator["Figure"]:
    """A figure in the common style, written as PNG on exit.

    Args:
        path: The PNG; None writes no file.
        title: Title at the upper left.
        width, height: Size in inches.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(width, height))
        canvas = FigureCanvasAgg(figure)
        place: Any = {"x": 0.64 / width, "y": 1 - 0.2 / height, "ha": "left", "va": "top"}
        figure.suptitle(shortened(title, int(9.5 * width)), **place, fontsize=13, fontweight="bold")
        yield figure
        if path is not None:
            canvas.print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


def evenly_spaced(count: int, most: int) -> np.ndarray:
    """At most `most` of `count` indices, evenly spaced, including the first and the last.

    >>> evenly_spaced(10, 4)
    array([0, 3, 6, 9])
    """
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


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
