"""preview.png: one page of radar maps and points with, where known, the photo and the ground truth.

All panels of power share one scale of decibels (`viz.power_scale`). Panels without meaning for a signal are replaced: a
single frame has profiles in place of strips over time, slow motion is shown over frames, and only arrays that resolve
elevation have an elevation map.

The pictures of a folder of results, by file name.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from mmweaver.core.virtual_array import resolves_elevation
from mmweaver.viz import panels
from mmweaver.viz.animation import draw_animation
from mmweaver.viz.figure_data import FigureData
from mmweaver.viz.theme import page

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    Panel = Callable[[Axes, FigureData], None]


def draw_preview(view: FigureData, path: Path | None) -> "Figure":
    """Draws the page, 1600 pixels wide; 900 high with a photo, 700 without.

    Args:
        view: The data to show.
        path: PNG to write; None writes no file.

    Returns:
        The page as a matplotlib figure.
    """
    photo = view.aligned is not None
    with page(path, view.heading, 16.0, 9.0 if photo else 7.0) as figure:
        rows = [*_power_rows(view), _LAST_ROW]
        places = figure.add_gridspec(
            len(rows),
            4,
            left=0.04,
            right=0.935,
            bottom=0.075,
            top=0.895 if photo else 0.87,
            wspace=0.27,
            hspace=0.4,
            height_ratios=(*([1.0] * (len(rows) - 1)), 0.85),
        )
        if photo:
            panels.draw_photo(figure.add_subplot(places[0:2, 0:2]), view)
        for row, drawers in enumerate(rows):
            for column, drawer in enumerate(drawers, 4 - len(drawers)):
                axes = figure.add_subplot(places[row, column])
                drawer(axes, view)
            (panels.velocity_bar if drawers is _LAST_ROW else panels.power_bar)(axes, view)
    return figure


_LAST_ROW: "list[Panel]" = [
    panels.draw_azimuth_with_clutter,
    panels.draw_azimuth_moving,
    panels.draw_points_top,
    panels.draw_points_side,
]


def _power_rows(view: FigureData) -> "list[list[Panel]]":
    """The four panels above the last row: in one row, or next to the photo in two."""
    rows: list[list[Panel]]
    if view.is_single:
        rows = [[panels.draw_range_profile, panels.draw_velocity_profile], [panels.draw_range_doppler]]
        other: Panel = panels.draw_azimuth_profile
    else:
        rows = [[panels.draw_range_time, panels.draw_micro_doppler], [panels.draw_range_doppler]]
        if view.is_slow:
            rows = [[panels.draw_range_time, _draw_displacement], [_draw_slow_doppler]]
        other = panels.draw_range_profile
    rows[1].append(panels.draw_elevation if resolves_elevation(view.cube.config) else other)
    return rows if view.aligned is not None else [rows[0] + rows[1]]


def _draw_displacement(axes: "Axes", view: FigureData) -> None:
    panels.draw_displacement(axes, view.cube.grid.frame_time_s, view.slow_cells)


def _draw_slow_doppler(axes: "Axes", view: FigureData) -> None:
    panels.draw_slow_doppler(axes, view.scale, *view.slow_doppler, view.range_edges_m)


PREVIEWS = {"preview.png": draw_preview, "preview.gif": draw_animation}
