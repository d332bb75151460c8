"""Landmarks: tables, counters, beds, doors and windows, which a sentence may name as a destination.

Floor on which a body may stand: visible or inferred, and assumed behind furniture.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.errors import InputError
from mmweaver.core.placed_thing import PlacedThing
from mmweaver.core.records import LANDMARK_KINDS, FreeSpace, Landmark, Plane, Scene, Seat
from mmweaver.core.shapes import Array, GridMask
from mmweaver.scene.affordances.seats import bed_squares
from mmweaver.scene.layout.class_evidence import landmark_points
from mmweaver.scene.layout.doors_and_windows import LandmarkCandidate, find_openings
from mmweaver.scene.layout.height_map import (
    CELL_M,
    HeightMap,
    bounding_slices,
    label_components,
    nearest_squares,
    surface_behind_m,
)

_EDGE_ON_M, _TABLE_DEPTH_M = 0.13, 0.85
_TABLE_HEIGHTS_M = (0.3, 1.1)
_MIN_CLEARANCE_M, _MIN_LENGTH_M = 0.4, 0.6  # below a table's rim, and along it: chairs are not as wide
MIN_DISTANCE_M = 0.5  # of a body from the radar


def find_free_space(height_map: HeightMap) -> FreeSpace:
    """Floor that is visible, or inferred where nothing stands: squares seen through, or below the picture's edge.

    Not free are places behind walls, outside the picture's width, within half a metre of the radar, and behind the
    edge of a table at the camera's height or above it: seen edge-on or from below, a table occludes its own top while
    the floor below it is visible.

    Args:
        height_map: The room from above.

    Returns:
        The free squares on the height map's grid, and those of them that were measured.
    """
    distance_m = np.hypot(height_map.x_m[None, :], height_map.y_m[:, None])
    is_open = height_map.is_floor_seen | height_map.is_seen_through | height_map.is_below_picture
    is_free = is_open & ~height_map.is_blocked & ~hidden_by_tables(height_map) & (distance_m >= MIN_DISTANCE_M)
    return FreeSpace(
        x_m=height_map.x_m,
        y_m=height_map.y_m,
        is_free=is_free,
        is_seen=height_map.is_floor_seen & is_free,
    )


def hidden_by_tables(height_map: HeightMap) -> GridMask:
    """Squares occluded by a table that is seen edge-on or from below.

    Args:
        height_map: The room from above.

    Returns:
        Mask (y, x): squares up to 0.85 m, the depth of a table, behind the edges of surfaces at the camera's own height
        and behind the rims of tables above it.
    """
    above_camera_m = np.nan_to_num(height_map.top_m, nan=-9.0) + height_map.floor_z_m
    is_table = (height_map.top_m > _TABLE_HEIGHTS_M[0]) & (height_map.top_m < _TABLE_HEIGHTS_M[1])
    is_edge_on = np.abs(above_camera_m) < _EDGE_ON_M
    is_edge = is_table & (is_edge_on | _is_rim(height_map, is_table & (above_camera_m > 0)))
    row, column = np.nonzero(is_edge)
    x, y = height_map.x_m[column], height_map.y_m[row]
    distance = np.maximum(np.hypot(x, y), 1e-6)
    occluded = np.zeros_like(is_edge, dtype=bool)
    for behind in np.arange(CELL_M / 2, _TABLE_DEPTH_M, CELL_M / 2):
        farther = 1 + behind / distance
        b, a, inside = nearest_squares(x * farther, y * farther, height_map.x_m, height_map.y_m)
        occluded[b[inside], a[inside]] = True
    return occluded


def _is_rim(height_map: HeightMap, squares: GridMask) -> GridMask:
    """Those of the squares in components that are long and hollow below."""
    from scipy import ndimage

    hollow = squares & (height_map.bottom_m > _MIN_CLEARANCE_M)
    labels, _ = ndimage.label(hollow, structure=np.ones((3, 3)))
    is_rim = np.zeros_like(hollow)
    for label, region in enumerate(bounding_slices(labels), start=1):
        if max(part.stop - part.start for part in region) * CELL_M >= _MIN_LENGTH_M:
            is_rim[region] |= labels[region] == label
    return is_rim


_UPPER_BODY_M = (1.2, 1.35, 1.5)  # heights above the floor at which a body behind a table is visible
_BODY_M = 0.25  # from the centre of a standing body to adjacent objects
_BODY_HEIGHTS_M = (0.1, 1.9)
_BEARINGS = 180  # of two degrees each


def find_assumed_floor(
    height_map: HeightMap, view: AlignedPhoto, walls: Sequence[Plane], is_free: GridMask
) -> GridMask:
    """Unmeasured squares on which a body would be visible at least in part.

    A square counts if it lies in front of all walls, nearer than the farthest measurement at its bearing, and a line of
    sight passes above it at chest height; or if it is nearer than any measurement at its bearing. The depth of a table
    behind its edge counts as table.

    Args:
        height_map: The room from above.
        view: The photo in the radar's frame.
        walls: Walls of the room, normals towards the room.
        is_free: Squares already known to be free, (y, x).

    Returns:
        Mask (y, x), disjoint from `is_free`.
    """
    x_m, y_m = height_map.x_m, height_map.y_m
    distance_m = np.hypot(x_m[None, :], y_m[:, None])
    nearest_m, farthest_m = _extent_m(view)
    bearing = _bearing(np.arctan2(x_m[None, :], y_m[:, None]))
    passes = np.zeros(distance_m.shape, bool)
    for height_m in _UPPER_BODY_M:
        passes |= surface_behind_m(x_m, y_m, height_m, view)[1] > 0.0
    behind = passes & (distance_m < farthest_m[bearing] - _BODY_M)
    before = distance_m < nearest_m[bearing] - _BODY_M
    possible = (behind | before) & (distance_m >= MIN_DISTANCE_M) & _is_inside(height_map, walls)
    return possible & ~is_free & ~height_map.is_blocked & ~hidden_by_tables(height_map)


def _extent_m(view: AlignedPhoto) -> tuple[Float[Array, " bearing"], Float[Array, " bearing"]]:
    """The nearest and the farthest measured ground distance in each direction, at the heights of a body; 0 if none."""
    points = view.points_m[view.photo.depth_m > 0.3]
    height_m = points[:, 2] - view.floor_z_m
    points = points[(height_m > _BODY_HEIGHTS_M[0]) & (height_m < _BODY_HEIGHTS_M[1])]
    bearing, ground_m = _bearing(np.arctan2(points[:, 0], points[:, 1])), np.hypot(points[:, 0], points[:, 1])
    nearest, farthest = np.full(_BEARINGS, np.inf), np.zeros(_BEARINGS)
    np.minimum.at(nearest, bearing, ground_m)
    np.maximum.at(farthest, bearing, ground_m)
    return np.where(np.isfinite(nearest), nearest, 0.0), farthest


def _bearing(bearing_rad: Float[Array, "*shape"]) -> Array:
    return np.floor(np.rad2deg(bearing_rad) * _BEARINGS / 360).astype(int) % _BEARINGS


def _is_inside(height_map: HeightMap, walls: Sequence[Plane]) -> GridMask:
    """Squares at least half a body's width in front of every wall."""
    inside = np.ones((len(height_map.y_m), len(height_map.x_m)), bool)
    for wall in walls:
        x, y = height_map.x_m[None, :] - wall.centre_m[0], height_map.y_m[:, None] - wall.centre_m[1]
        inside &= x * wall.normal[0] + y * wall.normal[1] > 0.0
    return inside


_TABLE_M, _COUNTER_M = (0.33, 0.82), (0.82, 1.02)  # heights above the floor
_MIN_TABLE_M2, _MIN_BED_M2, _MIN_COUNTER_M2 = 0.16, 0.8, 0.25
_HEIGHT_TOLERANCE_M, _LOW_TABLE_M, _MIN_HALF_DEPTH_M = 0.03, 0.6, 0.29
_MAX_SOLID_SHARE = 0.6  # of a table's visible front; chests are solid below their tops
_BODY_RADIUS_M, _MAX_REACH_M = 0.27, 1.1  # a body's half width, and how far from a landmark one may stand to use it
_MIN_SPACING_M = 0.5  # between landmarks of a kind
_BEARING_BIN_RAD = 0.02
# Of given landmarks: the farthest, where one stands before their front, and too near to a middle that is free floor.
_MAX_GIVEN_M, _BEFORE_FRONT_M, _NEAREST_M = 10.0, 0.6, 0.45


def find_landmarks(
    view: AlignedPhoto,
    planes: tuple[Plane, ...],
    height_map: HeightMap,
    free_space: FreeSpace,
    seats: tuple[Seat, ...],
) -> tuple[Landmark, ...]:
    """Finds landmarks from the photo's class mask, or from depth where there is no mask.

    From depth: horizontal surfaces without a seat that are at table height and hollow below, at counter height, or as
    large as a bed; and parts of walls with the size of a door or window and another colour or no surface.

    Args:
        view: The photo in the radar's frame.
        planes: Planes of the room, the walls among them.
        height_map: The room from above.
        free_space: Floor on which a body may stand.
        seats: Seats of the room; their surfaces are no tables.

    Returns:
        Landmarks sorted by kind, then by distance, each with the place to stand and the direction to face.
    """
    if view.photo.classes is not None:
        candidates = _class_candidates(view, planes)
    else:
        candidates = [*_horizontal_tops(view, height_map, seats), *find_openings(view, planes)]
    found = [find_approach(candidate, free_space) for candidate in candidates]
    return tuple(sorted(found, key=lambda mark: (mark.kind, float(np.hypot(*mark.position_m[:2])))))


def add_landmarks(scene: Scene, given: Sequence[PlacedThing | tuple[str, tuple[float, float]]]) -> Scene:
    """Adds landmarks given by the user; they replace the detected ones of the same kinds.

    Args:
        scene: The room.
        given: Kind and position (x, y) in metres of each, in the radar's frame, and perhaps where its front faces.

    Returns:
        The scene with these landmarks and an assumption that names each.

    Raises:
        InputError: If a kind is not one that sentences may name, or a position is behind the radar or beyond 10 m.
    """
    added = []
    things = [PlacedThing.of(one) for one in given]
    for one in things:
        kind, (x, y) = one.kind, one.place_m
        if kind not in LANDMARK_KINDS:
            raise InputError(f"no sentence goes to a {kind!r}; known: {', '.join(LANDMARK_KINDS)}")
        if not (abs(x) <= _MAX_GIVEN_M and 0 < y <= _MAX_GIVEN_M):
            raise InputError(
                f"the {kind} at {x:g},{y:g} is not in front of the radar; give metres to the right of and ahead of it,"
                f" for example {kind}=0.5,3"
            )
        position_m = np.array([x, y, scene.floor_z_m + 1.0])
        candidate = LandmarkCandidate(kind=kind, position_m=position_m, squares_m=np.array([[x, y]]))
        found = find_approach(candidate, scene.free_space)
        is_free = float(np.hypot(*(position_m[:2] - found.approach_m))) < _NEAREST_M  # of a thing that no photo shows
        front_rad = float(np.arctan2(-y, -x)) if is_free and one.facing_rad is None else one.facing_rad
        added.append(found if front_rad is None else _in_front(found, front_rad))
    kinds = {one.kind for one in things}
    notes = tuple(
        f"The {one.kind} at x {one.place_m[0]:g} m, y {one.place_m[1]:g} m was given by the user, not detected."
        for one in things
    )
    return replace(
        scene,
        landmarks=(*(mark for mark in scene.landmarks if mark.kind not in kinds), *added),
        assumptions=(*scene.assumptions, *notes),
    )


def _in_front(mark: Landmark, front_rad: float) -> Landmark:
    """The landmark with the place to stand before its front."""
    x, y = mark.position_m[:2] + _BEFORE_FRONT_M * np.array([np.cos(front_rad), np.sin(front_rad)])
    facing_rad = float((front_rad + 2 * np.pi) % (2 * np.pi) - np.pi)
    return replace(mark, approach_m=(float(x), float(y)), facing_rad=facing_rad)


def _horizontal_tops(view: AlignedPhoto, height_map: HeightMap, seats: tuple[Seat, ...]) -> list[LandmarkCandidate]:
    """Beds, tables and counters from the height map."""
    from scipy import ndimage

    beds = bed_squares(height_map)
    labels, count = label_components(beds)
    components = [labels == label for label in range(1, count + 1)]
    found = [
        _candidate("bed", squares, height_map) for squares in components if squares.sum() * CELL_M**2 >= _MIN_BED_M2
    ]
    taken = beds | _seat_squares(height_map, seats)
    for height_m in np.arange(_TABLE_M[0], _COUNTER_M[1], 0.02):
        at_height = (np.abs(height_map.top_m - height_m) < _HEIGHT_TOLERANCE_M) & ~taken
        # Cups and noise leave gaps; legs and rails are narrower than a top.
        closed = ndimage.binary_closing(at_height, structure=np.ones((3, 3), bool))
        opened = np.asarray(ndimage.binary_opening(closed, structure=np.ones((4, 4), bool)), bool)
        labels, count = label_components(opened)
        for label in range(1, count + 1):
            squares = labels == label
            kind = _kind_of_top(squares, height_m, view, height_map)
            candidate = _candidate(kind, squares, height_map)
            # The objects on a top may split it into several components.
            if kind and not any(_are_near(candidate, other) for other in found):
                found.append(candidate)
            if kind or squares.sum() * CELL_M**2 >= _MIN_TABLE_M2:
                taken |= squares
    return found


def _kind_of_top(squares: GridMask, height_m: float, view: AlignedPhoto, height_map: HeightMap) -> str:
    """table | counter | "" for a horizontal patch: tables are hollow below, chests and cabinets solid."""
    from scipy import ndimage

    area_m2 = float(squares.sum()) * CELL_M**2
    if area_m2 >= _MIN_COUNTER_M2 and height_m >= _COUNTER_M[0]:
        return "counter"
    if area_m2 < _MIN_TABLE_M2 or height_m >= _COUNTER_M[0]:
        return ""
    whole = ndimage.binary_fill_holes(ndimage.binary_closing(squares, structure=np.ones((5, 5), bool)))
    half_depth_m = np.asarray(ndimage.distance_transform_edt(np.asarray(whole))).max() * CELL_M
    if half_depth_m > _MIN_HALF_DEPTH_M and height_m > _LOW_TABLE_M:
        return "table"  # chests are not as deep; what appears solid below are its chairs
    return "" if _solid_share(squares, height_m, view, height_map) > _MAX_SOLID_SHARE else "table"


def _solid_share(squares: GridMask, height_m: float, view: AlignedPhoto, height_map: HeightMap) -> float:
    """Of the bearings under which a patch is seen, the share with something below its near edge."""
    points = view.points_m[::2, ::2].reshape(-1, 3)
    above_floor_m = points[:, 2] - view.floor_z_m
    points = points[(above_floor_m > 0.20) & (above_floor_m < height_m - 0.08)]
    row, column = np.nonzero(squares)
    x, y = height_map.x_m[column], height_map.y_m[row]
    edge_bin = np.round(np.arctan2(x, y) / _BEARING_BIN_RAD).astype(int)
    point_bin = np.round(np.arctan2(points[:, 0], points[:, 1]) / _BEARING_BIN_RAD).astype(int)
    point_distance = np.hypot(points[:, 0], points[:, 1])
    bins = np.unique(edge_bin)
    num_solid = 0
    for one in bins:
        edge = np.hypot(x, y)[edge_bin == one].min()
        below = point_distance[point_bin == one]
        num_solid += int(((below > edge - 0.12) & (below < edge + 0.10)).sum() >= 4)
    return num_solid / max(len(bins), 1)


def _seat_squares(height_map: HeightMap, seats: tuple[Seat, ...]) -> GridMask:
    """Squares at the height of a seat and near it."""
    x, y = np.meshgrid(height_map.x_m, height_map.y_m)
    near = np.zeros(x.shape, bool)
    for seat in seats:
        at_height = np.abs(height_map.top_m - (seat.position_m[2] - height_map.floor_z_m)) < 0.05
        near |= (np.hypot(x - seat.position_m[0], y - seat.position_m[1]) < 0.45) & at_height
    return near


def _are_near(one: LandmarkCandidate, other: LandmarkCandidate) -> bool:
    return bool(np.hypot(*(one.position_m - other.position_m)[:2]) <= _MIN_SPACING_M)


def _candidate(kind: str, squares: GridMask, height_map: HeightMap) -> LandmarkCandidate:
    """The candidate that covers some squares, at the median height of their tops."""
    row, column = np.nonzero(squares)
    squares_m = np.stack([height_map.x_m[column], height_map.y_m[row]], axis=1)
    top_m = float(np.nanmedian(height_map.top_m[squares]))
    middle = (squares_m.min(axis=0) + squares_m.max(axis=0)) / 2
    position_m = np.array([middle[0], middle[1], height_map.floor_z_m + top_m])
    return LandmarkCandidate(kind=kind, position_m=position_m, squares_m=squares_m)


def _class_candidates(view: AlignedPhoto, planes: tuple[Plane, ...]) -> list[LandmarkCandidate]:
    """One candidate for each connected region of a landmark's class."""
    found: list[LandmarkCandidate] = []
    for kind, points in landmark_points(view, planes):
        if kind == "table":
            # The mask includes the legs; the landmark is the top.
            height_m = points[:, 2] - view.floor_z_m
            points = points[height_m > np.percentile(height_m, 60) - 0.05]
        low, high = np.percentile(points, [4, 96], axis=0)
        squares_m = np.unique(np.floor(points[:, :2] / CELL_M), axis=0) * CELL_M + CELL_M / 2
        candidate = LandmarkCandidate(kind=kind, position_m=(low + high) / 2, squares_m=squares_m)
        if not any(other.kind == kind and _are_near(candidate, other) for other in found):
            found.append(candidate)
    return found


def find_approach(candidate: LandmarkCandidate, free_space: FreeSpace) -> Landmark:
    """The landmark with the place to stand at: the nearest free place that is wide enough for a body."""
    from scipy import ndimage

    clearance = np.asarray(ndimage.distance_transform_edt(np.pad(free_space.is_free, 1)))[1:-1, 1:-1] - 0.5
    row, column = np.nonzero(clearance * CELL_M >= _BODY_RADIUS_M)
    places_m = np.stack([free_space.x_m[column], free_space.y_m[row]], axis=1).astype(float)
    middle = candidate.position_m[:2]
    approach_m = None
    if len(places_m):
        some = candidate.squares_m[:: max(1, len(candidate.squares_m) // 200)]
        gap_m = np.min(np.hypot(*(places_m[:, None] - some[None]).transpose(2, 0, 1)), axis=1)
        # Of nearly equal places, prefer the one in front of the landmark's middle.
        best = int(np.argmin(gap_m + 0.25 * np.hypot(*(places_m - middle).T)))
        if gap_m[best] < _MAX_REACH_M:
            approach_m = places_m[best]
    if approach_m is None:
        towards_radar = -middle / max(float(np.hypot(*middle)), 1e-6)
        approach_m = middle + 0.6 * towards_radar
    ahead = middle - approach_m
    return Landmark(
        kind=candidate.kind,
        position_m=candidate.position_m,
        approach_m=(float(approach_m[0]), float(approach_m[1])),
        facing_rad=float(np.arctan2(ahead[1], ahead[0])),
    )
