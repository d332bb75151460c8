"""Whether a moving body meets what the photo shows: its limbs against the measured points and the walls."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.skeleton import JOINT_NAMES, PARENTS, joint
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.geometry.body_capsules import capsule_between, part_of, scale_of
from mmweaver.motion.planning.occluded_geometry import (
    below_tops,
    extended_to_floor,
    occluded_share,
    table_legs,
    table_tops,
    unseen_share,
    upright_structures,
)

Array = np.ndarray
# Limbs are tested as cylinders between two joints; each has one radius.
_LIMB_ENDS = (
    ("pelvis", "spine3"), ("spine3", "neck"), ("neck", "head"), ("left_hip", "right_hip"),
    ("left_collar", "left_shoulder"), ("right_collar", "right_shoulder"),
    ("left_hip", "left_knee"), ("right_hip", "right_knee"), ("left_knee", "left_ankle"), ("right_knee", "right_ankle"),
    ("left_ankle", "left_foot"), ("right_ankle", "right_foot"),
    ("left_shoulder", "left_elbow"), ("right_shoulder", "right_elbow"),
    ("left_elbow", "left_wrist"), ("right_elbow", "right_wrist"),
)  # fmt: skip
# Where a mean of the capsules is too thin: the shoulder blades, and a head wider than the neck that carries it.
_THICKER_M = {"neck": 0.02, "head": 0.015, "shoulder": 0.005}
_RADIUS_STEP_M = 0.005  # mean radii are rounded up to it


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


_LIMBS = tuple((start, end, _limb_radius_m(start, end)) for start, end in _LIMB_ENDS)
_HAND_M = capsule_between("left_wrist", "left_wrist").extend_m + 0.03  # beyond the wrist, most of its round tip too
_SEATED = ("pelvis", "spine3", "left_hip", "right_hip", "left_collar", "right_collar")
_SHARES = np.array([0.0, 0.33, 0.67, 1.0])
_STEP_S = 0.1
_ALLOWED_M, _ON_SEAT_M, _SEAT_REACH_M = 0.01, 0.16, 0.65
_SEAT_AHEAD_M, _SEAT_UNDER_M = 0.12, 0.05  # before the pelvis, and no lower below it: not the seat itself
_BEHIND_M = 0.03  # who sits with a table behind may have taken its edge for a back
_OVER_ARMRESTS_M = 0.2  # over the pelvis: what is beside the trunk there is not the seat's either
_FARTHEST_M = 0.3
_FOOT_M, _WITHIN_M = 0.24, 0.01
_LOWEST_M = 0.09  # above the floor: soles meet the floor
_MOST_POINTS = 34_000
_GRAIN_M, _GRAINS = 0.015, np.array([1, 10_000, 100_000_000])  # one point in each
_LOW_M, _LOW_DOWN_M = 0.64, (0.1, 0.17, 0.24)  # beds and low tables: nobody's knees are inside or under them
_THICK_M = 0.04  # at least, of anything: a table's top below the points seen on it, a cupboard's front behind them


_latest: list["CollisionMap"] = []


@dataclass(frozen=True)
class CollisionMap:
    """The measured points of a scene above its floor, and its walls."""

    scene: Scene

    @classmethod
    def of(cls, scene: Scene) -> "CollisionMap":
        """Those of a scene; the last scene's are kept, for what it holds is gathered once for many motions."""
        if not _latest or _latest[0].scene is not scene:
            _latest[:] = [cls(scene)]
        return _latest[0]

    @cached_property
    def _measured_m(self) -> Float[Array, "point 3"]:
        """What was measured above the floor."""
        photo = self.scene.photo
        step = max(1, int(np.sqrt(photo.depth_m.size / _MOST_POINTS)))
        # Every row: a bed seen at a flat angle has few.
        points = AlignedPhoto.of(self.scene).points_m[:, ::step]
        points = points[photo.depth_m[:, ::step] > 0.3]
        return points[points[:, 2] > self.scene.floor_z_m + _LOWEST_M]

    @cached_property
    def _tops_m(self) -> Float[Array, "point 3"]:
        """Of tables, also where a top hides itself: nobody's trunk leans into them as into the back of a seat."""
        return table_tops(self.scene, self._measured_m)

    @cached_property
    def _legs_m(self) -> Float[Array, "point 3"]:
        """Upright things, tables' legs among them: no thigh sinks into those as into a seat."""
        return np.concatenate([upright_structures(self.scene, self._measured_m), table_legs(self.scene)])

    @cached_property
    def _solid_m(self) -> Float[Array, "point 3"]:
        """What was measured above the floor, and what must be just behind and under it."""
        points = self._measured_m
        behind = points * (1 + _THICK_M / np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-6))
        low = points[points[:, 2] < self.scene.floor_z_m + _LOW_M]
        below = [points - np.array([0.0, 0.0, _THICK_M])]
        below += [low - np.array([0.0, 0.0, down]) for down in _LOW_DOWN_M]
        solid = np.concatenate([points, behind, self._tops_m, *below])
        solid = solid[solid[:, 2] > self.scene.floor_z_m + _LOWEST_M]
        solid = np.concatenate(
            [solid, extended_to_floor(np.concatenate([points, behind]), self.scene.floor_z_m), table_legs(self.scene)]
        )
        _, one_each = np.unique(np.rint(solid / _GRAIN_M).astype(int) @ _GRAINS, return_index=True)
        return solid[one_each]

    @cached_property
    def _tree(self) -> Any:
        """For the nearest point."""
        from scipy.spatial import KDTree

        return KDTree(self._solid_m)

    @cached_property
    def _below_tops(self) -> Any:
        """For the nearest point that may be something under a table's top, for whoever does not sit there."""
        from scipy.spatial import KDTree

        return KDTree(below_tops(self.scene, self._tops_m))

    def _not_of_seat(self, pose: PoseSequence, seat: tuple[float, float]) -> tuple[tuple[Any, float], ...]:
        """For the nearest point about a seat that is not the seat's own: what is before it, above its surface, and
        tables behind it. With each how far the body must keep from it besides.
        """
        from scipy.spatial import KDTree

        lowest = pose.joints_m[int(np.argmin(pose.joints_m[:, joint("pelvis"), 2]))].astype(float)
        knees = lowest[joint("left_knee")] + lowest[joint("right_knee")]
        ahead = (knees - lowest[joint("left_hip")] - lowest[joint("right_hip")])[:2]
        ahead = ahead / max(float(np.hypot(*ahead)), 1e-6)
        solid, tops, legs = (_about(points, seat) for points in (self._solid_m, self._tops_m, self._legs_m))
        along, height = (solid[:, :2] - np.array(seat)) @ ahead, solid[:, 2] - lowest[joint("pelvis"), 2]
        before = (along > _SEAT_AHEAD_M) & (height > -_SEAT_UNDER_M)
        beside = (along > 0.0) & (height > _OVER_ARMRESTS_M)
        tops = tops[tops[:, 2] > lowest[joint("pelvis"), 2]]
        behind = (tops[:, :2] - np.array(seat)) @ ahead <= _SEAT_AHEAD_M
        legs = legs[(legs[:, :2] - np.array(seat)) @ ahead > _SEAT_AHEAD_M]
        hard = np.concatenate([solid[before | beside], tops[~behind], legs])
        quick = {"balanced_tree": False, "compact_nodes": False}  # each is asked but once
        return (KDTree(hard, **quick), 0.0), (KDTree(tops[behind], **quick), _BEHIND_M)

    def occluded_shares(self, pose: PoseSequence) -> tuple[float, float]:
        """Where the pelvis is lowest: how much of the trunk is hidden, and of the legs hidden or outside the photo."""
        lowest = pose.joints_m[int(np.argmin(pose.joints_m[:, joint("pelvis"), 2]))].astype(float)
        trunk = _along(lowest, "pelvis", "spine3", "neck")
        legs = [_along(lowest, f"{side}_hip", f"{side}_knee", f"{side}_ankle") for side in ("left", "right")]
        return occluded_share(self.scene, trunk), unseen_share(self.scene, np.concatenate(legs))

    def penetration_m(
        self, pose: PoseSequence, seats_m: Sequence[tuple[float, float]] = (), *, margin_m: float = 0.0
    ) -> float:
        """How far the body, thicker by a margin, gets into anything, at worst; 0 where it stays clear.

        About the places of `seats_m` trunk and thighs may sink in, for they sit there, but not into a table before it.
        """
        rows = np.unique(np.searchsorted(pose.time_s, np.arange(max(pose.time_s[0], 0.0), pose.time_s[-1], _STEP_S)))
        joints = pose.joints_m[np.minimum(rows, len(pose.time_s) - 1)].astype(float)
        scale = scale_of(pose.height_m)
        points, radius, soft = [], [], []
        for start, end, thick in _LIMBS:
            first, last = joints[:, joint(start)], joints[:, joint(end)]
            if end.endswith("wrist"):
                along = last - first
                last = last + _HAND_M * along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-6)
            limb = first[None] * (1 - _SHARES[:, None, None]) + last[None] * _SHARES[:, None, None]
            points.append(limb.reshape(-1, 3))
            radius.append(np.full(limb.shape[0] * limb.shape[1], thick * scale))
            soft.append(np.full(limb.shape[0] * limb.shape[1], start in _SEATED))
        limbs = np.concatenate(points), np.concatenate(radius), np.concatenate(soft)
        tables = [(seat, *near) for seat in dict.fromkeys(seats_m) for near in self._not_of_seat(pose, seat)]
        return self._worst(*limbs, tables, margin_m)

    def _worst(
        self,
        points: Float[Array, "point 3"],
        radius: Float[Array, " point"],
        soft: np.ndarray,
        tables: Sequence[tuple[tuple[float, float], Any, float]],
        margin_m: float,
    ) -> float:
        allowed, worst = np.full(len(points), _ALLOWED_M - margin_m), 0.0
        sits = np.zeros(len(points), bool)
        for seat, tree, besides_m in tables:
            at_seat = np.hypot(points[:, 0] - seat[0], points[:, 1] - seat[1]) < _SEAT_REACH_M
            before, _ = tree.query(points[at_seat], distance_upper_bound=_FARTHEST_M)
            worst = max(worst, float((radius[at_seat] + besides_m - before - allowed[at_seat]).max(initial=0.0)))
            sits |= at_seat
        unknown, _ = self._below_tops.query(points[~sits], distance_upper_bound=_FARTHEST_M)
        worst = max(worst, float((radius[~sits] - unknown - allowed[~sits]).max(initial=0.0)))
        for seat, *_ in tables:
            at_seat = np.hypot(points[:, 0] - seat[0], points[:, 1] - seat[1]) < _SEAT_REACH_M
            allowed[at_seat] = np.where(soft[at_seat], _ON_SEAT_M, _ALLOWED_M - margin_m)
        distance, _ = self._tree.query(points, distance_upper_bound=_FARTHEST_M)
        worst = max(worst, float((radius - distance - allowed).max()))
        # Points lie in low things as thickly as on them: a foot within one would be no deeper in than it is thick.
        within = (points[:, 2] < self.scene.floor_z_m + _FOOT_M) & (distance < _WITHIN_M)
        worst = max(worst, float((radius - allowed)[within].max(initial=0.0)) + _WITHIN_M if within.any() else 0.0)
        for plane in self.scene.planes:
            if plane.kind == "wall":
                away = points - plane.centre_m
                inside = np.abs(away @ plane.axis_u) < plane.half_size_m[0] + 0.3
                into = np.where(inside, radius - away @ plane.normal - allowed, 0.0)
                # Far behind a wall is another room seen through a door.
                worst = max(worst, float(into[into < 0.6].max(initial=0.0)))
        return worst


def _about(points: Float[Array, "point 3"], seat: tuple[float, float]) -> Float[Array, "near 3"]:
    """Those that can matter to who sits there."""
    points = points[np.abs(points[:, 0] - seat[0]) < _SEAT_REACH_M + _FARTHEST_M]
    return points[np.hypot(*(points[:, :2] - np.array(seat)).T) < _SEAT_REACH_M + _FARTHEST_M]


def _along(joints: Float[Array, "joint 3"], *names: str) -> Float[Array, "place 3"]:
    """Places along the bones from joint to joint."""
    ends = np.stack([joints[joint(name)] for name in names])
    return np.concatenate([ends[:-1] + share * (ends[1:] - ends[:-1]) for share in _SHARES])
