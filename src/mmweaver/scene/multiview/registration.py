"""Registers photos of a room in the level frame of the first: common gravity, poses, corrections by the walls."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import FreeSpace, Landmark, Plane, Seat
from mmweaver.core.rotations import level_from_camera
from mmweaver.core.shapes import Array, Points, Rotation, Vec3
from mmweaver.scene.layout.gravity import Gravity
from mmweaver.scene.layout.height_map import nearest_squares
from mmweaver.scene.layout.room_layout import room_azimuth_rad
from mmweaver.scene.photo.capture_photo import PosedPhoto
from mmweaver.scene.single_view import SingleView


@dataclass(frozen=True, kw_only=True)
class LevelPose:
    """Transform from the level frame of a further camera to that of the first, where the radar stands at the origin."""

    turn: Rotation  # about the vertical
    position_m: Vec3  # of the further camera

    def points(self, points_m: Float[Array, "*points 3"]) -> Float[Array, "*points 3"]:
        """Transforms positions to the first camera's level frame.

        Args:
            points_m: Positions in this camera's level frame, metres, (..., 3).

        Returns:
            The same positions in the first camera's frame.
        """
        return points_m if self is ALONE else points_m @ self.turn.T + self.position_m

    def directions(self, vectors: Float[Array, "*points 3"]) -> Float[Array, "*points 3"]:
        """Rotates directions (..., 3) to the first camera's level frame."""
        return vectors @ self.turn.T

    def turned(self, angle_rad: float) -> "LevelPose":
        """The pose rotated about the vertical at the same position.

        Args:
            angle_rad: Angle in radians, counterclockwise seen from above.
        """
        return LevelPose(turn=about_vertical(angle_rad) @ self.turn, position_m=self.position_m)

    def moved(self, shift_m: Vec3) -> "LevelPose":
        """The pose shifted by `shift_m`, metres (3,), with the same orientation."""
        return LevelPose(turn=self.turn, position_m=self.position_m + shift_m)

    @property
    def inverse(self) -> "LevelPose":
        """Transform from the first camera's level frame to this one's."""
        return self if self is ALONE else LevelPose(turn=self.turn.T, position_m=-self.turn.T @ self.position_m)

    @property
    def azimuth_rad(self) -> float:
        """Rotation about the vertical, radians, counterclockwise seen from above."""
        return float(np.arctan2(self.turn[1, 0], self.turn[0, 0]))

    def plane(self, plane: Plane) -> Plane:
        """Transforms a plane to the first camera's level frame."""
        return plane if self is ALONE else plane.moved(self.points, self.directions)

    def seat(self, seat: Seat) -> Seat:
        """Transforms a seat to the first camera's level frame."""
        if self is ALONE:
            return seat
        facing_rad = _wrapped(seat.facing_rad + self.azimuth_rad)
        return Seat(position_m=self.points(seat.position_m), facing_rad=facing_rad, size_m=seat.size_m)

    def landmark(self, landmark: Landmark) -> Landmark:
        """Transforms a landmark, its approach included, to the first camera's level frame."""
        if self is ALONE:
            return landmark
        x, y, _ = self.points(np.array([*landmark.approach_m, 0.0]))
        return Landmark(
            kind=landmark.kind,
            position_m=self.points(landmark.position_m),
            approach_m=(float(x), float(y)),
            facing_rad=_wrapped(landmark.facing_rad + self.azimuth_rad),
        )

    def looked_up(self, values: np.ndarray, of: FreeSpace, x_m: np.ndarray, y_m: np.ndarray) -> np.ndarray:
        """Resamples a floor map of this camera at the squares of the first camera's map.

        Args:
            values: Boolean map of this camera, (y, x).
            of: Free space whose axes `values` has.
            x_m: Centres of the first camera's columns, metres.
            y_m: Centres of the first camera's rows, metres.

        Returns:
            Values on the first camera's grid, (y, x); False outside this camera's map.
        """
        x, y = np.meshgrid(x_m, y_m)
        own = self.inverse.points(np.stack([x, y, np.zeros_like(x)], axis=-1))
        row, column, inside = nearest_squares(own[..., 0], own[..., 1], of.x_m, of.y_m)
        return inside & values[row, column]


AT_FIRST, ALONE = (LevelPose(turn=np.eye(3), position_m=np.zeros(3)) for _ in range(2))  # ALONE keeps bits unchanged


def about_vertical(angle_rad: float) -> Rotation:
    """Rotation matrix (3, 3) about the vertical, counterclockwise seen from above."""
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _wrapped(angle_rad: float) -> float:
    return float(np.angle(np.exp(1j * angle_rad)))


SAME_UP = np.cos(np.deg2rad(3.0))  # upward directions of two photos agree
MAX_TURN_RAD = {True: np.deg2rad(20.0), False: np.deg2rad(3.0)}  # correction limit; key: is the pose rough
SPREAD_M = {True: 0.15, False: 0.03}  # standard deviation of a pose's position; key: as above
PARALLEL = np.cos(np.deg2rad(6.0))
SAME_PLANE_M, STEP_M = 0.03, 0.01
GAP_M = 0.5  # between planes that may be parts of one wall
MIN_AREA_M2 = 0.2  # of planes that must agree on a shift


def common_gravity(
    own: Sequence[Gravity], others: Sequence[PosedPhoto]
) -> tuple[tuple[Gravity, ...], tuple[LevelPose, ...]]:
    """Combines the gravity estimates of several photos whose relative poses are known.

    Up is the mean of the upward directions that agree, the floor's height the median of the visible floors. Photos with
    a rough pose keep their own gravity.

    Args:
        own: Gravity estimated from each photo alone, the first photo first.
        others: Photos from the second on, with poses relative to the first.

    Returns:
        Gravity of every photo, the first photo first; and the level poses of `others`.

    Raises:
        InputError: If a photo lies below the floor by its pose.
    """
    exact = {index + 1: one.pose for index, one in enumerate(others) if not isinstance(one.pose, RadarPose)}
    rotations = {0: np.eye(3), **{index: pose[:3, :3] for index, pose in exact.items()}}
    seen = {index: rotations[index] @ own[index].up_camera for index in rotations if own[index].has_floor}
    up = _agreed(list(seen.values())) if seen else own[0].up_camera
    level = level_from_camera(up)
    places: dict[int, Vec3] = {0: np.zeros(3)} | {index: level @ pose[:3, 3] for index, pose in exact.items()}
    floors = [places[index][2] + own[index].floor_z_m for index in seen]
    floor_z_m = float(np.median(floors)) if floors else own[0].floor_z_m
    has_floor = bool(floors)
    first = replace(
        own[0], up_camera=up, floor_z_m=floor_z_m, has_floor=has_floor, assumptions=() if floors else own[0].assumptions
    )
    gravities, poses = [first], []
    for index, one in enumerate(others, 1):
        if isinstance(one.pose, RadarPose):
            gravity, pose = _rough_pose(own[index], one.pose, first)
        else:
            own_up = rotations[index].T @ up
            turn = level @ rotations[index] @ level_from_camera(own_up).T
            gravity = Gravity(
                up_camera=own_up, floor_z_m=floor_z_m - float(places[index][2]), has_floor=has_floor, assumptions=()
            )
            pose = LevelPose(turn=turn, position_m=places[index])
        if gravity.floor_z_m > -0.05:
            raise InputError(f"photo {index + 1} was taken below the floor, by its pose; are the poses in metres?")
        gravities.append(gravity)
        poses.append(pose)
    return tuple(gravities), tuple(poses)


def _agreed(ups: list[Vec3]) -> Vec3:
    """The mean of the upward directions that agree with most others."""
    all_of_them = np.array(ups)
    agree = all_of_them @ all_of_them.T > SAME_UP
    mean = all_of_them[agree[int(np.argmax(agree.sum(axis=1)))]].mean(axis=0)
    return mean / np.linalg.norm(mean)


def _rough_pose(own: Gravity, given: RadarPose, first: Gravity) -> tuple[Gravity, LevelPose]:
    """Gravity and level pose where only position and yaw are known: heights follow from the floors."""
    both = own.has_floor and first.has_floor
    height_m = first.floor_z_m - own.floor_z_m if both else given.z_m
    floor_z_m = own.floor_z_m if both else first.floor_z_m - given.z_m
    position_m = np.array([given.x_m, given.y_m, height_m])
    turn = about_vertical(-np.deg2rad(given.yaw_deg))  # to the right is clockwise
    gravity = replace(own, floor_z_m=floor_z_m, has_floor=own.has_floor or first.has_floor)
    return gravity, LevelPose(turn=turn, position_m=position_m)


def turned_by_walls(pose: LevelPose, planes: Sequence[Plane], known: Sequence[Plane], *, is_rough: bool) -> LevelPose:
    """Corrects a pose's yaw so that the photo's vertical planes are parallel or perpendicular to the known ones.

    Args:
        pose: Level pose of the photo.
        planes: Planes in the photo's own level frame.
        known: Planes in the first camera's level frame.
        is_rough: Allows a correction of 20 instead of 3 degrees.

    Returns:
        The corrected pose; unchanged if the planes of either set disagree, or the correction would be larger.
    """
    known_rad = room_azimuth_rad(known)
    own_rad = room_azimuth_rad([pose.plane(one) for one in planes])
    if own_rad is None or known_rad is None:
        return pose
    turn_rad = float(np.angle(np.exp(4j * (known_rad - own_rad)))) / 4
    return pose.turned(turn_rad) if abs(turn_rad) < MAX_TURN_RAD[is_rough] else pose


def moved_by_walls(pose: LevelPose, planes: Sequence[Plane], known: Sequence[Plane], *, is_rough: bool) -> LevelPose:
    """Corrects a pose's position so that the photo's vertical planes coincide with the known ones.

    Planes that nearly coincide vote for the shift along each of the room's two axes.

    Args:
        pose: Level pose of the photo.
        planes: Planes in the photo's own level frame.
        known: Planes in the first camera's level frame.
        is_rough: Expects a position error of 0.15 instead of 0.03 m (standard deviation).

    Returns:
        The shifted pose; unchanged if the room has no common axes or too little area agrees.
    """
    known_rad = room_azimuth_rad(known)
    if known_rad is None:
        return pose
    placed, shift_m = [pose.plane(one) for one in planes], np.zeros(3)
    for axis in about_vertical(known_rad).T[:2]:
        shift_m += _shift_m(placed, known, axis, SPREAD_M[is_rough]) * axis
    return pose.moved(shift_m)


def _shift_m(planes: Sequence[Plane], known: Sequence[Plane], axis: Vec3, spread_m: float) -> float:
    """The shift along an axis for which most area of planes lies on that of known ones, metres."""
    gaps_m, area_m2 = [], []
    for plane in planes:
        if abs(plane.normal @ axis) < PARALLEL:
            continue
        for other in known:
            gap_m = float((other.centre_m - plane.centre_m) @ axis)
            if other.normal @ plane.normal > PARALLEL and abs(gap_m) < 3 * spread_m and _overlap(plane, other, axis):
                gaps_m.append(gap_m)
                area_m2.append(min(plane.area_m2, other.area_m2))
    shift_m = np.arange(-3 * spread_m, 3 * spread_m, STEP_M)
    if not gaps_m:
        return 0.0
    votes = np.exp(-(((shift_m[:, None] - np.array(gaps_m)) / SAME_PLANE_M) ** 2) / 2) @ np.array(area_m2)
    votes *= np.exp(-((shift_m / spread_m) ** 2) / 2)
    return float(shift_m[int(np.argmax(votes))]) if votes.max() > MIN_AREA_M2 else 0.0


def _overlap(plane: Plane, other: Plane, axis: Vec3) -> bool:
    """Whether two upright planes across an axis lie before one another, or nearly."""
    along = np.cross((0.0, 0.0, 1.0), axis)
    reach_m = sum(
        abs(one.axis_u @ along) * one.half_size_m[0] + abs(one.axis_v @ along) * one.half_size_m[1]
        for one in (plane, other)
    )
    return bool(abs((other.centre_m - plane.centre_m) @ along) < reach_m + GAP_M)


CELL_M, REACH_M = 0.05, 8.0
SAME_HEIGHT_M = 0.06
MIN_HEIGHT_M = 0.15  # above the floor; lower points are floor
FLOOR_WEIGHT = 0.2  # of cells where both show the floor, which is uninformative
MIN_CELLS = 150  # seen by both, floor excepted


def height_map(points_m: Points, floor_z_m: float) -> Float[Array, "y x"]:
    """Height of the highest point above each square of 5 cm, 16 x 16 m around the origin.

    Args:
        points_m: Points in metres, z up, (point, 3); nan is skipped.
        floor_z_m: Height of the floor in the same frame, metres.

    Returns:
        Metres above the floor, (y, x); 0 below 0.15 m, nan where nothing was measured.
    """
    side = int(2 * REACH_M / CELL_M)
    points_m = points_m[np.isfinite(points_m).all(axis=1)]
    column, row = (np.floor((points_m[:, axis] + REACH_M) / CELL_M).astype(int) for axis in (0, 1))
    inside = (column >= 0) & (column < side) & (row >= 0) & (row < side)
    found = np.full(side * side, -np.inf)
    np.maximum.at(found, row[inside] * side + column[inside], points_m[inside, 2] - floor_z_m)
    found[np.abs(found) < MIN_HEIGHT_M] = 0.0
    return np.where(np.isfinite(found), found, np.nan).reshape(side, side)


def shift_by_heights(own: Float[Array, "y x"], known: Float[Array, "y x"], spread_m: float) -> Vec3:
    """Horizontal shift that aligns a height map with a known one, by exhaustive search.

    Squares of equal height count for a shift, squares of other heights against it, with a Gaussian prior on its length.

    Args:
        own: Height map of the photo in metres, (y, x).
        known: Height map of the earlier photos on the same grid.
        spread_m: Standard deviation of the expected shift in metres.

    Returns:
        Shift in metres, (3,); zero if too few squares agree.
    """
    steps = range(-int(2.5 * spread_m / CELL_M), int(2.5 * spread_m / CELL_M) + 1)
    best, shift = -np.inf, (0, 0)
    for rows in steps:
        for columns in steps:
            moved = np.roll(own, (rows, columns), axis=(0, 1))
            both = np.isfinite(moved) & np.isfinite(known)
            a, b = moved[both], known[both]
            is_same = np.abs(a - b) < SAME_HEIGHT_M
            is_floor = (a == 0) & (b == 0)
            agree = (is_same & ~is_floor).sum()
            score = agree + FLOOR_WEIGHT * is_floor.sum() - 0.5 * (~is_same).sum()
            score -= 0.5 * MIN_CELLS * ((rows**2 + columns**2) * CELL_M**2) / spread_m**2
            if score > best and agree > MIN_CELLS:
                best, shift = score, (rows, columns)
    return np.array([shift[1] * CELL_M, shift[0] * CELL_M, 0.0])


def corrected_poses(
    seen: Sequence[SingleView], poses: Sequence[LevelPose], others: Sequence[PosedPhoto]
) -> tuple[LevelPose, ...]:
    """Refines the level pose of every photo by the planes and heights of the photos before it.

    Args:
        seen: The room as each photo shows it.
        poses: Level poses of the photos from the second on.
        others: The same photos with their original poses, which may be rough.

    Returns:
        The level pose of every photo, the first photo first.
    """
    placed, known, floor_z_m = [AT_FIRST], list(seen[0].planes), seen[0].view.floor_z_m
    heights = _heights(seen[0], AT_FIRST, floor_z_m)
    for one, pose, other in zip(seen[1:], poses, others, strict=True):
        pose = turned_by_walls(pose, one.planes, known, is_rough=other.is_rough)
        if other.is_rough:
            pose = pose.moved(shift_by_heights(_heights(one, pose, floor_z_m), heights, SPREAD_M[True]))
        pose = moved_by_walls(pose, one.planes, known, is_rough=False)
        placed.append(pose)
        known += [pose.plane(plane) for plane in one.planes]
        heights = np.fmax(heights, _heights(one, pose, floor_z_m))
    return tuple(placed)


def _heights(one: SingleView, pose: LevelPose, floor_z_m: float) -> Float[Array, "y x"]:
    return height_map(pose.points(one.room.grid.points_m.reshape(-1, 3)), floor_z_m)
