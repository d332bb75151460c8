"""Common style of all figures: colour maps for power, time and radial velocity."""

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from matplotlib.transforms import Transform

POWER_MAP = "inferno"
TIME_MAP = "viridis"
VELOCITY_MAP = "coolwarm"
SPAN_DB = 50.0  # dynamic range of power maps

INK = "#22262b"
PAPER = "#ffffff"
_BEYOND_FONT = 0x2E80
GROUND_TRUTH = "#7fe3ff"  # colour of the skeleton drawn over radar maps
# Colours of several people: bright over power maps and photos, dark on white.
PEOPLE = (GROUND_TRUTH, "#8dff7a", "#ff9df2", "#ffffff", "#ffd24d", "#b3a6ff", "#5dffd0", "#ff8f70")
PEOPLE_ON_WHITE = ("#0b7da3", "#1f8a0f", "#b02fa0", "#5b6168", "#a07400", "#5b48c9", "#00856a", "#c2431c")

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.titlepad": 6.0,
    "axes.labelsize": 9.0,
    "axes.labelpad": 2.0,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.7,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.width": 0.7,
    "ytick.major.width": 0.7,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "text.color": INK,
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


def label_axes(axes: "Axes", title: str, x_label: str, y_label: str, *, y_label_pt: float = 26.0) -> None:
    """Title at the upper left and axis labels, at fixed positions: automatic layout doubles the time."""
    from matplotlib.transforms import ScaledTranslation

    axes.set_title(title, y=1.0)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    for axis, place, shift_pt in ((axes.xaxis, (0.5, 0.0), (0, -18)), (axes.yaxis, (0.0, 0.5), (-y_label_pt, 0))):
        shift = ScaledTranslation(shift_pt[0] / 72, shift_pt[1] / 72, _root(axes).dpi_scale_trans)
        axis.set_label_coords(*place, transform=axes.transAxes + shift)


def _root(axes: "Axes") -> "Figure":
    figure = axes.get_figure(root=True)
    assert figure is not None
    return figure


def colour_bar(axes: "Axes", mappable: "ScalarMappable", label: str) -> None:
    """A thin colour bar at the right of the axes, without resizing them.

    Drawn from primitives: matplotlib's own colour bar, with separate axes, takes five times as long.
    """
    from matplotlib.markers import TICKRIGHT
    from matplotlib.ticker import MaxNLocator
    from matplotlib.transforms import ScaledTranslation

    left, right = 1.02, 1.055
    low, high = (float(np.asarray(limit)) for limit in (mappable.norm.vmin, mappable.norm.vmax))
    limits = {"xlim": axes.get_xlim(), "ylim": axes.get_ylim(), "aspect": axes.get_aspect()}
    axes.imshow(
        mappable.cmap(np.linspace(0, 1, 256))[:, None], extent=(left, right, 0, 1), transform=axes.transAxes,
        origin="lower", clip_on=False,
    )  # fmt: skip
    axes.set(**limits)  # imshow changed them
    ticks = [tick for tick in MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high) if low <= tick <= high]
    heights = [(tick - low) / (high - low) for tick in ticks]
    line: Any = {"color": INK, "linewidth": 0.5, "transform": axes.transAxes, "clip_on": False, "scalex": False}
    axes.plot([left, left, right, right, left], [0, 1, 1, 0, 0], **line, scaley=False)
    axes.plot([right] * len(ticks), heights, TICKRIGHT, markersize=2, markeredgewidth=0.5, **line, scaley=False)

    def shifted(points: float) -> "Transform":
        return axes.transAxes + ScaledTranslation(points / 72, 0, _root(axes).dpi_scale_trans)

    decimals = max((-int(np.floor(np.log10(step) + 1e-9)) for step in np.diff(ticks)[:1]), default=0)
    for tick, height in zip(ticks, heights, strict=True):
        number = f"{tick:.{max(decimals, 0)}f}".replace("-", "\u2212")
        axes.text(right, height, number, transform=shifted(4.0), fontsize=7, va="center_baseline")
    axes.text(right, 0.5, label, transform=shifted(25.0), fontsize=8, rotation=90, va="center", ha="left")


def person_colour(index: int, count: int, *, on_white: bool = False) -> str:
    """The colour of a person; a single person has the standard one.

    >>> person_colour(0, 1) == GROUND_TRUTH, person_colour(0, 1, on_white=True) == INK
    (True, True)
    """
    if on_white:
        return INK if count == 1 else PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
    return PEOPLE[index % len(PEOPLE)]


def shortened(text: str, most: int) -> str:
    """Text of at most `most` characters, without glyphs missing in the font (emoji and the like).

    >>> shortened("a person walks", 10)
    'a perso...'
    >>> shortened("a person waves \U0001f44b", 20)
    'a person waves '
    """
    text = "".join(character for character in text if ord(character) < _BEYOND_FONT)
    return text if len(text) <= most else text[: most - 3] + "..."
