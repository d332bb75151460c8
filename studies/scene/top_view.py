"""A room from above: free floor, obstacles, seats and landmarks, the range window of the radar, a path."""

from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.skeleton import joint

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RANGE_WINDOW_M = (0.70, 3.48)
SEAT, MARK, TRUTH, PATH_COLOUR = "#d1495b", "#2e6f95", "#3a7d44", "#7b2cbf"
MARK_SIGNS = {"door": "D", "window": "W", "table": "T", "counter": "C", "bed": "B"}


def draw_top(
    axes: "Axes", scene: Scene, *, pose: PoseSequence | None = None, truth: Scene | None = None, far_m: float = 4.2
) -> None:
    """Free floor white (assumed pale), the rest grey by height; seats red with an arrow, landmarks blue with a letter.

    `truth` adds the true seats and landmarks as green rings; `pose` the path of the pelvis.
    """
    free = scene.free_space
    shade = np.full((*free.is_free.shape, 3), 0.80)
    shade[free.is_free] = 0.93
    shade[free.is_free & free.is_seen] = 1.0
    half = float(free.x_m[1] - free.x_m[0]) / 2
    extent = (free.x_m[0] - half, free.x_m[-1] + half, free.y_m[0] - half, free.y_m[-1] + half)
    axes.imshow(shade, origin="lower", extent=extent, interpolation="nearest")
    _draw_points(axes, scene)
    for reach in RANGE_WINDOW_M:
        angle = np.linspace(-0.7, 0.7, 60)
        axes.plot(reach * np.sin(angle), reach * np.cos(angle), color="black", linewidth=0.6, linestyle=":")
    if truth is not None:
        for seat in truth.seats:
            axes.plot(
                *seat.position_m[:2], "o", markersize=11, markerfacecolor="none", color=TRUTH, markeredgewidth=1.3
            )
        for mark in truth.landmarks:
            axes.plot(
                *mark.position_m[:2], "s", markersize=12, markerfacecolor="none", color=TRUTH, markeredgewidth=1.3
            )
    for seat in scene.seats:
        x, y = seat.position_m[:2]
        axes.plot(x, y, "o", color=SEAT, markersize=4)
        ahead = 0.32 * np.array([np.cos(seat.facing_rad), np.sin(seat.facing_rad)])
        axes.annotate("", (x + ahead[0], y + ahead[1]), (x, y), arrowprops={"arrowstyle": "->", "color": SEAT})
    for mark in scene.landmarks:
        x, y = mark.position_m[:2]
        sign = MARK_SIGNS.get(mark.kind, mark.kind[:1].upper())
        axes.text(x, y, sign, color=MARK, fontsize=9, fontweight="bold", ha="center", va="center")
        axes.plot(*mark.approach_m, "x", color=MARK, markersize=4)
    if pose is not None:
        path_m = pose.joints_m[:, joint("pelvis"), :2]
        axes.plot(path_m[:, 0], path_m[:, 1], color=PATH_COLOUR, linewidth=1.6)
        axes.plot(*path_m[0], "o", color=PATH_COLOUR, markersize=4)
        axes.plot(*path_m[-1], "s", color=PATH_COLOUR, markersize=4)
    axes.plot(0, 0, "^", color="black", markersize=6)
    axes.set(xlim=(-2.9, 2.9), ylim=(-0.25, far_m), xticks=range(-2, 3), yticks=range(0, int(far_m) + 1))
    axes.set_aspect("equal")
    axes.tick_params(labelsize=6, length=2)


def _draw_points(axes: "Axes", scene: Scene) -> None:
    """Measured points between floor and head, darker where higher."""
    step = max(1, scene.photo.intrinsics.width // 320)
    points = AlignedPhoto.of(scene).points_m[::step, ::step]
    points = points[np.isfinite(points[..., 2])]
    height = points[:, 2] - scene.floor_z_m
    shown = (height > 0.1) & (height < 1.9)
    axes.scatter(
        points[shown, 0],
        points[shown, 1],
        c=height[shown],
        s=0.4,
        cmap="YlOrBr",
        vmin=0,
        vmax=1.9,
        linewidths=0,
        rasterized=True,
    )
