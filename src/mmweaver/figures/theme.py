"""Common style of all figures: colour maps for power, time and radial velocity."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Colormap
    from matplotlib.transforms import Transform

POWER_MAP = "inferno"
TIME_MAP = "viridis"
VELOCITY_MAP = "coolwarm"
CLEARANCE = 0.045  # of a colour bar, that its mark keeps from ticks

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
    "text.parse_math": False,  # a name from a file may hold a $
    "axes.labelcolor": INK,
    "xtick.color": INK,
    "ytick.color": INK,
}


_AS_IT_IS: Any = {"scalex": False, "scaley": False}  # the limits stay
_TICK: Any = {"color": INK, "linestyle": "", "markersize": 3, "markeredgewidth": 0.7, "clip_on": False, **_AS_IT_IS}
_GRID: Any = {"color": "#d8dce0", "linewidth": 0.5, "zorder": 0.5, **_AS_IT_IS}


def label_axes(
    axes: "Axes", title: str, x_label: str, y_label: str, *, y_label_pt: float = 26.0, grid: bool = False
) -> None:
    """Title at the upper left, ticks for the limits as they are now, and axis labels at fixed positions.

    Drawn from primitives: matplotlib's own ticks take three times as long, and automatic layout doubles the time.
    """
    from matplotlib.markers import TICKDOWN, TICKLEFT

    axes.set_title(title, y=1.0)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    along_x, along_y = axes.get_xaxis_transform(), axes.get_yaxis_transform()
    across, up = tick_labels(*axes.get_xlim()), tick_labels(*axes.get_ylim())
    for axis, place, shift_pt in ((axes.xaxis, (0.5, 0.0), (0.0, -18.0)), (axes.yaxis, (0.0, 0.5), (-y_label_pt, 0.0))):
        axis.set_ticks([])
        axis.set_label_coords(*place, transform=_shifted(axes, axes.transAxes, *shift_pt))
    axes.plot([*across], [0] * len(across), marker=TICKDOWN, transform=along_x, **_TICK)
    axes.plot([0] * len(up), [*up], marker=TICKLEFT, transform=along_y, **_TICK)
    below, left = _shifted(axes, along_x, 0.0, -5.0), _shifted(axes, along_y, -5.0, 0.0)
    for number, text in across.items():
        axes.text(number, 0, text, transform=below, fontsize=8, ha="center", va="top")
    for number, text in up.items():
        axes.text(0, number, text, transform=left, fontsize=8, ha="right", va="center_baseline")
    if grid:
        axes.plot(*_lines(across), transform=along_x, **_GRID)
        axes.plot(*reversed(_lines(up)), transform=along_y, **_GRID)


def _lines(places: Iterable[float]) -> tuple[np.ndarray, np.ndarray]:
    """Lines from 0 to 1 at some places, as one polyline with gaps: the places and the share of the way."""
    at = np.repeat(np.array([*places], float), 3)
    return at, np.resize([0.0, 1.0, np.nan], len(at))


def tick_labels(low: float, high: float, most: int = 5) -> dict[float, str]:
    """Round numbers from low to high, at most `most` steps, and how they are written.

    >>> tick_labels(-50.0, 0.0)
    {-50.0: '\u221250', -40.0: '\u221240', -30.0: '\u221230', -20.0: '\u221220', -10.0: '\u221210', 0.0: '0'}
    """
    from matplotlib.ticker import MaxNLocator

    low, high = min(low, high), max(low, high)
    ticks = [float(tick) for tick in MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(low, high)]
    ticks = [tick for tick in ticks if low <= tick <= high]
    decimals = max((-int(np.floor(np.log10(step) + 1e-9)) for step in np.diff(ticks)[:1]), default=0)
    return {tick: f"{tick:.{max(decimals, 0)}f}".replace("-", "\u2212") for tick in ticks}


def _shifted(axes: "Axes", place: "Transform", right_pt: float, up_pt: float) -> "Transform":
    """A transform that moves what is drawn by some points."""
    from matplotlib.transforms import ScaledTranslation

    figure = axes.get_figure(root=True)
    assert figure is not None
    return place + ScaledTranslation(right_pt / 72, up_pt / 72, figure.dpi_scale_trans)


def colour_bar(
    axes: "Axes", mappable: "ScalarMappable", label: str, *, mark: tuple[float, str] | None = None, share: float = 1.0
) -> None:
    """A thin colour bar at the right of the axes, without resizing them; `mark`: a value with a name of its own.

    `share`: width relative to the usual, of axes that are wider than others.

    Drawn from primitives: matplotlib's own colour bar, with separate axes, takes five times as long.
    """
    from matplotlib.markers import TICKRIGHT

    left, right = 1 + 0.02 * share, 1 + 0.055 * share
    low, high = (float(np.asarray(limit)) for limit in (mappable.norm.vmin, mappable.norm.vmax))
    limits = {"xlim": axes.get_xlim(), "ylim": axes.get_ylim(), "aspect": axes.get_aspect()}
    axes.imshow(
        mappable.cmap(np.linspace(0, 1, 256))[:, None], extent=(left, right, 0, 1), transform=axes.transAxes,
        origin="lower", clip_on=False,
    )  # fmt: skip
    axes.set(**limits)  # imshow changed them
    ticks = tick_labels(low, high)
    if mark is not None:
        value, name = mark
        ticks = {tick: text for tick, text in ticks.items() if abs(tick - value) > CLEARANCE * (high - low)}
        ticks[value] = name
    heights = [(tick - low) / (high - low) for tick in ticks]
    line: Any = {"color": INK, "transform": axes.transAxes, "clip_on": False, **_AS_IT_IS}
    axes.plot([left, left, right, right, left], [0, 1, 1, 0, 0], linewidth=0.5, **line)
    axes.plot([right] * len(ticks), heights, **{**_TICK, **line}, marker=TICKRIGHT)
    for text, height in zip(ticks.values(), heights, strict=True):
        place = _shifted(axes, axes.transAxes, 4.0, 0.0)
        axes.text(right, height, text, transform=place, fontsize=7, va="center_baseline")
    label_place = _shifted(axes, axes.transAxes, 28.0, 0.0)
    axes.text(right, 0.5, label, transform=label_place, fontsize=8, rotation=90, va="center", ha="left")


def time_bar(axes: "Axes", colours: "Colormap", low_s: float, high_s: float) -> None:
    """A small bar at the lower left within the axes, from a first to a last time."""
    left, right, bottom, top = 0.02, 0.22, 0.035, 0.055
    limits = {"xlim": axes.get_xlim(), "ylim": axes.get_ylim(), "aspect": axes.get_aspect()}
    ground: Any = {"facecolor": PAPER, "edgecolor": "none", "alpha": 0.75, "pad": 2.0}
    place: Any = {"transform": axes.transAxes, "fontsize": 8, "va": "bottom", "bbox": ground}
    axes.text(left, top + 0.015, f"{low_s:.1f} to {high_s:.1f} s", ha="left", **place)
    axes.imshow(
        colours(np.linspace(0, 1, 128))[None], extent=(left, right, bottom, top), transform=axes.transAxes,
        origin="lower", zorder=3,
    )  # fmt: skip
    axes.set(**limits)


def legend(axes: "Axes", entries: list[tuple[str, str]]) -> None:
    """Names in their colours at the upper right within the axes, one below the other."""
    for line, (name, colour) in enumerate(entries):
        place = _shifted(axes, axes.transAxes, -4.0, -4.0 - 10.0 * line)
        axes.text(1.0, 1.0, name, color=colour, transform=place, fontsize=8, ha="right", va="top")


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
