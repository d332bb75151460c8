"""Things that a sentence may name as a place to go to: tables, counters, beds, doors and windows."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.errors import InputError
from mmweaver.core.records import FreeSpace, Landmark, Plane, RgbdPhoto, Scene, Seat
from mmweaver.core.shapes import Array, Rotation
from mmweaver.scene.affordances.seats import bed_squares
from mmweaver.scene.layout.class_evidence import named_points
from mmweaver.scene.layout.connected_patches import labelled
from mmweaver.scene.layout.doors_and_windows import find_openings
from mmweaver.scene.layout.height_map import CELL_M, HeightMap

_TABLE_M, _COUNTER_M = (0.33, 0.82), (0.82, 1.02)
_MIN_TOP_M2, _MIN_BED_M2, _MIN_COUNTER_M2 = 0.16, 0.8, 0.25
_LEVEL_M, _LOW_M, _HALF_DEPTH_M = 0.03, 0.6, 0.29
_BODY_M, _FARTHEST_M = 0.27, 1.1  # a body's half width, and how far from a thing one still stands at it
_APART_M = 0.5
KINDS = ("door", "window", "table", "counter", "bed")
_FARTHEST_TOLD_M = 10.0


@dataclass(frozen=True, kw_only=True)
class Things:
    """Where a thing of a kind is: its middle, and the squares it covers."""

    kind: str
    position_m: Float[Array, "3"]
    squares: Float[Array, "square 2"]


def find_landmarks(
    photo: RgbdPhoto,
    radar_from_camera: Rotation,
    floor_z_m: float,
    planes: tuple[Plane, ...],
    height_map: HeightMap,
    free_space: FreeSpace,
    seats: tuple[Seat, ...],
) -> tuple[Landmark, ...]:
    """All that are found, the nearest of each kind first; where the photo says what is what, that decides.

    From depth alone: level surfaces without a seat at table height that are hollow below, at counter height, or as
    large as beds; and on walls what is as large as a door or a window and of another colour, or is open.
    """
    if photo.classes is not None:
        things = _named(photo, radar_from_camera, floor_z_m, planes)
    else:
        things = _tops(photo, radar_from_camera, floor_z_m, height_map, seats)
        for opening in find_openings(photo, radar_from_camera, floor_z_m, planes):
            things.append(Things(kind=opening.kind, position_m=opening.position_m, squares=opening.foot_m))
    made = [_landmark(thing, free_space) for thing in things]
    return tuple(sorted(made, key=lambda mark: (mark.kind, float(np.hypot(*mark.position_m[:2])))))


def with_given_landmarks(scene: Scene, told: Sequence[tuple[str, tuple[float, float]]]) -> Scene:
    """The scene with landmarks at places (x, y) that a person told; those of these kinds that were found are dropped.

    Raises InputError for a kind that no sentence knows, and for a place behind or far from the radar.
    """
    made = []
    for kind, (x, y) in told:
        if kind not in KINDS:
            raise InputError(f"a {kind!r} is nothing that a sentence goes to; known: {', '.join(KINDS)}")
        if not (abs(x) <= _FARTHEST_TOLD_M and 0 < y <= _FARTHEST_TOLD_M):
            raise InputError(
                f"the {kind} at {x:g},{y:g} is not before the radar; write metres right of and ahead of it, for example"
                f" {kind}=0.5,3"
            )
        thing = Things(kind=kind, position_m=np.array([x, y, scene.floor_z_m + 1.0]), squares=np.array([[x, y]]))
        made.append(_landmark(thing, scene.free_space))
    kinds = {kind for kind, _ in told}
    notes = tuple(f"The {kind} at x {x:g} m, y {y:g} m was told, not found." for kind, (x, y) in told)
    return replace(
        scene,
        landmarks=(*(mark for mark in scene.landmarks if mark.kind not in kinds), *made),
        assumptions=(*scene.assumptions, *notes),
    )


def _tops(
    photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float, height_map: HeightMap, seats: tuple[Seat, ...]
) -> list[Things]:
    from scipy import ndimage

    found: list[Things] = []
    beds = bed_squares(height_map)
    labels, count = labelled(beds)
    for label in range(1, count + 1):
        squares = labels == label
        if squares.sum() * CELL_M**2 >= _MIN_BED_M2:
            found.append(_thing("bed", squares, height_map, floor_z_m))
    taken = beds | _near_seats(height_map, seats, floor_z_m)
    for height in np.arange(_TABLE_M[0], _COUNTER_M[1], 0.02):
        near = (np.abs(height_map.top_m - height) < _LEVEL_M) & ~taken
        # Cups and noise leave gaps; legs and rails are narrower than a top.
        whole = ndimage.binary_closing(near, structure=np.ones((3, 3), bool))
        labels, count = labelled(np.asarray(ndimage.binary_opening(whole, structure=np.ones((4, 4), bool)), bool))
        for label in range(1, count + 1):
            squares = labels == label
            kind = _kind_of(squares, height, photo, radar_from_camera, floor_z_m, height_map)
            thing = _thing(kind, squares, height_map, floor_z_m)
            # One top may fall apart where things stand on it.
            if kind and all(np.hypot(*(thing.position_m - other.position_m)[:2]) > _APART_M for other in found):
                found.append(thing)
            if kind or squares.sum() * CELL_M**2 >= _MIN_TOP_M2:
                taken |= squares
    return found


def _kind_of(
    squares: Bool[Array, "y x"],
    height_m: float,
    photo: RgbdPhoto,
    radar_from_camera: Rotation,
    floor_z_m: float,
    height_map: HeightMap,
) -> str:
    """table | counter | "" for a level patch: a table is hollow below, what is solid is a chest or a cabinet."""
    from scipy import ndimage

    area = float(squares.sum()) * CELL_M**2
    if area >= _MIN_COUNTER_M2 and height_m >= _COUNTER_M[0]:
        return "counter"
    if area < _MIN_TOP_M2 or height_m >= _COUNTER_M[0]:
        return ""
    whole = ndimage.binary_fill_holes(ndimage.binary_closing(squares, structure=np.ones((5, 5), bool)))
    is_deep = np.asarray(ndimage.distance_transform_edt(np.asarray(whole))).max() * CELL_M > _HALF_DEPTH_M
    if is_deep and height_m > _LOW_M:
        return "table"  # chests are not as deep; what seems solid below are its chairs
    return "" if _solid_share(squares, height_m, photo, radar_from_camera, floor_z_m, height_map) > 0.6 else "table"


def _solid_share(
    squares: Bool[Array, "y x"],
    height_m: float,
    photo: RgbdPhoto,
    radar_from_camera: Rotation,
    floor_z_m: float,
    height_map: HeightMap,
) -> float:
    """At which share of the bearings under which a patch is seen something stands below its near edge."""
    from mmweaver.geometry.pinhole import unproject

    points = (unproject(photo.depth_m, photo.intrinsics) @ radar_from_camera.T)[::2, ::2].reshape(-1, 3)
    above = points[:, 2] - floor_z_m
    points = points[(above > 0.20) & (above < height_m - 0.08)]
    row, column = np.nonzero(squares)
    x, y = height_map.x_m[column], height_map.y_m[row]
    step = 0.02
    edge_bin = np.round(np.arctan2(x, y) / step).astype(int)
    point_bin = np.round(np.arctan2(points[:, 0], points[:, 1]) / step).astype(int)
    reach = np.hypot(points[:, 0], points[:, 1])
    bins = np.unique(edge_bin)
    solid = 0
    for one in bins:
        edge = np.hypot(x, y)[edge_bin == one].min()
        under = reach[point_bin == one]
        solid += int((((under > edge - 0.12) & (under < edge + 0.10)).sum()) >= 4)
    return solid / max(len(bins), 1)


def _near_seats(height_map: HeightMap, seats: tuple[Seat, ...], floor_z_m: float) -> Bool[Array, "y x"]:
    x, y = np.meshgrid(height_map.x_m, height_map.y_m)
    near = np.zeros(x.shape, bool)
    for seat in seats:
        level = np.abs(height_map.top_m - (seat.position_m[2] - floor_z_m)) < 0.05
        near |= (np.hypot(x - seat.position_m[0], y - seat.position_m[1]) < 0.45) & level
    return near


def _thing(kind: str, squares: Bool[Array, "y x"], height_map: HeightMap, floor_z_m: float) -> Things:
    row, column = np.nonzero(squares)
    places = np.stack([height_map.x_m[column], height_map.y_m[row]], axis=1)
    top = float(np.nanmedian(height_map.top_m[squares]))
    middle = (places.min(axis=0) + places.max(axis=0)) / 2
    return Things(kind=kind, position_m=np.array([middle[0], middle[1], floor_z_m + top]), squares=places)


def _named(photo: RgbdPhoto, radar_from_camera: Rotation, floor_z_m: float, planes: tuple[Plane, ...]) -> list[Things]:
    """One thing for each patch of the mask of a class that is a landmark."""
    found: list[Things] = []
    for kind, points in named_points(photo, radar_from_camera, planes):
        height = points[:, 2] - floor_z_m
        if kind == "table":
            # The mask takes in the legs; the top is what one goes to.
            points = points[height > np.percentile(height, 60) - 0.05]
        low, high = np.percentile(points, [4, 96], axis=0)
        places = np.unique(np.floor(points[:, :2] / CELL_M), axis=0) * CELL_M + CELL_M / 2
        position = (low + high) / 2
        if any(other.kind == kind and np.hypot(*(other.position_m - position)[:2]) < _APART_M for other in found):
            continue
        found.append(Things(kind=kind, position_m=position, squares=places))
    return found


def _landmark(thing: Things, free_space: FreeSpace) -> Landmark:
    """With the place to stand at: the free place, wide enough for a body, that is nearest to the thing."""
    from scipy import ndimage

    clearance = np.asarray(ndimage.distance_transform_edt(np.pad(free_space.is_free, 1)))[1:-1, 1:-1] - 0.5
    row, column = np.nonzero(clearance * CELL_M >= _BODY_M)
    places = np.stack([free_space.x_m[column], free_space.y_m[row]], axis=1).astype(float)
    middle = thing.position_m[:2]
    best = None
    if len(places):
        some = thing.squares[:: max(1, len(thing.squares) // 200)]
        gap = np.min(np.hypot(*(places[:, None] - some[None]).transpose(2, 0, 1)), axis=1)
        # Of nearly equal ones the one before the middle.
        cost = gap + 0.25 * np.hypot(*(places - middle).T)
        at = int(np.argmin(cost))
        if gap[at] < _FARTHEST_M:
            best = places[at]
    if best is None:
        away = -middle / max(float(np.hypot(*middle)), 1e-6)
        best = middle + 0.6 * away
    ahead = middle - best
    return Landmark(
        kind=thing.kind,
        position_m=thing.position_m,
        approach_m=(float(best[0]), float(best[1])),
        facing_rad=float(np.arctan2(ahead[1], ahead[0])),
    )
