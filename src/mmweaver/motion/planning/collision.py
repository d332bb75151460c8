"""Collision test of a moving body with the photographed room: its limbs against measured points and walls."""

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
_SHARES = np.array([0.0, 0.33, 0.67, 1.0])  # where along a limb it is tested
_STEP_S = 0.1  # how often it is tested
_ALLOWED_M, _ON_SEAT_M = 0.01, 0.16  # tolerated penetration, and that of trunk and thighs into the seat they sit on
_SEAT_REACH_M = 0.65  # horizontal distance from a seat's centre within which a limb belongs to the sitter
_SEAT_AHEAD_M, _SEAT_BELOW_M = 0.12, 0.05  # points farther ahead of the pelvis and no lower are not the seat itself
_TABLE_BEHIND_M = 0.03  # extra distance to a table behind a sitter, whose edge may have been taken for a backrest
_ABOVE_ARMRESTS_M = 0.2  # above the pelvis: points next to the trunk are not the seat's there
_FARTHEST_M = 0.3  # thicker than any limb: points farther away need no distance
_FOOT_M, _WITHIN_M = 0.24, 0.01  # height of a foot; a point so near to a limb's axis lies within it
_LOWEST_M = 0.09  # points lower above the floor are floor: soles touch it
_MOST_POINTS = 34_000
_VOXEL_M, _VOXEL_KEYS = 0.015, np.array([1, 10_000, 100_000_000])  # one point is kept per voxel
_LOW_M, _LOW_DOWN_M = 0.64, (0.1, 0.17, 0.24)  # beds and low tables are solid: points are added at these depths below
_WALL_BEYOND_M, _WALL_DEPTH_M = 0.3, 0.6  # walls continue beyond what is seen of them; how deep one counts
_THICK_M = 0.04  # least thickness: of a table's top below its seen points, of a cupboard's front behind them


_latest: list["CollisionMap"] = []


@dataclass(frozen=True)
class CollisionMap:
    """What a body can collide with in a scene: measured points above the floor, inferred occluded geometry, walls."""

    scene: Scene

    @classmethod
    def of(cls, scene: Scene) -> "CollisionMap":
        """The map of a scene; the last one is cached, because many motions are tested in one scene."""
        if not _latest or _latest[0].scene is not scene:
            _latest[:] = [cls(scene)]
        return _latest[0]

    @cached_property
    def _measured_m(self) -> Float[Array, "point 3"]:
        """Points measured above the floor, in the radar's frame."""
        photo = self.scene.photo
        step = max(1, int(np.sqrt(photo.depth_m.size / _MOST_POINTS)))
        # Every row: a bed seen at a flat angle has few.
        points = AlignedPhoto.of(self.scene).points_m[:, ::step]
        points = points[photo.depth_m[:, ::step] > 0.3]
        return points[points[:, 2] > self.scene.floor_z_m + _LOWEST_M]

    @cached_property
    def _tops_m(self) -> Float[Array, "point 3"]:
        """Points of table tops, inferred ones included: unlike a backrest, nobody leans into them."""
        return table_tops(self.scene, self._measured_m)

    @cached_property
    def _legs_m(self) -> Float[Array, "point 3"]:
        """Points of upright structures such as table legs: unlike a seat, no thigh sinks into them."""
        return np.concatenate([upright_structures(self.scene, self._measured_m), table_legs(self.scene)])

    @cached_property
    def _solid_m(self) -> Float[Array, "point 3"]:
        """Measured points, and what must lie just behind and below them, one point per voxel."""
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
        _, one_each = np.unique(np.rint(solid / _VOXEL_M).astype(int) @ _VOXEL_KEYS, return_index=True)
        return solid[one_each]

    @cached_property
    def _tree(self) -> Any:
        """k-d tree of `_solid_m`."""
        from scipy.spatial import KDTree

        return KDTree(self._solid_m)

    @cached_property
    def _below_tops(self) -> Any:
        """k-d tree of the space below table tops, closed to everybody who does not sit there."""
        from scipy.spatial import KDTree

        return KDTree(below_tops(self.scene, self._tops_m))

    def _not_of_seat(self, pose: PoseSequence, seat: tuple[float, float]) -> tuple[tuple[Any, float], ...]:
        """k-d trees of points around a seat that are not the seat itself, each with an extra distance to keep.

        The first holds what lies ahead of the seat and above its surface, the second tables behind it.
        """
        from scipy.spatial import KDTree

        lowest = pose.joints_m[int(np.argmin(pose.joints_m[:, joint("pelvis"), 2]))].astype(float)
        knees = lowest[joint("left_knee")] + lowest[joint("right_knee")]
        ahead = (knees - lowest[joint("left_hip")] - lowest[joint("right_hip")])[:2]
        ahead = ahead / max(float(np.hypot(*ahead)), 1e-6)
        solid, tops, legs = (_about(points, seat) for points in (self._solid_m, self._tops_m, self._legs_m))
        along, height = (solid[:, :2] - np.array(seat)) @ ahead, solid[:, 2] - lowest[joint("pelvis"), 2]
        ahead_of = (along > _SEAT_AHEAD_M) & (height > -_SEAT_BELOW_M)
        next_to = (along > 0.0) & (height > _ABOVE_ARMRESTS_M)
        tops = tops[tops[:, 2] > lowest[joint("pelvis"), 2]]
        behind = (tops[:, :2] - np.array(seat)) @ ahead <= _SEAT_AHEAD_M
        legs = legs[(legs[:, :2] - np.array(seat)) @ ahead > _SEAT_AHEAD_M]
        hard = np.concatenate([solid[ahead_of | next_to], tops[~behind], legs])
        quick = {"balanced_tree": False, "compact_nodes": False}  # each tree is queried only once
        return (KDTree(hard, **quick), 0.0), (KDTree(tops[behind], **quick), _TABLE_BEHIND_M)

    def occluded_shares(self, pose: PoseSequence) -> tuple[float, float]:
        """With the pelvis lowest: the shares of the trunk occluded, and of the legs occluded or outside the photo."""
        lowest = pose.joints_m[int(np.argmin(pose.joints_m[:, joint("pelvis"), 2]))].astype(float)
        trunk = _along(lowest, "pelvis", "spine3", "neck")
        legs = [_along(lowest, f"{side}_hip", f"{side}_knee", f"{side}_ankle") for side in ("left", "right")]
        return occluded_share(self.scene, trunk), unseen_share(self.scene, np.concatenate(legs))

    def penetration_m(
        self, pose: PoseSequence, seats_m: Sequence[tuple[float, float]] = (), *, margin_m: float = 0.0
    ) -> float:
        """Greatest penetration depth in metres of the body, thickened by a margin, into anything; 0 where it is clear.

        Around the seats at `seats_m` trunk and thighs may sink into the surface, but not into a table ahead.
        """
        rows = np.unique(np.searchsorted(pose.time_s, np.arange(max(pose.time_s[0], 0.0), pose.time_s[-1], _STEP_S)))
        joints = pose.joints_m[np.minimum(rows, len(pose.time_s) - 1)].astype(float)
        scale = scale_of(pose.height_m)
        points, radius, soft = [], [], []
        for start, end, limb_radius_m in _LIMBS:
            first, last = joints[:, joint(start)], joints[:, joint(end)]
            if end.endswith("wrist"):
                along = last - first
                last = last + _HAND_M * along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-6)
            limb = first[None] * (1 - _SHARES[:, None, None]) + last[None] * _SHARES[:, None, None]
            points.append(limb.reshape(-1, 3))
            radius.append(np.full(limb.shape[0] * limb.shape[1], limb_radius_m * scale))
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
        """`penetration_m` of limb points (point, 3) with their radii in metres; `soft` ones may sink into seats."""
        allowed, worst = np.full(len(points), _ALLOWED_M - margin_m), 0.0
        sits = np.zeros(len(points), bool)
        for seat, tree, extra_m in tables:
            at_seat = np.hypot(points[:, 0] - seat[0], points[:, 1] - seat[1]) < _SEAT_REACH_M
            before, _ = tree.query(points[at_seat], distance_upper_bound=_FARTHEST_M)
            worst = max(worst, float((radius[at_seat] + extra_m - before - allowed[at_seat]).max(initial=0.0)))
            sits |= at_seat
        unknown, _ = self._below_tops.query(points[~sits], distance_upper_bound=_FARTHEST_M)
        worst = max(worst, float((radius[~sits] - unknown - allowed[~sits]).max(initial=0.0)))
        for seat, *_ in tables:
            at_seat = np.hypot(points[:, 0] - seat[0], points[:, 1] - seat[1]) < _SEAT_REACH_M
            allowed[at_seat] = np.where(soft[at_seat], _ON_SEAT_M, _ALLOWED_M - margin_m)
        distance, _ = self._tree.query(points, distance_upper_bound=_FARTHEST_M)
        worst = max(worst, float((radius - distance - allowed).max()))
        # Low furniture is filled with points, so the nearest one is near even deep inside: count the whole radius.
        within = (points[:, 2] < self.scene.floor_z_m + _FOOT_M) & (distance < _WITHIN_M)
        worst = max(worst, float((radius - allowed)[within].max(initial=0.0)) + _WITHIN_M if within.any() else 0.0)
        for plane in self.scene.planes:
            if plane.kind == "wall":
                away = points - plane.centre_m
                inside = np.abs(away @ plane.axis_u) < plane.half_size_m[0] + _WALL_BEYOND_M
                into = np.where(inside, radius - away @ plane.normal - allowed, 0.0)
                # Farther behind a wall is another room, seen through a door.
                worst = max(worst, float(into[into < _WALL_DEPTH_M].max(initial=0.0)))
        return worst


def _about(points: Float[Array, "point 3"], seat: tuple[float, float]) -> Float[Array, "near 3"]:
    """Points near enough to a seat to matter to a person sitting there."""
    points = points[np.abs(points[:, 0] - seat[0]) < _SEAT_REACH_M + _FARTHEST_M]
    return points[np.hypot(*(points[:, :2] - np.array(seat)).T) < _SEAT_REACH_M + _FARTHEST_M]


def _along(joints: Float[Array, "joint 3"], *names: str) -> Float[Array, "position 3"]:
    """Positions in metres along the bones between the named joints."""
    ends = np.stack([joints[joint(name)] for name in names])
    return np.concatenate([ends[:-1] + share * (ends[1:] - ends[:-1]) for share in _SHARES])
