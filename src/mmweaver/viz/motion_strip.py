"""A motion as a strip: the shaded body at evenly spaced times, side by side; left limbs blue, right limbs red."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.body_capsules import CAPSULES
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import BONES, JOINT_NAMES, joint
from mmweaver.viz.body_rasteriser import Body, CapsulesInPicture, blend, bodies_of, rasterise, seen_width
from mmweaver.viz.theme import STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LEFT_COLOUR, RIGHT_COLOUR, TRUNK_COLOUR = (0.27, 0.55, 0.82), (0.86, 0.36, 0.28), (0.72, 0.72, 0.74)
FACE_COLOUR, NOSE_COLOUR = (0.97, 0.80, 0.60), (0.78, 0.42, 0.25)
SPACING_M = 0.85
AZIMUTH_RAD = np.radians(35.0)  # azimuth of the viewpoint relative to the radar
TILT = 0.18  # upward shift per metre of distance
PX_PER_M = 110.0
BELOW_M, ABOVE_M = 0.25, 0.12  # shown below the floor and above the highest point
LABEL_M, LIMB_M = 0.09, 0.08  # height of the time labels, and thickness of a limb with a margin
MIN_HIPS_M = 0.1  # minimum distance of the hips on the floor plan that determines a facing
SHADOW_HEIGHT_M = 0.2  # height at which a limb's shadow is a third of that on the floor


def draw_strip(pose: PoseSequence, path: Path, *, title: str = "", count: int = 10) -> None:
    """Writes a picture of evenly spaced instants of a motion.

    Args:
        pose: The motion.
        path: The picture: png, pdf or svg, by its suffix.
        title: Title of the strip.
        count: Number of instants.
    """
    draw_sheet([(title, pose)], path, columns=1, count=count)


def draw_sheet(motions: list[tuple[str, PoseSequence]], path: Path, *, columns: int = 3, count: int = 6) -> None:
    """Writes one picture of several motions, a strip each.

    Args:
        motions: Titles and motions.
        path: The picture: png, pdf or svg, by its suffix.
        columns: Number of columns.
        count: Number of instants per motion.
    """
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
            kind = path.suffix.removeprefix(".") or "png"
            figure.savefig(temporary, dpi=80, format=kind, bbox_inches="tight", pad_inches=0.06)
        plt.close(figure)


def _draw(axes: "Axes", pose: PoseSequence, count: int) -> None:
    """Draws each instant at its own place along the strip, seen obliquely from the front; locomotion is removed."""
    pose = _facing_the_radar(pose)
    instants = np.linspace(0, len(pose.time_s) - 1, count).round().astype(int)
    floor_m = float(np.percentile(pose.joints_m[..., 2].min(axis=1), 5))
    bodies = bodies_of(pose, instants)
    places_m = [
        _flat(body.ends_m - [*pose.joints_m[k, 0, :2], floor_m]) for body, k in zip(bodies, instants, strict=True)
    ]
    reach, left_m, right_m, below_m, top_m = frame_of(places_m)
    picture = np.full((round((top_m + below_m) * PX_PER_M), round((right_m - left_m) * PX_PER_M), 3), 255, np.uint8)
    for number, (body, index) in enumerate(zip(bodies, instants, strict=True)):
        middle_m = pose.joints_m[index, 0, :2]
        origin_px = np.array([(number * reach - left_m) * PX_PER_M, top_m * PX_PER_M])
        _paint(picture, body, np.array([*middle_m, floor_m]), origin_px)
        seconds = f"{abs(pose.time_s[index]):.1f} s"
        axes.text(number * reach, LABEL_M - below_m, seconds, ha="center", va="top", fontsize=6, color="0.4")
    axes.axhline(0.0, color="0.85", linewidth=0.6, zorder=0)
    axes.imshow(picture, extent=(left_m, right_m, -below_m, top_m), alpha=(picture < 255).any(axis=2).astype(float))
    axes.set(xlim=(left_m, right_m), ylim=(-below_m, top_m))
    axes.set_aspect("equal")


def frame_of(places_m: list[Float[np.ndarray, "capsule 2 2"]]) -> tuple[float, float, float, float, float]:
    """Dimensions of a strip of bodies.

    Args:
        places_m: Ends (capsule, 2, 2) of the capsules in the picture, relative to each body's place on the floor. Lying
            bodies extend far to one side and below their place; the time labels are below them.

    Returns:
        Distance between instants, left and right edge, depth below the floor and top, in metres.
    """
    ends = np.stack([place.reshape(-1, 2) for place in places_m])
    reach = max(SPACING_M, 1.05 * float(np.ptp(ends[..., 0], axis=1).max()) + 0.1)
    left_m = min(-reach / 2, float(ends[0, :, 0].min()) - LIMB_M)
    last_m = max(reach / 2, float(ends[-1, :, 0].max()) + LIMB_M)
    below_m = max(BELOW_M, LIMB_M + LABEL_M - float(ends[..., 1].min()))
    return reach, left_m, (len(places_m) - 1) * reach + last_m, below_m, float(ends[..., 1].max()) + ABOVE_M


def _facing_the_radar(pose: PoseSequence) -> PoseSequence:
    """The motion rotated about the vertical to face -y at first, since a side view hides what a body does."""
    across = (pose.joints_m[0, joint("left_hip")] - pose.joints_m[0, joint("right_hip")])[:2]
    length_m = float(np.hypot(*across))
    if length_m < MIN_HIPS_M:  # lying on a side: the hips do not determine the facing
        return pose
    cos, sin = across / length_m
    turn = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return replace(pose, joints_m=pose.joints_m @ turn.T)


def _paint(picture: np.ndarray, body: Body, origin_m: Float[np.ndarray, "3"], origin_px: Float[np.ndarray, "2"]):
    """Paints a body into a picture (row, column, 3) uint8; `origin_m`, on the floor, appears at `origin_px`."""
    ends_m = body.ends_m - origin_m
    down = np.array([PX_PER_M, -PX_PER_M])
    _darken(picture, ends_m, body.radius_m, origin_px)
    ends_px, wide_px = _flat(ends_m) * down + origin_px, _flat(body.wide) * [1.0, -1.0]
    wider = seen_width(ends_px[:, 1] - ends_px[:, 0], wide_px, body.width_per_depth)
    seen = rasterise(
        CapsulesInPicture(
            ends_px=ends_px,
            depth_m=_away_m(ends_m),
            radius_px=body.radius_m * wider[:, None] * PX_PER_M,
            radius_m=body.radius_m,
        ),
        (picture.shape[0], picture.shape[1]),
    )
    if seen is not None:
        blend(picture, seen, COLOURS[seen.capsule])


def _darken(
    picture: np.ndarray,
    ends_m: Float[np.ndarray, "capsule 2 3"],
    radius_m: Float[np.ndarray, "capsule 2"],
    origin_px: Float[np.ndarray, "2"],
) -> None:
    """A soft shadow on the floor below limbs near it."""
    row = np.arange(picture.shape[0])
    band = np.flatnonzero(np.abs(row - origin_px[1]) < 1.2 * TILT * PX_PER_M + 6)
    columns = np.arange(picture.shape[1])
    columns = columns[np.abs(columns - origin_px[0]) < 1.3 * PX_PER_M]
    ends, radius = ends_m.reshape(-1, 3), radius_m.reshape(-1)
    height_m = np.maximum(ends[:, 2] - radius, 0.0)
    place_px = _flat(ends * [1.0, 1.0, 0.0]) * [PX_PER_M, -PX_PER_M] + origin_px
    wide_px = (radius + 0.03 + 0.3 * height_m) * PX_PER_M
    across = (columns[None, None, :] - place_px[:, 0, None, None]) / wide_px[:, None, None]
    along = (band[None, :, None] - place_px[:, 1, None, None]) / (2.0 * TILT * wide_px[:, None, None] + 1.0)
    dark = (0.3 * np.exp(-height_m / SHADOW_HEIGHT_M))[:, None, None] * np.exp(-(across**2) - along**2)
    light = np.exp(-dark.sum(axis=0))
    block = np.ix_(band, columns)
    picture[block] = (picture[block] * light[:, :, None]).astype(np.uint8)


def _flat(points_m: Float[np.ndarray, "*shape 3"]) -> Float[np.ndarray, "*shape 2"]:
    """Projection seen from the side of the radar, slightly from above."""
    cos, sin = np.cos(AZIMUTH_RAD), np.sin(AZIMUTH_RAD)
    across = points_m[..., 0] * cos + points_m[..., 1] * sin
    return np.stack([across, points_m[..., 2] + TILT * _away_m(points_m)], axis=-1)


def _away_m(points_m: Float[np.ndarray, "*shape 3"]) -> Float[np.ndarray, "*shape"]:
    """Distance from the viewer, but for a constant."""
    return -points_m[..., 0] * np.sin(AZIMUTH_RAD) + points_m[..., 1] * np.cos(AZIMUTH_RAD) - TILT * points_m[..., 2]


def _colour_of(name: str) -> tuple[float, float, float]:
    return LEFT_COLOUR if name.startswith("left") else RIGHT_COLOUR if name.startswith("right") else TRUNK_COLOUR


COLOURS = np.array([*(_colour_of(capsule.end) for capsule in CAPSULES), FACE_COLOUR, NOSE_COLOUR], np.float32)


Joints = Float[np.ndarray, "frame 22 3"]
PITCH_M, LOWEST_M, HIGHEST_M = 1.5, -1.25, 1.15  # heights over the pelvis
LEFT, RIGHT, TRUNK, BEHIND = "#2b78b8", "#c2431c", "#444a52", "#b9bec6"


def draw_pose_strips(
    strips: Sequence[tuple[str, Joints, Joints | None]], path: Path, *, frame_rate_hz: float, count: int = 8
) -> None:
    """Writes a picture with one strip per motion, each optionally over another motion; both are aligned at the pelvis.

    Args:
        strips: Title, joints, and joints to draw behind or None, for each strip.
        path: The picture: png, pdf or svg, by its suffix.
        frame_rate_hz: Frames per second of the joints.
        count: Number of instants.
    """
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(len(strips), 1, figsize=(10.0, 2.1 * len(strips)), squeeze=False)
        for cell, (title, joints_m, behind_m) in zip(axes[:, 0], strips, strict=True):
            chosen = np.linspace(0, len(joints_m) - 1, min(count, len(joints_m))).round().astype(int)
            for place, frame in enumerate(chosen):
                if behind_m is not None and np.isfinite(behind_m[frame]).all():
                    _draw_skeleton(cell, behind_m[frame], place * PITCH_M, is_behind=True)
                _draw_skeleton(cell, joints_m[frame], place * PITCH_M, is_behind=False)
                cell.text(place * PITCH_M, LOWEST_M, f"{frame / frame_rate_hz:.1f} s", ha="center", fontsize=7)
            cell.set(title=title, xlim=(-0.8, (count - 0.45) * PITCH_M), ylim=(LOWEST_M - 0.05, HIGHEST_M))
            cell.set_aspect("equal")
            cell.axis("off")
        figure.tight_layout(pad=0.4)
        with atomic_file(path) as temporary:
            figure.savefig(temporary, dpi=100, format=path.suffix.removeprefix(".") or "png")
        plt.close(figure)


def _draw_skeleton(axes: "Axes", joints_m: Float[np.ndarray, "22 3"], place_m: float, *, is_behind: bool) -> None:
    flat = (joints_m - joints_m[:1])[:, [0, 2]] + [place_m, 0.0]
    for start, end in BONES:
        name = JOINT_NAMES[end]
        colour = LEFT if name.startswith("left") else RIGHT if name.startswith("right") else TRUNK
        axes.plot(
            *flat[[start, end]].T,
            color=BEHIND if is_behind else colour,
            linewidth=4.0 if is_behind else 1.4,
            solid_capstyle="round",
        )
