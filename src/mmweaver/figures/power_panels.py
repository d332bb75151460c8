"""Panels of radar power: strips over time, maps and profiles, all on the scale of the whole page."""

from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint
from mmweaver.figures.figure_data import Fan, FigureData
from mmweaver.figures.power_map import Extent, draw_power_map, scale_bar
from mmweaver.figures.theme import (
    GROUND_TRUTH,
    INK,
    PAPER,
    PEOPLE_ON_WHITE,
    label_axes,
    legend,
    person_colour,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN_POSES = 7  # poses whose joints are drawn from the side
WITHOUT, WITH, CHANGE = "clutter removed", "static clutter included", "change over frames"
STATIC_COLOUR, MOVING_COLOUR = "#8a5a00", "#0b7da3"
NARROWEST_MPS = 0.02  # half width of a velocity axis over frames
DISPLACEMENT_SPAN, DISPLACEMENT_NAME = 1.15, 0.22


def power_bar(axes: "Axes", view: FigureData) -> None:
    """The colour bar of all power panels, with the noise marked."""
    scale_bar(axes, view.scale)


def moving_words(view: FigureData) -> str:
    """What is left in panels of movement."""
    return CHANGE if view.is_slow else WITHOUT


# over time ----------------------------------------------------------------------------------------------------------
def draw_range_time(axes: "Axes", view: FigureData) -> None:
    """Power of movement over time and range, with the ground-truth extent of the joints."""
    _power(axes, view, view.range_doppler_moving.max(axis=2).T, (*view.time_edges_s, *view.range_edges_m))
    if view.poses:
        middle_s = view.time_s + view.frame_step_s / 2
        for pose, colour in with_colours(view.shown_poses):
            distance_m = np.linalg.norm(pose.joints_m, axis=2)
            for edge in (distance_m.min(axis=1), distance_m.max(axis=1)):
                axes.plot(middle_s, edge, color=colour, linewidth=0.9)
        _within(axes, view.time_edges_s, view.range_edges_m)
        note(axes, "lines: nearest and farthest joint")
    label_axes(axes, f"Range over time, {moving_words(view)}", "time (s)", "range (m)")


def draw_micro_doppler(axes: "Axes", view: FigureData) -> None:
    """The spectrogram over chirps: the strongest range at each time and radial velocity, with that of the pelvis."""
    found = view.micro_doppler
    first_s, last_s = view.time_edges_s
    # columns of equal time: a spectrum holds until the next one, through the pause between frames
    column_s = np.linspace(first_s, last_s, max(2 * len(found.time_s), 200), endpoint=False)
    half_s = (found.time_s[0] - view.time_s[0]) if len(found.time_s) else 0.0
    shown = np.clip(np.searchsorted(found.time_s - half_s, column_s, side="right") - 1, 0, len(found.time_s) - 1)
    step_mps = float(found.radial_velocity_mps[1] - found.radial_velocity_mps[0])
    edges = float(found.radial_velocity_mps[0]) - step_mps / 2, float(found.radial_velocity_mps[-1]) + step_mps / 2
    _power(axes, view, found.power[shown].T, (first_s, last_s, *edges))
    if view.motions:
        for motion, colour in with_colours(view.motions):
            distance_m = np.linalg.norm(motion.joints_m[:, joint("pelvis")], axis=1)
            if len(distance_m) > 1:
                velocity_mps = np.interp(view.time_s, motion.time_s, np.gradient(distance_m, motion.time_s))
                axes.plot(view.time_s + view.frame_step_s / 2, velocity_mps, color=colour, linewidth=0.9)
        _within(axes, view.time_edges_s, edges)
        note(axes, "line: pelvis")
    label_axes(axes, "Micro-Doppler (STFT over chirps)", "time (s)", "radial velocity (m/s), away +")


def draw_displacement(axes: "Axes", view: FigureData) -> None:
    """Displacement over time of the range bins that move most from frame to frame."""
    time_s = view.cube.grid.frame_time_s
    cells = view.slow_cells
    reach_mm = max([1e-3, *(1e3 * float(np.abs(cell.displacement_m).max()) for cell in cells)]) * DISPLACEMENT_SPAN
    for_names = 1 + DISPLACEMENT_NAME * len(cells)  # no curve runs through the names
    axes.set(xlim=view.time_edges_s, ylim=(-reach_mm, reach_mm * for_names))
    entries = []
    for index, cell in enumerate(cells):
        colour = PEOPLE_ON_WHITE[index % len(PEOPLE_ON_WHITE)]
        axes.plot(time_s, 1e3 * cell.displacement_m, color=colour, linewidth=1.0)
        entries.append((f"at {cell.range_m:.2f} m", colour))
    legend(axes, entries)
    label_axes(axes, "Displacement where most changes", "time (s)", "displacement (mm), away +", grid=True)


# maps ---------------------------------------------------------------------------------------------------------------
def draw_range_doppler(axes: "Axes", view: FigureData) -> None:
    """Power over range and radial velocity in the most active frame, static clutter included."""
    at = view.most_active_frame
    _power(axes, view, view.range_doppler[at], (*view.velocity_edges_mps, *view.range_edges_m))
    if view.motions:
        for motion, colour in with_colours(view.motions):
            _mark_joints(axes, motion, float(view.time_s[at]), colour)
        _within(axes, view.velocity_edges_mps, view.range_edges_m)
        note(axes, "dots: joints")
    title = f"Range-Doppler, frame {view.frames[at]} ({view.time_s[at]:.1f} s)"
    label_axes(axes, title, "radial velocity (m/s), away +", "range (m)")


def draw_slow_doppler(axes: "Axes", view: FigureData) -> None:
    """Power over range and slow-time velocity, of all frames; the middle of the axis, where the movement is."""
    power, velocity_mps = view.slow_doppler
    fast = np.abs(velocity_mps[power.max(axis=0) * view.scale.factor > 10 ** ((view.scale.noise_db or -300.0) / 10)])
    reach = max(NARROWEST_MPS, 1.3 * float(fast.max(initial=0.0)))
    shown = np.abs(velocity_mps) <= reach
    step_mps = float(velocity_mps[1] - velocity_mps[0])
    edges = velocity_mps[shown]
    extent = 1e3 * (float(edges[0]) - step_mps / 2), 1e3 * (float(edges[-1]) + step_mps / 2)
    _power(axes, view, power[:, shown], (*extent, *view.range_edges_m))
    label_axes(axes, "Doppler over all frames", "radial velocity (mm/s), away +", "range (m)")


def draw_elevation(axes: "Axes", view: FigureData) -> None:
    """Power of movement from the side, the strongest of the frames, for arrays that resolve elevation."""
    fan = Fan.over(view.cube.grid.range_m, view.elevation_rad)
    low, high, _, far = fan.extent
    _power(axes, view, fan.lay(view.range_elevation_moving.max(axis=0)).T, (0.0, far, low, high))
    axes.set_aspect("equal", anchor="NW")
    if view.poses:
        for pose, colour in with_colours(view.shown_poses):
            joints_m = pose.joints_m[:: max(len(pose.time_s) // SHOWN_POSES, 1)].reshape(-1, 3)
            axes.plot(np.hypot(joints_m[:, 0], joints_m[:, 1]), joints_m[:, 2], ".", color=colour, markersize=1.2)
        note(axes, "dots: joints", corner="upper left")
    axes.set(xlim=(0, far), ylim=(low, high))
    label_axes(axes, f"Range-elevation, {moving_words(view)}", "ahead (m)", "up (m)")


def draw_azimuth_with_clutter(axes: "Axes", view: FigureData) -> None:
    """Power from above with static clutter, mean of the frames."""
    _draw_azimuth(axes, view, view.range_azimuth.mean(axis=0), f"Range-azimuth, {WITH}")


def draw_azimuth_moving(axes: "Axes", view: FigureData) -> None:
    """Power of movement from above, the strongest of the frames, with the path of the pelvis."""
    _draw_azimuth(axes, view, view.range_azimuth_moving.max(axis=0), f"Range-azimuth, {moving_words(view)}")


def _draw_azimuth(axes: "Axes", view: FigureData, power: np.ndarray, title: str) -> None:
    fan = Fan.over(view.cube.grid.range_m, view.azimuth_rad)
    _power(axes, view, fan.lay(power), fan.extent)
    axes.set_aspect("equal", anchor="NW")
    if view.poses:
        for pose, colour in with_colours(view.shown_poses):
            path_m = pose.joints_m[:, joint("pelvis")]
            axes.plot(path_m[:, 0], path_m[:, 1], color=colour, linewidth=1.0)
            axes.plot(*path_m[-1, :2], ">", color=colour, markersize=4)
        note(axes, "line: pelvis", corner="upper right")
    axes.set(xlim=fan.extent[:2], ylim=fan.extent[2:])
    label_axes(axes, title, "right (m)", "ahead (m)")


# profiles -----------------------------------------------------------------------------------------------------------
def draw_range_profile(axes: "Axes", view: FigureData) -> None:
    """Power over range: the strongest radial velocity, with and without static clutter, and the noise."""
    whole, moving = (power.max(axis=2).max(axis=0) for power in (view.range_doppler, view.range_doppler_moving))
    _profiles(axes, view, view.cube.grid.range_m, [("all", whole, STATIC_COLOUR), *_moving_line(view, moving)])
    label_axes(axes, "Range profile, strongest velocity", "range (m)", view.scale.unit, grid=True)


def draw_velocity_profile(axes: "Axes", view: FigureData) -> None:
    """Power over radial velocity in the strongest range bin of each, clutter removed."""
    moving = view.range_doppler_moving.max(axis=0).max(axis=0)
    _profiles(axes, view, view.cube.grid.radial_velocity_mps, _moving_line(view, moving))
    label_axes(
        axes, "Doppler profile, strongest range", "radial velocity (m/s), away +", view.scale.unit, grid=True
    )  # fmt: skip


def draw_azimuth_profile(axes: "Axes", view: FigureData) -> None:
    """Power over azimuth at the strongest range of each."""
    whole, moving = (power.max(axis=0).max(axis=0) for power in (view.range_azimuth, view.range_azimuth_moving))
    lines = [("all", whole, STATIC_COLOUR), *_moving_line(view, moving)]
    _profiles(axes, view, np.degrees(view.azimuth_rad), lines)
    label_axes(axes, "Azimuth profile, strongest range", "azimuth (degrees), right +", view.scale.unit, grid=True)


Line = tuple[str, np.ndarray, str]  # name, power, colour
LEGEND_SHARE = 0.2  # of the scale, above it: no curve runs through the names


def _moving_line(view: FigureData, power: np.ndarray) -> list[Line]:
    return [(moving_words(view), power, MOVING_COLOUR)]


def _profiles(axes: "Axes", view: FigureData, along: np.ndarray, lines: list[Line]) -> None:
    scale = view.scale
    for _, power, colour in lines:
        axes.plot(along, scale.decibels(power), color=colour, linewidth=1.1)
    entries = [(name, colour) for name, _, colour in lines]
    if scale.noise_db is not None:
        axes.plot([along[0], along[-1]], [scale.noise_db] * 2, color=INK, linewidth=0.8, linestyle=":")
        entries.append(("noise", INK))
    half = float(along[1] - along[0]) / 2 if len(along) > 1 else 0.5
    peak_db = max((float(np.max(scale.decibels(power), initial=scale.low_db)) for _, power, _ in lines))
    top_db = max(scale.high_db, peak_db) + LEGEND_SHARE * (scale.high_db - scale.low_db)
    axes.set(xlim=(float(along[0]) - half, float(along[-1]) + half), ylim=(scale.low_db, top_db))
    legend(axes, entries)


# pieces -------------------------------------------------------------------------------------------------------------
def _power(axes: "Axes", view: FigureData, power: np.ndarray, extent: Extent) -> None:
    draw_power_map(axes, view.scale, view.scale.decibels(power), extent)


def with_colours(people: tuple[PoseSequence, ...], *, on_white: bool = False) -> list[tuple[PoseSequence, str]]:
    """Each person with the colour of their ground truth."""
    return [(person, person_colour(index, len(people), on_white=on_white)) for index, person in enumerate(people)]


def _mark_joints(axes: "Axes", motion: PoseSequence, time_s: float, colour: str) -> None:
    """Joints as dots at their range and radial velocity at a given time."""
    if len(motion.time_s) < 2:
        return
    at = int(np.clip(np.searchsorted(motion.time_s, time_s), 1, len(motion.time_s) - 1))
    distance_m = np.linalg.norm(motion.joints_m[at - 1 : at + 1], axis=2)
    velocity_mps = (distance_m[1] - distance_m[0]) / (motion.time_s[at] - motion.time_s[at - 1])
    axes.plot(velocity_mps, distance_m.mean(axis=0), ".", color=colour, markersize=3, alpha=0.9)


def _within(axes: "Axes", x: tuple[float, float], y: tuple[float, float]) -> None:
    axes.set(xlim=x, ylim=y)


def note(axes: "Axes", text: str, *, corner: str = "lower right") -> None:
    """Legend of a line or dot: bright at the lower right of the picture, dark in a corner that a fan leaves white."""
    vertical, horizontal = corner.split()
    x, y = {"left": 0.02, "right": 0.98}[horizontal], {"lower": 0.02, "upper": 0.97}[vertical]
    colour, ground = (GROUND_TRUTH, "black") if corner == "lower right" else (INK, PAPER)
    axes.text(
        x, y, text, transform=axes.transAxes, ha=horizontal, va={"lower": "bottom", "upper": "top"}[vertical],
        fontsize=7.5, color=colour, bbox={"facecolor": ground, "edgecolor": "none", "alpha": 0.6, "pad": 1.0},
    )  # fmt: skip
