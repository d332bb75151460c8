"""Panels of points, coloured by radial velocity; those below the floor are crosses, for nothing stands there."""

from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.power_panels import note, with_colours
from mmweaver.figures.theme import INK, VELOCITY_MAP, colour_bar, label_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

GHOST_COLOUR = "#b6bcc4"
SLOWEST_SCALE_MPS = 0.1


def draw_points_top(axes: "Axes", view: FigureData) -> None:
    """All detections from above."""
    reach_m = view.range_edges_m[1]
    points = view.shown_points
    _scatter(axes, view, points.x_m, points.y_m)
    if view.poses:
        for pose, colour in with_colours(view.shown_poses, on_white=True):
            path_m = pose.joints_m[:, joint("pelvis")]
            axes.plot(path_m[:, 0], path_m[:, 1], color=colour, linewidth=1.0)
        note(axes, "line: pelvis", corner="upper right")
    axes.set(xlim=(-0.9 * reach_m, 0.9 * reach_m), ylim=(0, reach_m))
    axes.set_aspect("equal", anchor="NW")
    label_axes(axes, f"Points from above ({len(points.frame)})", "right (m)", "ahead (m)", grid=True)


def draw_points_side(axes: "Axes", view: FigureData) -> None:
    """All detections from the side; over time or velocity, where the array has no elevation."""
    if view.has_elevation:
        _draw_side(axes, view)
    elif view.is_single:
        _draw_over_velocity(axes, view)
    else:
        _draw_over_time(axes, view)


def velocity_bar(axes: "Axes", view: FigureData) -> None:
    """The colour bar of the points."""
    colour_bar(axes, _velocities(view), "radial velocity (m/s), away +")


def _draw_side(axes: "Axes", view: FigureData) -> None:
    reach_m = view.range_edges_m[1]
    points, below = view.shown_points, view.is_below_floor
    _scatter(axes, view, points.y_m, points.z_m)
    if view.poses:
        for pose, colour in with_colours(view.shown_poses, on_white=True):
            for name in ("head", "left_foot"):
                trace_m = pose.joints_m[:, joint(name)]
                axes.plot(trace_m[:, 1], trace_m[:, 2], color=colour, linewidth=0.8)
        note(axes, "lines: head, left foot", corner="upper right")
    highest_m = float(np.max(np.abs(points.z_m), initial=0.0))
    half_m = float(np.clip(1.1 * highest_m, 0.32 * reach_m, 0.45 * reach_m))
    if view.aligned is not None:
        axes.plot([0, reach_m], [view.aligned.floor_z_m] * 2, color=INK, linewidth=0.7, linestyle=":")
    axes.set(xlim=(0, reach_m), ylim=(-half_m, half_m))
    axes.set_aspect("equal", anchor="NW")
    ghosts = f" (x: {below.sum()} below the floor)" if below.any() else ""
    label_axes(axes, f"Points from the side{ghosts}", "ahead (m)", "up (m)", grid=True)


def _draw_over_time(axes: "Axes", view: FigureData) -> None:
    points = view.shown_points
    time_s = view.cube.grid.frame_time_s[points.frame] + view.cube.config.frame_period_s / 2
    _scatter(axes, view, time_s, points.range_m)
    axes.set(xlim=view.time_edges_s, ylim=(0, view.range_edges_m[1]))
    label_axes(axes, "Points over time (no elevation)", "time (s)", "range (m)", grid=True)


def _draw_over_velocity(axes: "Axes", view: FigureData) -> None:
    points = view.shown_points
    _scatter(axes, view, points.radial_velocity_mps, points.range_m)
    axes.set(xlim=view.velocity_edges_mps, ylim=(0, view.range_edges_m[1]))
    label_axes(axes, "Points by velocity (no elevation)", "radial velocity (m/s), away +", "range (m)", grid=True)


def _velocities(view: FigureData) -> "ScalarMappable":
    """Colours span the speeds of moving points but for the fastest 5 %, which are mostly noise."""
    import matplotlib
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    speed_mps = np.abs(view.shown_points.radial_velocity_mps)
    moving_mps = speed_mps[speed_mps > SLOWEST_SCALE_MPS]
    top_mps = float(np.percentile(moving_mps, 95)) if len(moving_mps) else SLOWEST_SCALE_MPS
    return ScalarMappable(norm=Normalize(-top_mps, top_mps), cmap=matplotlib.colormaps[VELOCITY_MAP])


def _scatter(axes: "Axes", view: FigureData, across_m: np.ndarray, up_m: np.ndarray) -> None:
    """Weak detections are pale."""
    from matplotlib.colors import to_rgb

    snr_db, below = view.shown_points.snr_db, view.is_below_floor
    axes.scatter(across_m[below], up_m[below], s=8, linewidths=0.5, marker="x", color=GHOST_COLOUR)
    rising = np.argsort(snr_db, kind="stable")
    rising = rising[~below[rising]]
    face = _velocities(view).to_rgba(view.shown_points.radial_velocity_mps[rising])
    face[:, 3] = np.clip((snr_db[rising] - 10) / 20, 0.2, 1.0)
    edge = np.column_stack([np.broadcast_to(to_rgb(INK), (len(face), 3)), face[:, 3]])
    dots: Any = {"s": 12, "linewidths": 0.3, "facecolors": face, "edgecolors": edge}
    axes.scatter(across_m[rising], up_m[rising], **dots)
