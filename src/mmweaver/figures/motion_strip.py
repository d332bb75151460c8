"""A motion as a strip: the skeleton at evenly spaced times, side by side; left limbs blue, right limbs red."""

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import BONES, JOINT_NAMES, joint
from mmweaver.figures.theme import INK, STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEFT_COLOUR, RIGHT_COLOUR = "#2b7bba", "#c8442f"
SPACING_M = 0.85
AZIMUTH_RAD = np.radians(35.0)  # azimuth of the viewpoint relative to the radar
TILT = 0.18  # upward shift per metre of distance


def draw_strip(pose: PoseSequence, path: Path, *, title: str = "", count: int = 10) -> None:
    """Writes a picture (png, pdf, svg by the file's name) of `count` instants of a motion."""
    draw_sheet([(title, pose)], path, columns=1, count=count)


def draw_sheet(motions: list[tuple[str, PoseSequence]], path: Path, *, columns: int = 3, count: int = 6) -> None:
    """Writes one picture of several motions, a strip each."""
    import matplotlib.pyplot as plt

    rows = -(-len(motions) // columns)
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(rows, columns, figsize=(max(6.0 * columns, 10.0), 1.9 * rows), squeeze=False)
        for cell in axes.flat:
            cell.axis("off")
        for cell, (title, pose) in zip(axes.flat, motions, strict=False):
            _draw(cell, pose, count)
            cell.set_title(title)
        figure.tight_layout(pad=0.4)
        with atomic_file(path) as temporary:
            figure.savefig(temporary, dpi=80, format=path.suffix.removeprefix(".") or "png")
        plt.close(figure)


def _draw(axes: "Axes", pose: PoseSequence, count: int) -> None:
    """Draws each instant at its own place along the strip; locomotion is removed."""
    instants = np.linspace(0, len(pose.time_s) - 1, count).round().astype(int)
    middle = (pose.joints_m[..., :2].min(axis=(0, 1)) + pose.joints_m[..., :2].max(axis=(0, 1))) / 2
    floor = float(np.percentile(pose.joints_m[..., 2].min(axis=1), 5))
    wide = np.ptp(_flat(pose.joints_m[instants] - [*middle, floor])[..., 0], axis=1)
    reach = max(SPACING_M, 1.05 * float(wide.max()))
    axes.axhline(0.0, color="0.85", linewidth=0.6)
    for k, index in enumerate(instants):
        joints = pose.joints_m[index] - [*pose.joints_m[index, 0, :2], floor]
        points = _flat(joints) + np.array([k * reach, 0.0])
        for parent, child in BONES:
            name = JOINT_NAMES[child]
            colour = LEFT_COLOUR if name.startswith("left") else RIGHT_COLOUR if name.startswith("right") else INK
            axes.plot(*points[[parent, child]].T, color=colour, linewidth=1.3, solid_capstyle="round")
        axes.plot(*points[joint("head")], "o", color=INK, markersize=4)
        axes.text(k * reach, -0.16, f"{abs(pose.time_s[index]):.1f} s", ha="center", va="top", fontsize=6, color="0.4")
    axes.set_aspect("equal")


def _flat(joints_m: Float[np.ndarray, "*shape 3"]) -> Float[np.ndarray, "*shape 2"]:
    """Projection seen from the side of the radar, slightly from above."""
    cos, sin = np.cos(AZIMUTH_RAD), np.sin(AZIMUTH_RAD)
    across = joints_m[..., 0] * cos + joints_m[..., 1] * sin
    away = -joints_m[..., 0] * sin + joints_m[..., 1] * cos
    return np.stack([across, joints_m[..., 2] + TILT * away], axis=-1)
