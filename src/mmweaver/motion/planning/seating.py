"""Chooses seats: a seat of the scene, or an assumed stool, which a note reports."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import Scene, Seat
from mmweaver.motion.animation.library.sitting import knees_ahead_m, pelvis_behind_feet_m
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import STOOL_HEIGHT_M
from mmweaver.motion.planning.collision import CollisionMap, PulledChair
from mmweaver.motion.planning.floor_map import FloorMap, distance_m, unit_vector

Array = np.ndarray
LOWEST_M, HIGHEST_M = 0.3, 0.65  # height of usable seats
_COUCHES, _CHAIRS = ("couch", "sofa", "settee", "bench"), ("chair", "armchair", "stool", "seat")
_COUCH_M = 0.8  # minimum width of a couch; narrower seats are chairs
LYING_M = 1.35  # minimum width of a seat to lie on
_LYING_OFF_CENTRE = 0.077  # of the height: a lying body extends farther from its seat to the feet
_SAME_FACING_COS, _SAME_HEIGHT_M = 0.95, 0.1  # tolerances for two places on one couch
_BED_RADIUS_M = 1.2  # a seat within this radius of a bed's centre is on it
_TURNS_RAD, _TURN_COST = (0.2, 0.4, 0.6), 0.4  # a sitter may face past the table
_WIDEST_TURN_RAD = 1.4
_BODY_WIDTH_M = 0.4  # part of a seat's width and depth that the body occupies
_LEFT_OUT = 0.4  # share of the seats that `random_subset` drops
_BACK_M, _DEEP_SEAT_M = 0.05, 0.4  # maximum shift backwards, and minimum depth of a seat for it
_EDGES_RAD, _EDGE_STEP_M, _FARTHEST_EDGE_M = (0.0, np.pi / 2, -np.pi / 2), 0.1, 1.5  # search for edges of wide surfaces
_KNEES_APART_M = 0.14  # from the middle to the outer side of a knee
_BED_WIDTH_M = 0.7  # width of an edge per sitter
_KNEE_M, _ON_SEAT_M = 0.05, 0.12  # seat edge to the middle of the knees, and at least to the pelvis
PULLED_COST = 0.5  # cost of a chair that must be pulled out
_CHAIR_BEHIND_M, _CHAIR_ASIDE_M = 0.27, 0.2  # chair's middle to its back, and half its width
_STRAIGHT_TO_SEAT_M = 0.6  # end of the walk to a seat, near the seat's own edge


@dataclass(frozen=True, kw_only=True)
class Sitting:
    """A way to sit on a seat.

    Attributes:
        feet_m: Position (x, y) of the feet in metres.
        facing_rad: Heading of the sitter, from +x towards +y.
        height_m: Height of the surface above the floor in metres.
        seat_m: Position (x, y) of the pelvis on the seat in metres.
        width_m: Width of the seat in metres.
        depth_m: Depth of the seat in metres.
        edge_m: Distance from `seat_m` ahead to the seat's edge in metres.
        knees_m: Distance from `seat_m` ahead to the sitter's knees in metres.
        cost: Penalty of an unusual way to sit.
        chair: The chair if it is not where the photo shows it.
    """

    feet_m: Float[Array, "2"]
    facing_rad: float
    height_m: float
    seat_m: Float[Array, "2"]
    width_m: float = 0.4
    depth_m: float = 0.4
    edge_m: float = 0.2
    knees_m: float = 1.0
    cost: float = 0.0
    chair: PulledChair | None = None

    @property
    def ahead(self) -> Float[Array, "2"]:
        """Unit vector (x, y) that the sitter faces."""
        return unit_vector(self.facing_rad)

    @property
    def aside(self) -> Float[Array, "2"]:
        """Unit vector (x, y) to the sitter's left."""
        return np.array([-np.sin(self.facing_rad), np.cos(self.facing_rad)])

    def fitted_to(self, body: SkeletonProportions) -> "Sitting":
        """Adapts feet and knees to the legs of a body.

        Args:
            body: Bone lengths.
        """
        feet_m = self.seat_m + pelvis_behind_feet_m(body, self.height_m) * self.ahead
        return replace(self, feet_m=feet_m, knees_m=knees_ahead_m(body, self.height_m)).clear_knees()

    def moved_ahead(self, by_m: float) -> "Sitting":
        """Moves the sitter ahead on the seat.

        Args:
            by_m: Distance in metres.
        """
        return replace(self.moved(by_m * self.ahead), edge_m=self.edge_m - by_m)

    def moved(self, by_m: Float[Array, "2"]) -> "Sitting":
        """Translates seat and sitter.

        Args:
            by_m: Displacement (x, y) in metres.
        """
        return replace(self, feet_m=self.feet_m + by_m, seat_m=self.seat_m + by_m)

    def clear_knees(self) -> "Sitting":
        """Moves ahead until the backs of the knees are past the seat's edge, as people sit on beds and deep couches."""
        needed_m = self.edge_m + _KNEE_M - self.knees_m
        by_m = min(needed_m, self.edge_m - _ON_SEAT_M)
        return self.moved_ahead(by_m) if by_m > 0 else self


def preferred(seats: list[Sitting], word: str, scene: Scene) -> list[Sitting]:
    """Seats that match a word; all of them if none matches.

    Args:
        seats: Seats of the room.
        word: Word of the sentence, such as "couch"; "" for any.
        scene: The room, whose landmarks tell the beds.
    """
    return fitting(seats, word, scene) or seats


def fitting(seats: list[Sitting], word: str, scene: Scene) -> list[Sitting]:
    """Seats that match a word: couches are wide, chairs are not; edges of beds count as beds only.

    Args:
        seats: Seats of the room.
        word: Word of the sentence, such as "couch"; "" for any but beds.
        scene: The room, whose landmarks tell the beds.
    """
    if word in _COUCHES:
        return [seat for seat in seats if seat.width_m >= _COUCH_M and not _is_bed(seat, scene)]
    if word == "bed":
        return [seat for seat in seats if _is_bed(seat, scene)]
    if word in _CHAIRS:
        return [seat for seat in seats if seat.width_m < _COUCH_M and not _is_bed(seat, scene)]
    return [seat for seat in seats if not _is_bed(seat, scene)]


def long_enough_to_lie_on(seats: list[Sitting], scene: Scene) -> list[Sitting]:
    """Couches and beds on which a person can lie, along the edge on which one sits.

    Args:
        seats: Seats of the room.
        scene: The room, whose landmarks tell the beds.
    """
    return [seat for seat in seats if seat.width_m >= LYING_M or _is_bed(seat, scene)]


def centred_to_lie(seats: list[Sitting], height_m: float) -> list[Sitting]:
    """Moves places on couches and beds so that somebody who lies down, head to their own left, is centred.

    The places on one couch, which have about the same heading and height, define its middle.

    Args:
        seats: Places on couches and beds.
        height_m: Height of the body in metres.
    """
    centred = []
    for seat in seats:
        along_m = [float((other.seat_m - seat.seat_m) @ seat.aside) for other in seats if _share_couch(seat, other)]
        centred.append(seat.moved((float(np.mean(along_m)) + _LYING_OFF_CENTRE * height_m) * seat.aside))
    return centred


def _share_couch(one: Sitting, other: Sitting) -> bool:
    """Whether two places belong to one couch: about the same heading and height, and closer than its width."""
    faces_alike = np.cos(one.facing_rad - other.facing_rad) > _SAME_FACING_COS
    is_near = distance_m(one.seat_m, other.seat_m) < max(one.width_m, other.width_m)
    return bool(faces_alike and is_near and abs(one.height_m - other.height_m) < _SAME_HEIGHT_M)


def _is_bed(seat: Sitting, scene: Scene) -> bool:
    beds = [mark for mark in scene.landmarks if mark.kind == "bed"]
    return any(distance_m(seat.seat_m, mark.position_m[:2]) < _BED_RADIUS_M for mark in beds)


def usable_seats(floor: FloorMap, body: SkeletonProportions) -> list[Sitting]:
    """The scene's seats of a usable height inside the radar's range window.

    Args:
        floor: Floor of the room with its range window.
        body: Bone lengths, to which the sittings are fitted.
    """
    found = []
    for seat in floor.scene.seats:
        sitting = _sitting(seat, floor, body)
        usable = LOWEST_M <= sitting.height_m <= HIGHEST_M
        if usable and not _has_room_for_shins(sitting, floor.scene):
            found += _edge_sittings(sitting, floor, body)
        elif usable and bool(floor.sees(sitting.seat_m)):
            found.append(sitting)
    return found


def _edge_sittings(sitting: Sitting, floor: FloorMap, body: SkeletonProportions) -> list[Sitting]:
    """Places at the edges of a wide surface, mostly a bed, on which a seat was found too far from its edges.

    Searched straight ahead and to the sides, as long as the height is about constant, until the shins are free.
    """
    obstacles, found = CollisionMap.of(floor.scene), []
    for turn in _EDGES_RAD:
        facing = sitting.facing_rad + turn
        ahead = unit_vector(facing)
        for by_m in np.arange(_EDGE_STEP_M, _FARTHEST_EDGE_M, _EDGE_STEP_M):
            place = sitting.seat_m + by_m * ahead
            height = obstacles.low_surface_m(place)
            if not LOWEST_M <= height <= HIGHEST_M:
                break
            edge = replace(
                sitting,
                facing_rad=facing,
                height_m=height,
                seat_m=place,
                width_m=_BED_WIDTH_M,
                edge_m=_BODY_WIDTH_M / 2,
            ).fitted_to(body)
            ways = [edge.moved(side * (_KNEES_APART_M * edge.aside)) for side in (-1.0, 0.0, 1.0)]
            is_floor = floor.is_seen_floor(np.stack([way.feet_m for way in ways])).all()
            if is_floor and all(_has_room_for_shins(way, floor.scene) for way in ways):
                found += [edge] if bool(floor.sees(edge.seat_m)) else []
                break
    return found


def _has_room_for_shins(sitting: Sitting, scene: Scene) -> bool:
    knees_m = sitting.seat_m + (sitting.knees_m + _KNEE_M) * sitting.ahead
    return CollisionMap.of(scene).has_room_for_shins(knees_m, sitting.feet_m, sitting.height_m)


def _sitting(seat: Seat, floor: FloorMap, body: SkeletonProportions) -> Sitting:
    place = np.asarray(seat.position_m[:2], dtype=float)
    return Sitting(
        feet_m=place,
        facing_rad=float(seat.facing_rad),
        height_m=float(seat.position_m[2]) - floor.scene.floor_z_m,
        seat_m=place,
        width_m=float(seat.size_m[0]),
        depth_m=float(seat.size_m[1]),
        edge_m=float(seat.size_m[1]) / 2,
    ).fitted_to(body)


def usual_variation(sitting: Sitting, rng: np.random.Generator) -> Sitting:
    """Samples a usual way to sit: half of the time facing ahead, else turned to a side or farther back.

    Args:
        sitting: Sitting straight ahead.
        rng: Random stream.
    """
    kind = int(rng.integers(4))
    if kind < 2 or (kind == 3 and sitting.depth_m < _DEEP_SEAT_M):
        return sitting
    reach = sitting.feet_m - sitting.seat_m
    if kind == 3:
        back = rng.uniform(0.3, 1.0) * _BACK_M * reach / max(float(np.hypot(*reach)), 1e-6)
        return replace(sitting.moved(-back), edge_m=sitting.edge_m + float(np.hypot(*back)), cost=0.2).clear_knees()
    return turned(sitting, float(rng.choice(_TURNS_RAD) * rng.choice([-1.0, 1.0])))


def any_variation(sitting: Sitting, rng: np.random.Generator) -> Sitting:
    """Samples any possible way to sit: turned, and shifted from the seat's centre.

    Args:
        sitting: Sitting straight ahead.
        rng: Random stream.
    """
    spare = np.clip((np.array([sitting.depth_m, sitting.width_m]) - _BODY_WIDTH_M) / 2, 0.03, 0.3)
    shift = rng.uniform(-1, 1, 2) * spare
    moved = sitting.moved(shift[0] * sitting.ahead + shift[1] * sitting.aside)
    moved = replace(moved, edge_m=sitting.edge_m - float(shift[0])).clear_knees()
    return turned(moved, float(rng.uniform(-1, 1) * _WIDEST_TURN_RAD))


def pulled_out(sitting: Sitting, floor: FloorMap, by_m: float) -> Sitting | None:
    """Sitting on the same chair, pulled back from what is ahead of it.

    Args:
        sitting: Sitting on the chair where the photo shows it.
        floor: Floor of the room.
        by_m: Distance in metres.

    Returns:
        The sitting; None for a couch or bed, or without free floor behind.
    """
    if sitting.width_m >= _COUCH_M or _is_bed(sitting, floor.scene):
        return None
    place = (float(sitting.seat_m[0]), float(sitting.seat_m[1]))
    moved = sitting.moved(-(by_m * sitting.ahead))
    to_sides = np.array([[-1.0], [0.0], [1.0]]) * _CHAIR_ASIDE_M * sitting.aside
    behind = moved.seat_m - _CHAIR_BEHIND_M * sitting.ahead + to_sides
    if not (floor.clearance_at(behind) > 0).all() or not bool(floor.sees(moved.seat_m)):
        return None
    return replace(moved, chair=PulledChair(place, sitting.facing_rad, by_m), cost=sitting.cost + PULLED_COST + by_m)


def random_subset(seats: list[Sitting], rng: np.random.Generator) -> list[Sitting]:
    """Samples a subset of the seats, never empty unless there are none.

    Args:
        seats: Seats of the room.
        rng: Random stream.
    """
    kept = [seat for seat in seats if rng.random() > _LEFT_OUT]
    return kept or seats


def turned(sitting: Sitting, turn: float) -> Sitting:
    """Rotates a sitter and the feet about the seat.

    Args:
        sitting: The sitting.
        turn: Angle in radians, counterclockwise seen from above.
    """
    reach = sitting.feet_m - sitting.seat_m
    across = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    corner_m = min(sitting.width_m, sitting.depth_m) / 2
    return replace(
        sitting,
        feet_m=sitting.seat_m + across @ reach,
        facing_rad=sitting.facing_rad + turn,
        edge_m=sitting.edge_m * float(np.cos(turn)) + corner_m * abs(float(np.sin(turn))),
        cost=0.3 + _TURN_COST * abs(turn) + (PULLED_COST + sitting.chair.by_m if sitting.chair else 0.0),
    ).clear_knees()


def stool_at(feet_m: Float[Array, "2"], facing_rad: float, body: SkeletonProportions) -> Sitting:
    """An assumed stool behind a standing person.

    Args:
        feet_m: Position (x, y) of the feet in metres.
        facing_rad: Heading of the person, from +x towards +y.
        body: Bone lengths.
    """
    behind = pelvis_behind_feet_m(body, STOOL_HEIGHT_M) * unit_vector(facing_rad)
    return Sitting(feet_m=feet_m, facing_rad=facing_rad, height_m=STOOL_HEIGHT_M, seat_m=feet_m - behind)


def stool_fits(stool: Sitting, floor: FloorMap, *, is_bed: bool = False) -> bool:
    """Whether there is free floor in view for a stool, or for a bed along whose edge the person sits.

    On a tight floor it only has to be in view.

    Args:
        stool: The assumed seat.
        floor: Floor of the room.
        is_bed: Whether it is a bed.
    """
    reach = np.linspace(-0.9, 0.9, 5) if is_bed else np.zeros(1)
    places = stool.seat_m + reach[:, None] * stool.aside
    is_free = floor.is_tight or bool((floor.clearance_at(places) >= 0.2).all())
    return is_free and bool(floor.sees(stool.seat_m))


def pulled_note(chair: PulledChair) -> str:
    """Note on a chair that is assumed to be pulled out."""
    x, y = chair.place_m
    return (
        f"the chair at x {x:.2f} m, y {y:.2f} m is taken as pulled out by {chair.by_m:.1f} m for who sits on it; the"
        " radar sees it where the photo shows it"
    )


def stool_note(stool: Sitting, *, none_at_all: bool, is_bed: bool = False) -> str:
    """Note on an assumed stool or bed.

    Args:
        stool: The assumed seat.
        none_at_all: Whether no seat was found in the photo.
        is_bed: Whether it is a bed.
    """
    why = "no seat was found in the photo" if none_at_all else "no seat of the photo can be used for this"
    why, what = ("no bed or long couch of the photo can be lain on", "bed") if is_bed else (why, "stool")
    x, y = stool.seat_m
    return f"{why}, a {what} {stool.height_m:.2f} m high is assumed at x {x:.2f} m, y {y:.2f} m"


def are_reachable(floor: FloorMap, places_m: Float[Array, "place 2"], sitting: Sitting) -> Bool[Array, " place"]:
    """Whether the straight paths to a seat are free; near the seat, with its own edge, less clearance is required.

    Args:
        floor: Floor of the room.
        places_m: Starts (x, y) in metres, (place, 2).
        sitting: Sitting on the seat.

    Returns:
        Mask (place,).
    """
    lines_m = places_m[:, None] + np.linspace(0, 1, 60)[:, None] * (sitting.feet_m - places_m)[:, None]
    near = np.hypot(*np.moveaxis(lines_m - sitting.feet_m, -1, 0)) < _STRAIGHT_TO_SEAT_M
    is_free = floor.clearance_at(lines_m) > 0.0
    if sitting.chair is not None:
        is_free |= sitting.chair.covers(lines_m)
    return (floor.can_stand(lines_m) | (near & is_free)).all(axis=1)
