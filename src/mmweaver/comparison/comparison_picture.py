"""A comparison as one page: maps of A over those of B on the same axes and decibels, and what tells B from A."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.comparison.common_axes import SignalMaps
from mmweaver.figures.theme import INK, POWER_MAP, STYLE, colour_bar, label_axes, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mmweaver.comparison.compare_signals import Comparison

DPI = 100
SPAN_DB = 60.0
COLOURS = ("#0b7da3", "#c2431c")  # A, B
MOST_BARS = 14
WIDEST_EFFECT, LABELS_AT = 10.0, -33.0  # of the bars; labels stand at the left
NEAREST_M = 0.5  # leakage would set the scale of everything else
NONE_LEFT = "cannot be shown: "


def draw_comparison(comparison: "Comparison", path: Path) -> None:
    """Writes the page as PNG."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(16.0, 13.0), dpi=DPI, facecolor="white")
        places = figure.add_gridspec(3, 3, left=0.06, right=0.94, bottom=0.06, top=0.9, wspace=0.42, hspace=0.34)
        names = [shortened(f"{letter}: {side.name}", 110) for letter, side in zip("AB", comparison.sides, strict=True)]
        figure.suptitle("\n".join(names), x=0.04, y=0.975, ha="left", va="top", fontsize=13, fontweight="bold")
        for row, (letter, maps) in enumerate(zip("AB", comparison.maps, strict=True)):
            for column, panel in enumerate((_doppler, _azimuth, _moving)):
                panel(figure.add_subplot(places[row, column]), comparison, letter, maps)
        _profiles(figure.add_subplot(places[2, 0]), comparison)
        _clouds(figure.add_subplot(places[2, 1]), comparison)
        _effects(figure.add_subplot(places[2, 2]), comparison)
        FigureCanvasAgg(figure).print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


def _doppler(axes: "Axes", comparison: "Comparison", letter: str, maps: SignalMaps) -> None:
    velocity = comparison.axes.radial_velocity_mps
    own = [one.range_doppler_db for one in comparison.maps]
    title = f"{letter}: range-Doppler, mean of the frames"
    if velocity is None or maps.range_doppler_db is None:
        _nothing(axes, title, "one side has too few loops a frame")
        return
    _image(axes, comparison, maps.range_doppler_db, (float(velocity[0]), float(velocity[-1])), own)
    label_axes(axes, title, "radial velocity (m/s), away +", "range (m)")


def _azimuth(axes: "Axes", comparison: "Comparison", letter: str, maps: SignalMaps) -> None:
    azimuth = comparison.axes.azimuth_rad
    own = [one.range_azimuth_db for one in comparison.maps]
    title = f"{letter}: range-azimuth, mean of the frames"
    if azimuth is None or maps.range_azimuth_db is None:
        _nothing(axes, title, "one side has a row of fewer than three antennas")
        return
    _image(axes, comparison, maps.range_azimuth_db, tuple(np.degrees(azimuth[[0, -1]]).tolist()), own)
    label_axes(axes, title, "azimuth (degrees), right +", "range (m)")


def _moving(axes: "Axes", comparison: "Comparison", letter: str, maps: SignalMaps) -> None:
    own = [None if one.moving_over_time_db is None else one.moving_over_time_db.T for one in comparison.maps]
    title = f"{letter}: movement over the frames"
    if maps.moving_over_time_db is None:
        _nothing(axes, title, "one side has too few loops a frame")
        return
    frames = len(maps.moving_over_time_db)
    _image(axes, comparison, maps.moving_over_time_db.T, (0.5, frames + 0.5), own)
    label_axes(axes, title, "frame", "range (m)")


def _image(
    axes: "Axes", comparison: "Comparison", level: np.ndarray, across: tuple[float, ...], both: list[Any]
) -> None:  # fmt: skip
    """A map (range, across) in the decibels of both sides."""
    range_m = comparison.axes.range_m
    far = range_m >= min(NEAREST_M, float(range_m[-2]))
    top = max(float(one[far].max()) for one in both if one is not None)
    image = axes.imshow(
        level, origin="lower", aspect="auto", cmap=POWER_MAP, vmin=top - SPAN_DB, vmax=top, interpolation="nearest",
        extent=(across[0], across[1], float(range_m[0]), float(range_m[-1])),
    )  # fmt: skip
    colour_bar(axes, image, comparison.axes.reference)


def _profiles(axes: "Axes", comparison: "Comparison") -> None:
    range_m = comparison.axes.range_m
    for letter, maps, colour in zip("AB", comparison.maps, COLOURS, strict=True):
        axes.plot(range_m, maps.range_profile_db, color=colour, linewidth=1.3, label=letter)
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
    """Bars with intervals, the largest at the top; the scale ends at ten."""
    shown = comparison.ranked[:MOST_BARS]
    for at, one in enumerate(shown):
        assert one.difference is not None
        place = len(shown) - 1 - at
        size = float(np.clip(one.difference.effect_size, -WIDEST_EFFECT, WIDEST_EFFECT))
        axes.barh(place, size, height=0.62, color=COLOURS[1] if one.gives_away else "#b8bec5")
        if one.difference.effect_interval_95 is not None:
            low, high = np.clip(one.difference.effect_interval_95, -WIDEST_EFFECT, WIDEST_EFFECT)
            axes.plot([low, high], [place, place], color=INK, linewidth=1.2)
        axes.text(LABELS_AT + 0.6, place, one.feature.title, ha="left", va="center", fontsize=7)
    axes.axvline(0, color=INK, linewidth=0.7)
    for edge in (-1, 1):
        axes.axvline(edge, color=INK, linewidth=0.6, linestyle=":")
    axes.set(
        xlim=(LABELS_AT, WIDEST_EFFECT * 1.1),
        ylim=(-0.7, max(len(shown), 1) - 0.3),
        yticks=[],
        xticks=[-10, -5, 0, 5, 10],
    )
    axes.set_title("What gives B away: effect size (red: interval beyond 1)")
    axes.set_xlabel("B less A, in spreads")


def _nothing(axes: "Axes", title: str, why: str) -> None:
    axes.set(xticks=[], yticks=[])
    axes.set_title(title)
    axes.text(0.5, 0.5, f"{NONE_LEFT}{why}", transform=axes.transAxes, ha="center", va="center", fontsize=9)
