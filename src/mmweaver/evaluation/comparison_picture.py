"""A comparison as one page: maps of A above those of B on common axes and decibels, and what distinguishes B from A."""

from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.viz.theme import INK, POWER_MAP, STYLE, colour_bar, label_axes, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mmweaver.evaluation.compare_signals import Comparison

DPI = 100
SPAN_DB = 60.0
COLOURS = ("#0b7da3", "#c2431c")  # A, B
MAX_BARS = 14
MAX_EFFECT, LABELS_AT = 10.0, -33.0  # limit of the bars; position of the labels to their left
NEAREST_M = 0.5  # excludes leakage from the colour scale
# map, title, horizontal axis, reason if it is missing
PANELS = (
    (
        "range_doppler",
        "range-Doppler, mean of the frames",
        "radial velocity (m/s), away +",
        "one side has too few loops per frame",
    ),
    (
        "range_azimuth",
        "range-azimuth, mean of the frames",
        "azimuth (degrees), right +",
        "one side has a row of fewer than three antennas",
    ),
    ("moving", "movement over the frames", "frame", "one side has too few loops per frame"),
)


def draw_comparison(comparison: "Comparison", path: Path) -> None:
    """Draws a comparison as PNG.

    Args:
        comparison: The comparison.
        path: The file.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(16.0, 13.0), dpi=DPI, facecolor="white")
        places = figure.add_gridspec(3, 3, left=0.06, right=0.94, bottom=0.06, top=0.9, wspace=0.42, hspace=0.34)
        names = [shortened(f"{letter}: {side.name}", 110) for letter, side in zip("AB", comparison.sides, strict=True)]
        figure.suptitle("\n".join(names), x=0.04, y=0.975, ha="left", va="top", fontsize=13, fontweight="bold")
        for row, column in product(range(2), range(3)):
            _map(figure.add_subplot(places[row, column]), comparison, row, PANELS[column])
        _profiles(figure.add_subplot(places[2, 0]), comparison)
        _clouds(figure.add_subplot(places[2, 1]), comparison)
        _effects(figure.add_subplot(places[2, 2]), comparison)
        FigureCanvasAgg(figure).print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


def _map(axes: "Axes", comparison: "Comparison", side: int, panel: tuple[str, str, str, str]) -> None:
    """Draws one map of one side on the decibel scale of both."""
    name, title, label, missing = panel
    title, common = f"{'AB'[side]}: {title}", comparison.axes
    if name not in comparison.maps[side]:
        axes.set(xticks=[], yticks=[])
        axes.set_title(title)
        axes.text(0.5, 0.5, f"cannot be shown: {missing}", transform=axes.transAxes, ha="center", va="center", size=9)
        return
    power_db, range_m = comparison.maps[side][name], common.range_m
    across = {"range_doppler": common.radial_velocity_mps, "range_azimuth": common.azimuth_deg}.get(name)
    across = np.array([0.5, power_db.shape[1] + 0.5]) if across is None else across
    far = range_m >= min(NEAREST_M, float(range_m[-2]))
    top = max(float(maps[name][far].max()) for maps in comparison.maps)
    image = axes.imshow(
        power_db,
        origin="lower",
        aspect="auto",
        cmap=POWER_MAP,
        vmin=top - SPAN_DB,
        vmax=top,
        interpolation="nearest",
        extent=(across[0], across[-1], range_m[0], range_m[-1]),
    )
    colour_bar(axes, image, common.reference)
    label_axes(axes, title, label, "range (m)")


def _profiles(axes: "Axes", comparison: "Comparison") -> None:
    range_m = comparison.axes.range_m
    for letter, maps, colour in zip("AB", comparison.maps, COLOURS, strict=True):
        axes.plot(range_m, maps["range_profile"], color=colour, linewidth=1.3, label=letter)
    axes.margins(x=0)
    label_axes(axes, "Static clutter along range", "range (m)", comparison.axes.reference, grid=True)
    axes.legend()


def _clouds(axes: "Axes", comparison: "Comparison") -> None:
    far_m = float(comparison.axes.range_m[-1])
    for letter, cloud, colour in zip("AB", comparison.clouds, COLOURS, strict=True):
        axes.plot(
            cloud.x_m, cloud.y_m, ".", color=colour, markersize=3, alpha=0.35, label=f"{letter}: {len(cloud.frame)}"
        )
    axes.plot(0, 0, "^", color=INK, markersize=7)
    axes.set(xlim=(-0.7 * far_m, 0.7 * far_m), ylim=(0, far_m))
    label_axes(axes, "Points of all frames from above", "right of the radar (m)", "away (m)")
    axes.legend(markerscale=0)


def _effects(axes: "Axes", comparison: "Comparison") -> None:
    """Draws effect sizes as bars with intervals, the largest at the top, clipped at ten."""
    shown = comparison.ranked[:MAX_BARS]
    for at, one in enumerate(shown):
        assert one.difference is not None
        place, effect = len(shown) - 1 - at, one.difference
        size, *interval = np.clip([effect.effect_size, *(effect.effect_interval_95 or ())], -MAX_EFFECT, MAX_EFFECT)
        axes.barh(place, size, height=0.62, color=COLOURS[1] if one.gives_away else "#b8bec5")
        axes.plot(interval, [place] * len(interval), color=INK, linewidth=1.2)
        axes.text(LABELS_AT + 0.6, place, one.feature.title, ha="left", va="center", fontsize=7)
    axes.axvline(0, color=INK, linewidth=0.7)
    for edge in (-1, 1):
        axes.axvline(edge, color=INK, linewidth=0.6, linestyle=":")
    axes.set(
        xlim=(LABELS_AT, MAX_EFFECT * 1.1),
        ylim=(-0.7, max(len(shown), 1) - 0.3),
        yticks=[],
        xticks=[-10, -5, 0, 5, 10],
    )
    axes.set_title("What separates A and B: effect size (red: interval beyond 1)")
    axes.set_xlabel("B - A, in spreads")
