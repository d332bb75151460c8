"""Collision test of a moving body with the photographed room: its limbs against measured points and walls.

Distance to the nearest of many points, tabulated on a grid, so that a query is an interpolation.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.records import Plane, PoseSequence, Scene
from mmweaver.core.shapes import Points
from mmweaver.motion.planning.body_samples import BodySamples
from mmweaver.motion.planning.floor_map import distances_m, unit_vector
from mmweaver.motion.planning.occluded_geometry import (
    below_tops,
    extended_to_floor,
    low_gap_points,
    table_legs,
    table_tops,
    upright_structures,
)

Array = np.ndarray
CELL_M = 0.05
FARTHEST_M = 0.4  # distances are truncated here: thicker than any limb


@dataclass(frozen=True, kw_only=True)
class DistanceField:
    """Distances in metres at the centres of cubic cells, (x, y, z); outside the grid nothing is near."""

    low_m: Float[Array, "3"]  # corner of the grid
    distance_m: Float[Array, "x y z"]
    points_m: Float[Array, "occupied 3"]  # mean of the points in each occupied cell

    def at(self, positions_m: Float[Array, "*shape 3"]) -> Float[Array, "*shape"]:
        """Distance to the nearest point by trilinear interpolation.

        Args:
            positions_m: Positions in metres, (..., 3).

        Returns:
            Metres, truncated at `FARTHEST_M`.
        """
        from scipy.ndimage import map_coordinates

        cells = np.moveaxis((positions_m - self.low_m) / CELL_M - 0.5, -1, 0)
        return np.asarray(map_coordinates(self.distance_m, cells, order=1, cval=FARTHEST_M))


def distance_field(points_m: Points, low_m: Float[Array, "3"], high_m: Float[Array, "3"]) -> DistanceField:
    """Tabulates the distance to points in a box.

    A cell's distance is that to the mean of the points in the nearest occupied cell, which is exact to a third of a
    cell; a coarse grid thus resolves surfaces finer than itself.

    Args:
        points_m: Points in metres, (point, 3).
        low_m: Lower corner of the box, metres.
        high_m: Upper corner of the box, metres.

    Returns:
        The field, in cells of 5 cm.
    """
    from scipy.ndimage import distance_transform_edt

    shape = tuple(int(n) for n in np.ceil((high_m - low_m) / CELL_M))
    cells = np.floor((points_m - low_m) / CELL_M).astype(int)
    inside = ((cells >= 0) & (cells < shape)).all(axis=1)
    flat = np.ravel_multi_index(tuple(cells[inside].T), shape)
    count = np.bincount(flat, minlength=int(np.prod(shape)))
    occupied = np.flatnonzero(count)
    if not len(occupied):
        return DistanceField(low_m=low_m, distance_m=np.full(shape, FARTHEST_M, np.float32), points_m=np.zeros((0, 3)))
    sums = [np.bincount(flat, weights=points_m[inside, axis], minlength=len(count))[occupied] for axis in range(3)]
    means_m = np.stack(sums, axis=1) / count[occupied, None]
    number = np.zeros(len(count), np.int32)
    number[occupied] = np.arange(len(occupied))
    nearest = distance_transform_edt((count == 0).reshape(shape), return_distances=False, return_indices=True)
    assert nearest is not None
    nearest_mean = number.reshape(shape)[tuple(nearest)]
    squared = np.zeros(shape, np.float32)
    for axis in range(3):
        centre = (low_m[axis] + CELL_M * (np.arange(shape[axis]) + 0.5)).astype(np.float32)
        away = means_m[:, axis].astype(np.float32)[nearest_mean]
        away -= centre.reshape([-1 if other == axis else 1 for other in range(3)])
        squared += np.square(away, out=away)
    distance_m = np.minimum(np.sqrt(squared, out=squared), np.float32(FARTHEST_M))
    return DistanceField(low_m=low_m, distance_m=distance_m, points_m=means_m)


def thinned(points_m: Points) -> Float[Array, "cell 3"]:
    """Mean of the points in each occupied cell of 5 cm.

    Args:
        points_m: Points in metres, (point, 3).

    Returns:
        One point per occupied cell, (cell, 3).
    """
    if not len(points_m):
        return points_m
    cells = np.floor(points_m / CELL_M).astype(np.int64)
    keys = (cells[:, 0] * 100_000 + cells[:, 1]) * 100_000 + cells[:, 2]
    _, cell, count = np.unique(keys, return_inverse=True, return_counts=True)
    sums = [np.bincount(cell, weights=points_m[:, axis]) for axis in range(3)]
    return np.stack(sums, axis=1) / count[:, None]


def interior(field: DistanceField) -> Bool[Array, "x y z"]:
    """Occupied cells whose four neighbours on the same level are occupied too: the inside of solid objects.

    Args:
        field: Distance field.

    Returns:
        Mask of the field's cells, (x, y, z).
    """
    from scipy.ndimage import binary_erosion

    cells = np.floor((field.points_m - field.low_m) / CELL_M).astype(int)
    occupied = np.zeros(field.distance_m.shape, bool)
    occupied[tuple(cells.T)] = True
    cross = np.zeros((3, 3, 3), bool)
    cross[:, 1, 1] = cross[1, :, 1] = True
    return np.asarray(binary_erosion(occupied, cross))


Place = tuple[float, float]
_ALLOWED_M, _ON_SEAT_M = 0.01, 0.16  # tolerated penetration, and that of trunk and thighs into the seat they sit on
_SEAT_REACH_M = 0.65  # horizontal distance from a seat's centre within which a limb belongs to the sitter
_SEAT_SQUARE_M = 0.4  # seats in one square share the points around them
_SEAT_AHEAD_M, _SEAT_BELOW_M = 0.12, 0.05  # points farther ahead of the pelvis and no lower do not belong to the seat
_TABLE_BEHIND_M = 0.03  # extra distance to a table behind a sitter, whose edge may be mistaken for a backrest
_EDGE_M = 0.02  # and to objects ahead: the last visible points of an edge lie this far inside it
_ABOVE_ARMRESTS_M = 0.2  # above the pelvis: points next to the trunk do not belong to the seat
_SHIN_M = 0.45  # height of foot and shin of a sitter
_LOWEST_M = 0.09  # lower points are floor, which the soles touch
_ABOUT_SEAT_M = 0.15  # radius around a seat within which its height is measured
_SHIN_TOP_M, _MAX_SHIN_SHARE = 0.2, 0.5  # lower objects and smaller shares are no mattress
_MAX_POINTS = 34_000
_LOW_M = 0.64  # beds and low tables are solid: points are added below theirs at these depths
_LOW_DOWN_M = (0.05, 0.1, 0.15, 0.2, 0.25)
_HALF_CHAIR_M, _BACK_BEHIND_M, _CHAIR_TOP_M = 0.32, 0.05, 1.1
_FRONT_AHEAD_M, _FRONT_TOP_M = 0.05, 0.66  # a chair is no higher ahead of its middle: armrests end, tables begin
_NEAR_CHAIR_M = 1.3  # radius evaluated without the chair
_WALL_BEYOND_M, _WALL_DEPTH_M = 0.3, 0.6  # extension of walls beyond their visible part; depth of a wall
_THICK_M = 0.04  # minimum thickness of a table top below its points, and of a front behind them
# Tabulated part of the room; the floor map covers no range window beyond it.
_SIDE_M, _AWAY_M, _HIGHEST_M = 3.4, (-0.3, 5.4), 2.5

_latest: list["CollisionMap"] = []


@dataclass(frozen=True)
class PulledChair:
    """A chair assumed to be pulled out.

    Attributes:
        place_m: Position (x, y) in the photo in metres.
        facing_rad: Heading of the chair, from +x towards +y.
        by_m: Distance in metres by which it is pulled back; not compared, since the room without it does not depend on
            it.
    """

    place_m: Place
    facing_rad: float
    by_m: float = field(compare=False)

    def holds(self, points_m: Float[Array, "point 3"], floor_z_m: float) -> Bool[Array, " point"]:
        """Whether points belong to the chair in the photo; points ahead above the armrests belong to a table.

        Args:
            points_m: Points in the radar's frame, metres, (point, 3).
            floor_z_m: Height of the floor, metres.

        Returns:
            Mask (point,).
        """
        top_m = np.where(self._is_front(points_m), _FRONT_TOP_M, _CHAIR_TOP_M)
        return self.covers(points_m[:, :2]) & (points_m[:, 2] < floor_z_m + top_m)

    def has_back_at(self, points_m: Float[Array, "point 3"], floor_z_m: float) -> Bool[Array, " point"]:
        """Whether points belong to the chair's back and rear legs, which are upright like table legs.

        Args:
            points_m: Points in the radar's frame, metres, (point, 3).
            floor_z_m: Height of the floor, metres.

        Returns:
            Mask (point,).
        """
        return self.holds(points_m, floor_z_m) & ~self._is_front(points_m)

    def _is_front(self, points_m: Float[Array, "point 3"]) -> Bool[Array, " point"]:
        ahead = unit_vector(self.facing_rad)
        return np.asarray((points_m[:, :2] - np.array(self.place_m)) @ ahead > _FRONT_AHEAD_M)

    def covers(self, places_m: Float[Array, "*shape 2"]) -> Bool[Array, "*shape"]:
        """Whether the chair covers positions where it stands in the photo.

        Args:
            places_m: Positions (x, y) in metres, (..., 2).

        Returns:
            Mask of the positions.
        """
        away = places_m - np.array(self.place_m)
        cos, sin = np.cos(self.facing_rad), np.sin(self.facing_rad)
        along, aside = away[..., 0] * cos + away[..., 1] * sin, away[..., 1] * cos - away[..., 0] * sin
        return np.asarray((np.abs(along + _BACK_BEHIND_M) < _HALF_CHAIR_M) & (np.abs(aside) < _HALF_CHAIR_M))


@dataclass(frozen=True)
class CollisionMap:
    """Obstacles of a scene: measured points above the floor, inferred occluded geometry, walls."""

    scene: Scene

    @classmethod
    def of(cls, scene: Scene) -> "CollisionMap":
        """The map of a scene; the last one is cached, because many motions are tested in one scene.

        Args:
            scene: The room, in the radar's frame.
        """
        known = _latest[0].scene if _latest else None
        same = known is not None and known.vertices_m is scene.vertices_m and known.photo is scene.photo
        if not same or known is None or known.seats is not scene.seats:  # landmarks alone are no obstacles
            _latest[:] = [cls(scene)]
        return _latest[0]

    @cached_property
    def _measured_m(self) -> Float[Array, "point 3"]:
        """Points measured above the floor, in the radar's frame."""
        photo = self.scene.photo
        step = max(1, int(np.sqrt(photo.depth_m.size / _MAX_POINTS)))
        # Every row: a bed seen at a flat angle has few.
        points = AlignedPhoto.of(self.scene).points_m[:, ::step]
        points = points[photo.depth_m[:, ::step] > 0.3]
        return points[points[:, 2] > self.scene.floor_z_m + _LOWEST_M]

    @cached_property
    def _tops_m(self) -> Float[Array, "point 3"]:
        """Points of table tops, inferred ones included: unlike a backrest, a body may not lean into them."""
        return table_tops(self.scene, self._measured_m)

    @cached_property
    def _legs_m(self) -> Float[Array, "point 3"]:
        """Points of upright structures such as table legs: unlike a seat, no thigh sinks into them."""
        return np.concatenate([upright_structures(self.scene, self._measured_m), table_legs(self.scene)])

    @cached_property
    def _hard_m(self) -> tuple[Float[Array, "solid 3"], Float[Array, "top 3"], Float[Array, "leg 3"]]:
        """Everything solid, table tops and upright structures, one point in each cell."""
        return self._solid.points_m, thinned(self._tops_m), thinned(self._legs_m)

    def _hard_near(self, seat: Place) -> tuple[Float[Array, "solid 3"], Float[Array, "top 3"], Float[Array, "leg 3"]]:
        """`_hard_m` in a square around a seat; cached, since many ways to sit on the same seat are compared."""
        square = (round(seat[0] / _SEAT_SQUARE_M), round(seat[1] / _SEAT_SQUARE_M))
        if square not in self._near_seats:
            middle = (square[0] * _SEAT_SQUARE_M, square[1] * _SEAT_SQUARE_M)
            reach_m = _SEAT_REACH_M + FARTHEST_M + _SEAT_SQUARE_M
            solid, tops, legs = (_about(points, middle, reach_m) for points in self._hard_m)
            self._near_seats[square] = (solid, tops, legs)
        return self._near_seats[square]

    @cached_property
    def _near_seats(self) -> dict[tuple[int, int], tuple[Array, Array, Array]]:
        return {}

    def _without(self, chair: PulledChair) -> Float[Array, "solid 3"]:
        """All solid points around a chair except its own; cached, since many ways to sit on it are compared."""
        if chair not in self._chairless:
            solid, tops, legs = (_about(points, chair.place_m, _NEAR_CHAIR_M) for points in self._hard_m)
            others = solid[~chair.holds(solid, self.scene.floor_z_m)]
            below = tops - np.array([0.0, 0.0, _THICK_M])
            legs = legs[~chair.has_back_at(legs, self.scene.floor_z_m)]
            self._chairless[chair] = np.concatenate([others, tops, below, legs])
        return self._chairless[chair]

    @cached_property
    def _chairless(self) -> dict[PulledChair, Array]:
        return {}

    @cached_property
    def _solid(self) -> DistanceField:
        """Distance to measured points, and to inferred points just behind and below them."""
        points = self._measured_m
        behind = points * (1 + _THICK_M / np.maximum(np.linalg.norm(points, axis=1, keepdims=True), 1e-6))
        low = self._low_m
        below = [points - np.array([0.0, 0.0, _THICK_M])]
        below += [low - np.array([0.0, 0.0, down]) for down in _LOW_DOWN_M]
        solid = np.concatenate([points, behind, self._tops_m, low, *below])
        solid = solid[solid[:, 2] > self.scene.floor_z_m + _LOWEST_M]
        reaching_down = extended_to_floor(np.concatenate([points, behind]), self.scene.floor_z_m)
        field = self._field(np.concatenate([solid, reaching_down, table_legs(self.scene)]))
        # Low furniture is filled with points, so the nearest one is near even deep inside: a shin there is within.
        within = interior(field)
        within[..., int(_SHIN_M / CELL_M) :] = False
        return replace(field, distance_m=np.where(within, np.float32(0.0), field.distance_m))

    @cached_property
    def _low_m(self) -> Float[Array, "point 3"]:
        """Points of low furniture, those between rows of pixels included."""
        points = self._measured_m
        low = points[points[:, 2] < self.scene.floor_z_m + _LOW_M]
        return np.concatenate([low, low_gap_points(self.scene, low)])

    @cached_property
    def _low_tops_m(self) -> Float[Array, "y x"]:
        """Height above the floor of low furniture in cells of a floor plan, 0 where there is none."""
        heights = np.zeros((int((_AWAY_M[1] - _AWAY_M[0]) / CELL_M), int(2 * _SIDE_M / CELL_M)))
        column, row = np.floor((self._low_m[:, :2].T + np.array([[_SIDE_M], [-_AWAY_M[0]]])) / CELL_M).astype(int)
        inside = (row >= 0) & (row < heights.shape[0]) & (column >= 0) & (column < heights.shape[1])
        above = self._low_m[:, 2] - self.scene.floor_z_m
        np.maximum.at(heights, (row[inside], column[inside]), above[inside])
        return heights

    def low_surface_m(self, place_m: Float[Array, "2"]) -> float:
        """Height of low furniture around a position.

        Args:
            place_m: Position (x, y) in metres.

        Returns:
            Median height above the floor in metres; 0 if most of the area is free of low furniture.
        """
        column, row = np.floor((place_m + np.array([_SIDE_M, -_AWAY_M[0]])) / CELL_M).astype(int)
        reach = int(_ABOUT_SEAT_M / CELL_M)
        around = self._low_tops_m[max(row - reach, 0) : row + reach + 1, max(column - reach, 0) : column + reach + 1]
        heights = around[around > _SHIN_TOP_M]
        return float(np.median(heights)) if 2 * heights.size > max(around.size, 1) else 0.0

    def has_room_for_shins(self, knees_m: Float[Array, "2"], feet_m: Float[Array, "2"], seat_height_m: float) -> bool:
        """Whether the surface of a seat ends in front of a sitter's shins; in the middle of a bed it does not.

        Args:
            knees_m: Position (x, y) of the knees in metres.
            feet_m: Position (x, y) of the feet in metres.
            seat_height_m: Height of the seat above the floor in metres.
        """
        line = knees_m + np.linspace(0, 1, 4)[:, None] * (feet_m - knees_m)
        around = np.array([(a, b) for a in (-0.06, 0.0, 0.06) for b in (-0.06, 0.0, 0.06)])
        places = (line[:, None] + around).reshape(-1, 2)
        column, row = np.floor((places.T + np.array([[_SIDE_M], [-_AWAY_M[0]]])) / CELL_M).astype(int)
        rows, columns = self._low_tops_m.shape
        height = self._low_tops_m[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
        is_surface = (height > _SHIN_TOP_M) & (height < seat_height_m + _LOW_DOWN_M[1])
        return bool(is_surface.mean() < _MAX_SHIN_SHARE)

    @cached_property
    def _standing(self) -> DistanceField:
        """`_solid` plus the space below tables and other furniture, which is blocked except for sitters."""
        below = self._field(below_tops(self.scene, np.concatenate([self._tops_m, self._low_m])))
        return replace(below, distance_m=np.minimum(below.distance_m, self._solid.distance_m))

    def _field(self, points_m: Float[Array, "point 3"]) -> DistanceField:
        floor = self.scene.floor_z_m
        low, high = np.array([-_SIDE_M, _AWAY_M[0], floor]), np.array([_SIDE_M, _AWAY_M[1], floor + _HIGHEST_M])
        return distance_field(points_m, low, high)

    def penetration_m(
        self,
        pose: PoseSequence | BodySamples,
        seats_m: Sequence[Place] = (),
        *,
        margin_m: float = 0.0,
        chair: PulledChair | None = None,
    ) -> float:
        """Maximum penetration of a moving body into the room.

        Around seats, trunk and thighs may sink into the surface, but not into a table ahead.

        Args:
            pose: Motion, or its samples.
            seats_m: Positions (x, y) in metres of the seats on which the person sits.
            margin_m: Thickness added to the body, metres.
            chair: A chair that is not where the photo shows it.

        Returns:
            Depth in metres; 0 if the body is clear.
        """
        samples = (pose if isinstance(pose, BodySamples) else BodySamples.of(pose)).deduplicated()
        worst = float(self.estimates_m([samples], [seats_m], margin_m=margin_m, chairs=[chair])[0])
        return max(worst, self.beyond_seats_m(samples, seats_m, margin_m=margin_m, chair=chair))

    def beyond_seats_m(
        self, body: BodySamples, seats_m: Sequence[Place], *, margin_m: float, chair: PulledChair | None = None
    ) -> float:
        """Maximum penetration of a sitter into objects near the seats that are not part of them.

        Args:
            body: Samples of the body.
            seats_m: Positions (x, y) of the seats in metres.
            margin_m: Thickness added to the body, metres.
            chair: A chair that is not where the photo shows it.

        Returns:
            Depth in metres; 0 if the body is clear.
        """
        return max((self._beyond_seat_m(body, seat, margin_m, chair) for seat in dict.fromkeys(seats_m)), default=0.0)

    def estimates_m(
        self,
        bodies: Sequence[BodySamples],
        seats_m: Sequence[Sequence[Place]],
        *,
        margin_m: float,
        chairs: Sequence[PulledChair | None] = (),
    ) -> Float[Array, " body"]:
        """`penetration_m` of many bodies at once, in which objects ahead of a sitter count as part of the seat.

        Args:
            bodies: Samples of the bodies.
            seats_m: Positions (x, y) of the seats of each body, metres.
            margin_m: Thickness added to the bodies, metres.
            chairs: Displaced chair of each body, or None; empty for none at all.

        Returns:
            Depth in metres, (body,).
        """
        points = np.concatenate([body.points_m for body in bodies])
        radius = np.concatenate([body.radius_m for body in bodies])
        at_seat = np.concatenate([_near(body, seats) for body, seats in zip(bodies, seats_m, strict=True)])
        soft = at_seat & np.concatenate([body.is_soft for body in bodies])
        allowed = np.where(soft, _ON_SEAT_M, _ALLOWED_M - margin_m)
        distance = (
            np.where(at_seat, self._solid.at(points), self._standing.at(points))
            if at_seat.any()
            else (self._standing.at(points))
        )
        ends = np.cumsum([len(body.points_m) for body in bodies])
        for chair, end, body in zip(chairs, ends, bodies, strict=False):
            if chair is not None:
                own = slice(int(end) - len(body.points_m), int(end))
                distance[own] = self._moved_chair_depth_m(chair, points[own], distance[own])
        depth = radius - distance - allowed
        for plane in self._walls:
            depth = np.maximum(depth, _into_wall_m(plane, points, radius - allowed))
        return np.maximum(np.maximum.reduceat(depth, np.concatenate([[0], ends[:-1]])), 0.0)

    @cached_property
    def _walls(self) -> tuple[Plane, ...]:
        return tuple(plane for plane in self.scene.planes if plane.kind == "wall")

    def _moved_chair_depth_m(
        self, chair: PulledChair, points: Float[Array, "point 3"], distance_m: Float[Array, " point"]
    ) -> Float[Array, " point"]:
        """Distances of a body's points; those near the chair are evaluated without it."""
        near = distances_m(points[:, :2], chair.place_m) < _NEAR_CHAIR_M - FARTHEST_M
        out = distance_m.copy()
        out[near] = np.minimum(_distances_m(points[near], self._without(chair)), FARTHEST_M)
        return out

    def _beyond_seat_m(
        self, body: BodySamples, seat: Place, margin_m: float, chair: PulledChair | None = None
    ) -> float:
        """Penetration of a sitter into objects near the seat that are not part of it.

        These are objects ahead of the seat and above its surface, and tables behind it.
        """
        solid, tops, legs = (_about(points, seat, _SEAT_REACH_M + FARTHEST_M) for points in self._hard_near(seat))
        if chair is not None:
            solid = _about(self._without(chair), seat, _SEAT_REACH_M + FARTHEST_M)
            legs = legs[~chair.holds(legs, self.scene.floor_z_m)]
        along, height = (solid[:, :2] - np.array(seat)) @ body.ahead, solid[:, 2] - body.pelvis_m[2]
        ahead_of = (along > _SEAT_AHEAD_M) & (height > -_SEAT_BELOW_M)
        next_to = (along > 0.0) & (height > _ABOVE_ARMRESTS_M)
        tops = tops[tops[:, 2] > body.pelvis_m[2]]
        behind = (tops[:, :2] - np.array(seat)) @ body.ahead <= _SEAT_AHEAD_M
        legs = legs[(legs[:, :2] - np.array(seat)) @ body.ahead > _SEAT_AHEAD_M]
        at_seat = _near(body, (seat,))
        points, radius = body.points_m[at_seat], body.radius_m[at_seat]
        depth = 0.0
        hard = np.concatenate([solid[ahead_of | next_to], tops[~behind], legs])
        for obstacle, extra_m in ((hard, _EDGE_M), (tops[behind], _TABLE_BEHIND_M)):
            nearest = _distances_m(points, obstacle)
            depth = max(depth, float((radius + extra_m - nearest - _ALLOWED_M + margin_m).max(initial=0.0)))
        return depth


def _near(body: BodySamples, seats_m: Sequence[Place]) -> Bool[Array, " point"]:
    """Which points of a body belong to a sitter on one of the seats."""
    is_near = np.zeros(len(body.points_m), bool)
    for seat in dict.fromkeys(seats_m):
        is_near |= np.hypot(body.points_m[:, 0] - seat[0], body.points_m[:, 1] - seat[1]) < _SEAT_REACH_M
    return is_near


def _distances_m(points: Float[Array, "point 3"], obstacle: Float[Array, "other 3"]) -> Float[Array, " point"]:
    from scipy.spatial import KDTree

    tree = KDTree(obstacle, balanced_tree=False, compact_nodes=False)  # queried only once
    return np.asarray(tree.query(points, distance_upper_bound=FARTHEST_M)[0])


def _into_wall_m(
    plane: Plane, points: Float[Array, "point 3"], reach_m: Float[Array, " point"]
) -> Float[Array, " point"]:
    """Penetration of limbs into a wall; farther behind it is another room, visible through a door."""
    away = points - plane.centre_m
    inside = np.abs(away @ plane.axis_u) < plane.half_size_m[0] + _WALL_BEYOND_M
    into = np.where(inside, reach_m - away @ plane.normal, 0.0)
    return np.where(into < _WALL_DEPTH_M, into, 0.0)


def _about(points: Float[Array, "point 3"], seat: Place, reach_m: float) -> Float[Array, "near 3"]:
    """Points within a horizontal distance of a seat."""
    points = points[np.abs(points[:, 0] - seat[0]) < reach_m]
    return points[distances_m(points[:, :2], seat) < reach_m]
