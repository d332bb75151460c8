"""A skeleton drawn over a photo, projected into the camera."""

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import RgbdPhoto
from mmweaver.core.shapes import Array, Points
from mmweaver.core.skeleton import BONES, joint
from mmweaver.geometry.aligned_photo import AlignedPhoto

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

OCCLUDED_BEYOND_M = (
    0.25  # depth of a joint behind the measured surface that counts as occluded; bodies are thicker than joints
)
NEAREST_M = 0.05
HEAD_RADIUS_M = 0.09
PER_BONE = 6  # pieces per bone, so that it can vanish behind an edge


def project(points_m: Points, aligned: AlignedPhoto) -> Float[Array, "point 3"]:
    """Radar frame -> (column, row, depth in metres) in the photo; nan behind the camera.

    Reference: docs/conventions.md, "Camera".
    """
    pixels, depth_m = aligned.project(points_m)
    return np.where(depth_m[:, None] > NEAREST_M, np.column_stack([pixels, depth_m]), np.nan)


def is_occluded(pixels: Float[Array, "point 3"], photo: RgbdPhoto) -> Bool[Array, " point"]:
    """Whether the depth image is clearly nearer than a projected point; False where unknown."""
    height, width = photo.depth_m.shape
    seen = np.isfinite(pixels).all(axis=1)
    column = np.round(np.where(seen, pixels[:, 0], -1)).astype(int)
    row = np.round(np.where(seen, pixels[:, 1], -1)).astype(int)
    seen &= (column >= 0) & (column < width) & (row >= 0) & (row < height)
    surface_m = photo.depth_m[np.where(seen, row, 0), np.where(seen, column, 0)]
    return seen & np.isfinite(surface_m) & (surface_m < np.where(seen, pixels[:, 2], 0.0) - OCCLUDED_BEYOND_M)


class SkeletonInPhoto:
    """The bones of one person as lines in a photo's axes: full where visible, faint where occluded by furniture."""

    def __init__(self, axes: "Axes", aligned: AlignedPhoto, width: float = 2.0):
        from matplotlib.lines import Line2D

        self._aligned = aligned
        self._back, self._occluded, self._seen = (
            Line2D([], [], linewidth=one, color="black", solid_capstyle="round", solid_joinstyle="round")
            for one in (width + 1.4, width * 0.6, width)
        )
        for line in self.artists:
            axes.add_artist(line)

    @property
    def artists(self) -> "tuple[Line2D, ...]":
        return self._back, self._occluded, self._seen

    def show(self, joints_m: Float[Array, "22 3"], colour: tuple[float, float, float], alpha: float = 1.0) -> None:
        """Moves the lines to a pose; joints in metres in the radar's frame."""
        pieces, occluded = bone_pieces(joints_m, self._aligned)
        for line, shown in ((self._back, ~occluded), (self._occluded, occluded), (self._seen, ~occluded)):
            line.set_data(*_with_gaps(pieces[shown]).T)
        self._back.set_alpha(0.5 * alpha)
        self._occluded.set(color=colour, alpha=0.35 * alpha)
        self._seen.set(color=colour, alpha=alpha)


def _with_gaps(pieces: Float[Array, "piece 2 2"]) -> Float[Array, "point 2"]:
    """End points of the pieces as one polyline with nan between strokes; adjacent pieces form one stroke."""
    gaps = np.full((len(pieces), 1, 2), np.nan)
    points = np.concatenate([pieces, gaps], axis=1).reshape(-1, 2)
    if len(pieces) < 2:
        return points
    meets = np.abs(pieces[1:, 0] - pieces[:-1, 1]).max(axis=1) < 1e-9
    keep = np.ones((len(pieces), 3), dtype=bool)
    keep[:-1, 2] = ~meets
    keep[1:, 0] = ~meets
    return points[keep.reshape(-1)]


def bone_pieces(
    joints_m: Float[Array, "22 3"], aligned: AlignedPhoto
) -> tuple[Float[Array, "piece 2 2"], Bool[Array, " piece"]]:
    """Bones and head outline in short pieces, (piece, end, column/row) in pixels, and whether each is occluded."""
    start, end = (joints_m[np.array([bone[side] for bone in BONES])] for side in (0, 1))
    share = np.linspace(0.0, 1.0, PER_BONE + 1)[:, None, None]
    bones_m = start + share * (end - start)  # (knot, bone, 3)
    pieces_m = np.stack([bones_m[:-1], bones_m[1:]], axis=2).reshape(-1, 2, 3)
    pieces_m = np.concatenate([pieces_m, _head_pieces(joints_m)])
    pieces = project(pieces_m.reshape(-1, 3), aligned).reshape(-1, 2, 3)
    occluded = is_occluded(pieces.mean(axis=1), aligned.photo)
    ahead = np.isfinite(pieces).all(axis=(1, 2))
    return pieces[ahead][:, :, :2], occluded[ahead]


def _head_pieces(joints_m: Float[Array, "22 3"]) -> Float[Array, "piece 2 3"]:
    """A ring around the head that faces the radar; the skeleton itself ends at the base of the skull."""
    head_m, neck_m = joints_m[joint("head")], joints_m[joint("neck")]
    up = head_m - neck_m
    up = up / max(float(np.linalg.norm(up)), 1e-6)
    aside = np.cross(head_m, up)
    aside = aside / max(float(np.linalg.norm(aside)), 1e-6)
    angle = np.linspace(0.0, 2 * np.pi, 17)[:, None]
    ring_m = head_m + HEAD_RADIUS_M * (up + np.cos(angle) * up + 0.75 * np.sin(angle) * aside)
    return np.stack([ring_m[:-1], ring_m[1:]], axis=1)
