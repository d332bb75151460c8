"""Samples a moving body by points on the axes of its limbs, each with a thickness, for collision tests with a room."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.body_capsules import capsule_between, part_of, scale_of
from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS, joint
from mmweaver.motion.animation.root_path import RootPath

Array = np.ndarray
# Limbs are tested as cylinders between two joints; each has one radius.
_LIMB_ENDS = (
    ("pelvis", "spine3"),
    ("spine3", "neck"),
    ("neck", "head"),
    ("left_hip", "right_hip"),
    ("left_collar", "left_shoulder"),
    ("right_collar", "right_shoulder"),
    ("left_hip", "left_knee"),
    ("right_hip", "right_knee"),
    ("left_knee", "left_ankle"),
    ("right_knee", "right_ankle"),
    ("left_ankle", "left_foot"),
    ("right_ankle", "right_foot"),
    ("left_shoulder", "left_elbow"),
    ("right_shoulder", "right_elbow"),
    ("left_elbow", "left_wrist"),
    ("right_elbow", "right_wrist"),
)
# Where the mean of the capsules is too thin: shoulder blades, and a head wider than its neck.
_THICKER_M = {"neck": 0.02, "head": 0.015, "shoulder": 0.005}
_RADIUS_STEP_M = 0.005  # mean radii are rounded up to it
_SEATED = ("pelvis", "spine3", "left_hip", "right_hip", "left_collar", "right_collar")
_SHARES = np.array([0.0, 0.33, 0.67, 1.0])  # positions along a limb
STEP_S = 0.1  # sampling interval
_SAME_M = 0.015  # a limb that has moved less since an earlier test is not tested again


def _limb_radius_m(start: str, end: str) -> float:
    """The mean radius of the capsules from joint to joint, at reference height, rounded up."""
    if part_of(start) == part_of(end) == "hip":
        return capsule_between(start, start).start_radius_m
    radii_m = []
    child = joint(end)
    while child != joint(start):
        capsule = capsule_between(JOINT_NAMES[PARENTS[child]], JOINT_NAMES[child])
        radii_m += [capsule.start_radius_m, capsule.end_radius_m]
        child = PARENTS[child]
    mean_m = float(np.mean(radii_m)) + _THICKER_M.get(part_of(end), 0.0)
    return round(float(np.ceil(round(mean_m / _RADIUS_STEP_M, 6))) * _RADIUS_STEP_M, 3)


LIMBS = tuple((start, end, _limb_radius_m(start, end)) for start, end in _LIMB_ENDS)
_RADII_M = np.array([radius_m for _, _, radius_m in LIMBS])
_STARTS = np.array([joint(start) for start, _ in _LIMB_ENDS])
_ENDS = np.array([joint(end) for _, end in _LIMB_ENDS])
_IS_SOFT = np.array([start in _SEATED for start, _ in _LIMB_ENDS])
_HAS_HAND = np.array([end.endswith("wrist") for _, end in _LIMB_ENDS])
_HAND_M = capsule_between("left_wrist", "left_wrist").extend_m + 0.03  # beyond the wrist, with most of its round tip
_TRUNK = ("pelvis", "spine3", "neck")
_LEGS = tuple((f"{side}_hip", f"{side}_knee", f"{side}_ankle") for side in ("left", "right"))


@dataclass(frozen=True, kw_only=True)
class BodySamples:
    """Limbs of a body ten times per second.

    Attributes:
        points_m: Points in metres, in the radar's frame or relative to the root, (point, 3).
        radius_m: Radius of the limb at each point in metres, (point,).
        is_soft: Points of trunk and thighs, which sink into a seat, (point,).
        time_s: Time of each point in seconds, (point,).
        lowest_m: Joints at the time of the lowest pelvis, (22, 3).
        lowest_s: That time in seconds.
    """

    points_m: Float[Array, "point 3"]
    radius_m: Float[Array, " point"]
    is_soft: Bool[Array, " point"]
    time_s: Float[Array, " point"]
    lowest_m: Float[Array, "22 3"]
    lowest_s: float

    @classmethod
    def of(cls, pose: PoseSequence) -> "BodySamples":
        """Samples a pose sequence in the radar's frame.

        Args:
            pose: The motion.
        """
        steps = np.arange(max(float(pose.time_s[0]), 0.0), float(pose.time_s[-1]), STEP_S)
        rows = np.unique(np.minimum(np.searchsorted(pose.time_s, steps), len(pose.time_s) - 1))
        joints = pose.joints_m[rows].astype(float)
        first, last = joints[:, _STARTS], joints[:, _ENDS].copy()
        along = last[:, _HAS_HAND] - first[:, _HAS_HAND]
        last[:, _HAS_HAND] += _HAND_M * along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-6)
        points = first[:, :, None] + _SHARES[:, None] * (last - first)[:, :, None]  # (row, limb, share, 3)
        shape = points.shape[:3]
        lowest = int(np.argmin(joints[:, joint("pelvis"), 2]))
        return cls(
            points_m=points.reshape(-1, 3),
            radius_m=np.broadcast_to(_RADII_M[:, None] * scale_of(pose.height_m) * pose.girth, shape).ravel(),
            is_soft=np.broadcast_to(_IS_SOFT[:, None], shape).ravel(),
            time_s=np.broadcast_to(pose.time_s[rows][:, None, None], shape).ravel(),
            lowest_m=joints[lowest],
            lowest_s=float(pose.time_s[rows][lowest]),
        )

    def deduplicated(self) -> "BodySamples":
        """Removes the points of limbs that have moved less than 1.5 cm since an earlier time."""
        each = len(_LIMB_ENDS) * len(_SHARES)
        cells = np.rint(self.points_m / _SAME_M).astype(np.int64)
        limb = np.arange(len(cells)) % each
        key = ((cells[:, 0] * 4096 + cells[:, 1]) * 4096 + cells[:, 2]) * each + limb
        _, one_each = np.unique(key, return_index=True)
        return self._select(np.sort(one_each))

    def every_second_time(self) -> "BodySamples":
        """Halves the sampling rate; `lowest_m` is kept."""
        _, index = self._times
        return self._select(np.flatnonzero(index % 2 == 0))

    def relative_to(self, path: RootPath) -> "BodySamples":
        """Transforms the points relative to the root of the path that the body follows: x ahead, y to its left.

        Args:
            path: Path of the body.
        """
        return self._moved(path, inverse=True)

    def along(self, path: RootPath) -> "BodySamples":
        """Transforms points relative to a root to another root path; exact if neither body moves over the floor.

        Args:
            path: Path of the other body.
        """
        return self._moved(path, inverse=False)

    def _moved(self, path: RootPath, *, inverse: bool) -> "BodySamples":
        time_s, index = self._times
        heading, root_m = path.facing_rad(time_s)[index], path.position_m(time_s)[index]
        at_lowest = np.array([self.lowest_s])
        args = (float(path.facing_rad(at_lowest)[0]), path.position_m(at_lowest)[0])
        transform = _into_root if inverse else _out_of_root
        return BodySamples(
            points_m=transform(self.points_m, heading, root_m),
            radius_m=self.radius_m,
            is_soft=self.is_soft,
            time_s=self.time_s,
            lowest_m=transform(self.lowest_m, *args),
            lowest_s=self.lowest_s,
        )

    @cached_property
    def _times(self) -> tuple[Float[Array, " time"], Int[Array, " point"]]:
        time_s, index = np.unique(self.time_s, return_inverse=True)
        return time_s, index

    def _select(self, chosen: Int[Array, " chosen"]) -> "BodySamples":
        return BodySamples(
            points_m=self.points_m[chosen],
            radius_m=self.radius_m[chosen],
            is_soft=self.is_soft[chosen],
            time_s=self.time_s[chosen],
            lowest_m=self.lowest_m,
            lowest_s=self.lowest_s,
        )

    @property
    def ahead(self) -> Float[Array, "2"]:
        """Unit vector (x, y) from the hips to the knees with the pelvis lowest: where a sitter faces."""
        at = self.lowest_m
        knees = at[joint("left_knee")] + at[joint("right_knee")]
        ahead = (knees - at[joint("left_hip")] - at[joint("right_hip")])[:2]
        return ahead / max(float(np.hypot(*ahead)), 1e-6)

    @property
    def pelvis_m(self) -> Float[Array, "3"]:
        """Pelvis (3,) at its lowest."""
        return self.lowest_m[joint("pelvis")]

    @property
    def trunk_m(self) -> Float[Array, "position 3"]:
        """Positions along the trunk with the pelvis lowest."""
        return _positions(self.lowest_m, _TRUNK)

    @property
    def legs_m(self) -> Float[Array, "position 3"]:
        """Positions along both legs with the pelvis lowest."""
        return np.concatenate([_positions(self.lowest_m, leg) for leg in _LEGS])


def _positions(joints: Float[Array, "22 3"], names: tuple[str, ...]) -> Float[Array, "position 3"]:
    ends = joints[[joint(name) for name in names]]
    return (ends[:-1] + _SHARES[:, None, None] * (ends[1:] - ends[:-1])).reshape(-1, 3)


def _into_root(points: Array, heading: Array | float, root_m: Array) -> Array:
    x, y = points[:, 0] - root_m[..., 0], points[:, 1] - root_m[..., 1]
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack([cos * x + sin * y, cos * y - sin * x, points[:, 2]], axis=-1)


def _out_of_root(points: Array, heading: Array | float, root_m: Array) -> Array:
    cos, sin = np.cos(heading), np.sin(heading)
    x, y = cos * points[:, 0] - sin * points[:, 1], sin * points[:, 0] + cos * points[:, 1]
    return np.stack([x + root_m[..., 0], y + root_m[..., 1], points[:, 2]], axis=-1)
