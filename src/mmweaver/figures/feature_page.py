"""Pictures of features: the arrays of `mmweaver.dsp.features` with their axes, on one scale of decibels."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.virtual_array import resolves_elevation
from mmweaver.dsp.features import (
    DRAI_SIZE,
    dynamic_range_angle,
    micro_doppler_db,
    range_azimuth_db,
    range_doppler_db,
    range_elevation_db,
)
from mmweaver.dsp.spectra import azimuth_axis_rad, elevation_axis_rad
from mmweaver.figures.figure_data import Fan, FigureData
from mmweaver.figures.point_panels import draw_points_top, velocity_bar
from mmweaver.figures.power_map import draw_power_map, scale_bar
from mmweaver.figures.power_scale import PowerScale
from mmweaver.figures.recording_pages import styled, write_figure
from mmweaver.figures.theme import label_axes, shortened

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TITLES = {"ra": "Range-azimuth", "re": "Range-elevation"}
FEATURES = ("rd", "ra", "re", "drai", "micro_doppler", "points")  # names as `RadarDataset` has them
OVER_TIME = ("micro_doppler",)
HEIGHT = {"ra": 0.58, "points": 0.56, "re": 1.28}  # of a panel relative to its width, where axes are in equal metres
MOST_FRAMES = 8
PANEL_INCH, LEFT_INCH, RIGHT_INCH, TOP_INCH, GAP_INCH = 2.6, 0.8, 1.1, 0.9, 0.75
DPI = 110


def features_of(cube: RadarCube, names: Sequence[str] | None) -> list[str]:
    """The features that are drawn; by default all that the array resolves. Raises InputError for unknown names."""
    if names is None:
        return [name for name in FEATURES if name != "re" or resolves_elevation(cube.config)]
    for name in names:
        if name not in FEATURES:
            raise InputError(f"unknown feature {name!r}; known: {', '.join(FEATURES)}")
    return list(names)


def frames_of(cube: RadarCube, frames: Sequence[int] | None, count: int = 4) -> list[int]:
    """The frames that are drawn; by default evenly spaced ones. Raises InputError for frames that there are not."""
    last = len(cube.values) - 1
    if frames is None:
        return np.unique(np.linspace(0, last, min(count, last + 1)).round().astype(int)).tolist()
    if not 1 <= len(frames) <= MOST_FRAMES:
        raise InputError(f"give 1 to {MOST_FRAMES} frames, not {len(frames)}")
    for frame in frames:
        if not 0 <= frame <= last:
            raise InputError(f"there is no frame {frame}; the frames are 0 to {last}")
    return list(frames)


def draw_features(
    path: Path, view: FigureData, features: Sequence[str], frames: Sequence[int], *, moving: bool = False
) -> None:
    """Writes a PNG: a row for each feature, a column for each frame; `moving` removes each frame's mean chirp."""
    from matplotlib.figure import Figure

    columns, step = len(frames), PANEL_INCH + GAP_INCH
    tall = [PANEL_INCH * HEIGHT.get(name, 1.0) for name in features]
    width, height = LEFT_INCH + columns * step + RIGHT_INCH, TOP_INCH + sum(tall) + GAP_INCH * len(tall)
    with styled():
        figure = Figure(figsize=(width, height), dpi=DPI, facecolor="white")
        figure.text(
            LEFT_INCH / width, 1 - 0.2 / height, shortened(view.title, int(9 * width)), ha="left", va="top",
            fontsize=13, fontweight="bold",
        )  # fmt: skip
        for row, name in enumerate(features):
            scale = _summed(view.scale, len(view.cube.grid.range_m)) if name in OVER_TIME else view.scale
            draw = _panels(name, view, scale, frames, moving=moving)
            is_wide = name in OVER_TIME
            size = (columns * step - GAP_INCH if is_wide else PANEL_INCH) / width, tall[row] / height
            bottom = (height - TOP_INCH - sum(tall[: row + 1]) - row * GAP_INCH) / height
            for column in range(1 if is_wide else columns):
                axes = figure.add_axes(((LEFT_INCH + column * step) / width, bottom, *size))
                draw(axes, column)
            if name == "points":
                velocity_bar(axes, view)
            else:
                scale_bar(axes, scale, share=PANEL_INCH / (size[0] * width))
        write_figure(figure, path)


def _summed(scale: PowerScale, cells: int) -> PowerScale:
    """The scale of a sum over cells: the noise of all of them."""
    if scale.noise_db is None:
        return scale
    more_db = 10 * float(np.log10(cells))
    return replace(scale, low_db=scale.low_db + more_db, high_db=scale.high_db + 5, noise_db=scale.noise_db + more_db)


def _panels(
    name: str, view: FigureData, scale: PowerScale, frames: Sequence[int], *, moving: bool
) -> Callable[["Axes", int], None]:
    """Draws the panel of a column."""
    times_s = [float(view.cube.grid.frame_time_s[frame]) for frame in frames]
    when = [f"frame {frame} ({time_s:.2f} s)" for frame, time_s in zip(frames, times_s, strict=True)]
    cube = _chosen(view.cube, frames)
    range_m = view.range_edges_m
    if name == "micro_doppler":
        power_db = micro_doppler_db(view.cube)

        def over_time(axes: "Axes", _: int) -> None:
            draw_power_map(axes, scale, power_db.T, (*view.time_edges_s, *view.velocity_edges_mps))
            label_axes(axes, "Micro-Doppler, clutter removed", "time (s)", "radial velocity (m/s), away +")

        return over_time
    if name == "points":

        def from_above(axes: "Axes", column: int) -> None:
            own = view.points.select(view.points.frame == frames[column])
            draw_points_top(axes, replace(view, points=own))
            axes.set_title(f"Points from above, {when[column]}", y=1.0)

        return from_above
    said = "no clutter" if moving else "with clutter"
    if name == "rd":
        power_db = range_doppler_db(cube, moving=moving)

        def range_doppler(axes: "Axes", column: int) -> None:
            draw_power_map(axes, scale, power_db[column], (*view.velocity_edges_mps, *range_m))
            label_axes(axes, f"Range-Doppler, {said}, {when[column]}", "radial velocity (m/s), away +", "range (m)")

        return range_doppler
    if name == "drai":
        power_db = 10 * np.log10(np.maximum(dynamic_range_angle(cube) * scale.factor, 1e-30))
        edge = float(np.degrees(azimuth_axis_rad(DRAI_SIZE)[-1]))

        def image(axes: "Axes", column: int) -> None:
            draw_power_map(axes, scale, power_db[column], (-edge, edge, *range_m))
            label_axes(axes, f"Dynamic range-angle, {when[column]}", "azimuth (degrees), right +", "range (m)")

        return image
    is_azimuth = name == "ra"
    angle_rad = azimuth_axis_rad(91) if is_azimuth else elevation_axis_rad(61)
    power_db = (range_azimuth_db if is_azimuth else range_elevation_db)(cube, moving=moving)
    fan = Fan.over(view.cube.grid.range_m, angle_rad)

    def from_above_or_side(axes: "Axes", column: int) -> None:
        laid, (low, high, _, far) = fan.lay(power_db[column]), fan.extent
        draw_power_map(axes, scale, laid if is_azimuth else laid.T, fan.extent if is_azimuth else (0.0, far, low, high))
        axes.set_aspect("equal", anchor="NW")
        words = ("right (m)", "ahead (m)") if is_azimuth else ("ahead (m)", "up (m)")
        label_axes(axes, f"{TITLES[name]}, {said}, {when[column]}", *words)

    return from_above_or_side


def _chosen(cube: RadarCube, frames: Sequence[int]) -> RadarCube:
    own = list(frames)
    grid: CubeGrid = replace(cube.grid, frame_time_s=cube.grid.frame_time_s[own])
    return replace(cube, values=cube.values[own], grid=grid)
