"""preview.png: one page of radar maps and points with, where known, the photo and the ground truth.

All panels of power share one scale of decibels (`figures.power_scale`). What has no meaning for a signal is replaced: a
single frame has profiles in place of strips over time, slow movement is shown over frames, and only arrays that resolve
elevation have a map of it.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.photo_panel import draw_photo
from mmweaver.figures.point_panels import draw_points_side, draw_points_top, velocity_bar
from mmweaver.figures.power_panels import (
    draw_azimuth_moving,
    draw_azimuth_profile,
    draw_azimuth_with_clutter,
    draw_displacement,
    draw_elevation,
    draw_micro_doppler,
    draw_range_doppler,
    draw_range_profile,
    draw_range_time,
    draw_slow_doppler,
    draw_velocity_profile,
    power_bar,
)
from mmweaver.figures.theme import STYLE, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Panel = Callable[[Axes, FigureData], None]

DPI = 100


def draw_preview(view: FigureData, path: Path) -> None:
    """Writes the page as a PNG, 1600 pixels wide; 900 high with a photo, 700 without."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    with matplotlib.rc_context(STYLE):
        canvas = FigureCanvasAgg(preview_figure(view))
        canvas.print_png(path, metadata={"Software": "mmWeaver"}, pil_kwargs={"compress_level": 2})


def preview_figure(view: FigureData) -> "Figure":
    """The page as a figure of matplotlib."""
    import matplotlib
    from matplotlib.figure import Figure

    with matplotlib.rc_context(STYLE):
        photo = view.aligned is not None
        figure = Figure(figsize=(16.0, 9.0 if photo else 7.0), dpi=DPI, facecolor="white")
        figure.suptitle(
            shortened(view.heading, 150), x=0.04, y=0.98, ha="left", va="top", fontsize=13, fontweight="bold"
        )
        rows = [*_power_rows(view), [draw_azimuth_with_clutter, draw_azimuth_moving, draw_points_top, draw_points_side]]
        places = figure.add_gridspec(
            len(rows), 4, left=0.04, right=0.935, bottom=0.075, top=0.895 if photo else 0.87, wspace=0.27, hspace=0.4,
            height_ratios=(*([1.0] * (len(rows) - 1)), 0.85),
        )  # fmt: skip
        if photo:
            draw_photo(figure.add_subplot(places[0:2, 0:2]), view)
        for row, panels in enumerate(rows):
            axes = [figure.add_subplot(places[row, 4 - len(panels) + at]) for at in range(len(panels))]
            for drawer, own in zip(panels, axes, strict=True):
                drawer(own, view)
            bar = velocity_bar if row == len(rows) - 1 else power_bar
            bar(axes[-1], view)
    return figure


def _power_rows(view: FigureData) -> "list[list[Panel]]":
    """The four panels above the last row: in one row, or next to the photo in two."""
    over_time: list[Panel]
    maps: list[Panel]
    if view.is_single:
        over_time = [draw_range_profile, draw_velocity_profile]
        maps = [draw_range_doppler, draw_elevation if view.resolves_elevation else draw_azimuth_profile]
    else:
        over_time = [draw_range_time, draw_displacement if view.is_slow else draw_micro_doppler]
        maps = [
            draw_slow_doppler if view.is_slow else draw_range_doppler,
            draw_elevation if view.resolves_elevation else draw_range_profile,
        ]
    return [[*over_time, *maps]] if view.aligned is None else [over_time, maps]
