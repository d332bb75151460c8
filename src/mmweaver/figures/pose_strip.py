"""Skeletons at evenly spaced instants, seen from the radar; a second motion (the truth, say) drawn behind the first."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.skeleton import BONES, JOINT_NAMES
from mmweaver.figures.theme import STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Joints = Float[np.ndarray, "frame 22 3"]
SPACING_M, LOWEST_M, HIGHEST_M = 1.5, -1.25, 1.15  # heights over the pelvis
LEFT, RIGHT, TRUNK, BEHIND = "#2b78b8", "#c2431c", "#444a52", "#b9bec6"


def draw_pose_strips(
    strips: Sequence[tuple[str, Joints, Joints | None]], path: Path, *, frame_rate_hz: float, count: int = 8
) -> None:
    """Writes a picture of a strip for each (title, joints, joints behind or None); both are set on their pelvises."""
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(len(strips), 1, figsize=(10.0, 2.1 * len(strips)), squeeze=False)
        for cell, (title, joints_m, behind_m) in zip(axes[:, 0], strips, strict=True):
            chosen = np.linspace(0, len(joints_m) - 1, min(count, len(joints_m))).round().astype(int)
            for place, frame in enumerate(chosen):
                if behind_m is not None and np.isfinite(behind_m[frame]).all():
                    _draw(cell, behind_m[frame], place * SPACING_M, is_behind=True)
                _draw(cell, joints_m[frame], place * SPACING_M, is_behind=False)
                cell.text(place * SPACING_M, LOWEST_M, f"{frame / frame_rate_hz:.1f} s", ha="center", fontsize=7)
            cell.set(title=title, xlim=(-0.8, (count - 0.45) * SPACING_M), ylim=(LOWEST_M - 0.05, HIGHEST_M))
            cell.set_aspect("equal")
            cell.axis("off")
        figure.tight_layout(pad=0.4)
        with atomic_file(path) as temporary:
            figure.savefig(temporary, dpi=100, format=path.suffix.removeprefix(".") or "png")
        plt.close(figure)


def _draw(axes: "Axes", joints_m: Float[np.ndarray, "22 3"], place_m: float, *, is_behind: bool) -> None:
    flat = (joints_m - joints_m[:1])[:, [0, 2]] + [place_m, 0.0]
    for start, end in BONES:
        name = JOINT_NAMES[end]
        colour = LEFT if name.startswith("left") else RIGHT if name.startswith("right") else TRUNK
        axes.plot(
            *flat[[start, end]].T, color=BEHIND if is_behind else colour, linewidth=4.0 if is_behind else 1.4,
            solid_capstyle="round",
        )  # fmt: skip
