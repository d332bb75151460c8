"""Puts furniture that the photo does not show into a reconstructed room: mesh, depth, seats, landmarks, floor."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.placed_thing import PlacedThing
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import LANDMARK_KINDS, FreeSpace, RgbdPhoto, Scene, Seat
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.scene.affordances.landmarks import find_approach
from mmweaver.scene.layout.doors_and_windows import LandmarkCandidate
from mmweaver.scene.procedural.furniture import make_piece
from mmweaver.scene.procedural.meshing import part_triangles
from mmweaver.scene.procedural.palette import sample_palette
from mmweaver.scene.procedural.parts import Piece, PlacedPiece

# Kinds that --furnish takes, and the record of furniture.toml of each.
RECORD_OF = {
    "bed": "bed",
    "desk": "desk",
    "table": "small dining table",
    "chair": "chair",
    "armchair": "armchair",
    "stool": "stool",
    "bench": "bench",
    "couch": "sofa",
    "sofa": "sofa",
    "wardrobe": "wardrobe",
    "sink": "counter",
    "counter": "counter",
    "door": "door",
    "window": "window",
    "shelf": "bookcase",
    "cabinet": "cabinet",
    "fridge": "refrigerator",
    "stove": "oven",
    "tv": "television",
    "plant": "plant",
    "lamp": "floor lamp",
}
SEATS = ("chair", "armchair", "stool", "bench", "couch", "sofa")
FARTHEST_M = 10.0
_TRIES, _BEFORE_M, _FREE_SHARE = 600, 0.5, 0.93  # places tried; floor before the front of a piece; free share of both
_WALLS, _FLOORS = ("paint",), ("boards",)  # kinds of the palette; pieces use neither
_LIGHT = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])  # of the picture: from above, behind the camera

Furniture = tuple[str, tuple[float, float], float | None]


def furnished(scene: Scene, items: Sequence[Furniture], seed: int = 0) -> Scene:
    """The room with further furniture, which echoes, occludes, occupies floor and can be used.

    Args:
        scene: The room.
        items: Kind, place (x, y) in metres of the middle of the piece on the floor, and the direction that its front
            faces, from +x towards +y; None faces the radar.
        seed: Seed of sizes and colours.

    Returns:
        The room; the photo's depth and colour show the furniture, too.

    Raises:
        InputError: For an unknown kind, or a place behind the radar or farther than 10 m.
    """
    for kind, place_m, facing_rad in items:
        scene = _with_piece(scene, kind, place_m, facing_rad, seed)
    return scene


def free_place(scene: Scene, kind: str, farthest_m: float, *, seed: int = 0, side: str = "") -> PlacedThing | None:
    """Samples where a piece of furniture fits: on free floor, its back to an edge of it, room before its front.

    Args:
        scene: The room.
        kind: Kind of furniture.
        farthest_m: Farthest distance of its middle from the radar.
        seed: Seed of the place, and of the size as in `furnished`.
        side: left or right of the radar; "" for either.

    Returns:
        Kind, place and front; None if it fits nowhere, or is no furniture.
    """
    if kind not in RECORD_OF:
        return None
    piece = _piece(kind, seed)
    rng = stream(seed, "furnish", kind, "place")
    free = scene.free_space
    is_free = free.is_free if free.is_assumed is None else free.is_free | free.is_assumed
    x, y = np.meshgrid(free.x_m, free.y_m)
    if piece.on_wall:
        return _place_on_wall(scene, kind, piece.half_m, np.stack([x[is_free], y[is_free]], axis=-1), side)
    cells = np.argwhere(is_free)
    best: tuple[float, PlacedThing] | None = None
    for row, column in cells[rng.permutation(len(cells))[:_TRIES]]:
        front_rad = float(rng.integers(8)) * np.pi / 4
        at = (float(free.x_m[column]), float(free.y_m[row]))
        own = {"left": at[0] < 0, "right": at[0] > 0}.get(side, True)
        if not own or np.hypot(*at) > farthest_m:
            continue
        placed = PlacedPiece(piece=piece, x_m=at[0], y_m=at[1], yaw_rad=front_rad + np.pi / 2)
        low, high = piece.low_m, piece.high_m
        body = _rectangle(placed, low[0], high[0], low[1] - _BEFORE_M, high[1])
        behind = _rectangle(placed, low[0], high[0], high[1] + 0.1, high[1] + 0.15)
        if not _all_free(free, is_free, body):
            continue
        off_radar = abs((front_rad - np.arctan2(-at[1], -at[0]) + np.pi) % (2 * np.pi) - np.pi)
        cost = float(_share_free(free, is_free, behind)) + 0.3 * off_radar - 0.1 * np.hypot(*at)
        if best is None or cost < best[0]:
            best = cost, PlacedThing(kind, at, float(np.round(np.degrees(front_rad + np.pi / 2), 1)))
    return None if best is None else best[1]


def _place_on_wall(
    scene: Scene, kind: str, half_m: float, floor_m: Float[Array, "cell 2"], side: str
) -> PlacedThing | None:
    """The middle of the wall that is nearest to free floor; doors and windows hang there."""
    found: list[tuple[float, PlacedThing]] = []
    for wall in (plane for plane in scene.planes if plane.kind == "wall"):
        along = wall.axis_u if abs(wall.axis_u[2]) < 0.5 else wall.axis_v
        reach_m = wall.half_size_m[0] if along is wall.axis_u else wall.half_size_m[1]
        front_deg = float(np.degrees(np.arctan2(wall.normal[1], wall.normal[0]) + np.pi / 2))
        for shift_m in np.linspace(-max(reach_m - half_m, 0), max(reach_m - half_m, 0), 7):
            at = (wall.centre_m + shift_m * along)[:2]
            gap_m = float(np.hypot(*(floor_m - at).T).min(initial=np.inf))
            if {"left": at[0] < 0, "right": at[0] > 0}.get(side, True) and 0.3 < at[1] <= FARTHEST_M and gap_m < 1.0:
                found.append((gap_m + abs(shift_m), PlacedThing(kind, (float(at[0]), float(at[1])), front_deg)))
    return min(found, key=lambda one: one[0])[1] if found else None


def _rectangle(placed: PlacedPiece, *sides: float) -> Float[Array, "point 2"]:
    left, right, front, back = sides
    x, y = np.meshgrid(np.linspace(left, right, 7), np.linspace(front, back, 7))
    return placed.points(np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=-1))[:, :2]


def _share_free(free: FreeSpace, is_free: np.ndarray, points_m: Float[Array, "point 2"]) -> float:
    column = np.round((points_m[:, 0] - free.x_m[0]) / (free.x_m[1] - free.x_m[0])).astype(int)
    row = np.round((points_m[:, 1] - free.y_m[0]) / (free.y_m[1] - free.y_m[0])).astype(int)
    inside = (column >= 0) & (column < len(free.x_m)) & (row >= 0) & (row < len(free.y_m))
    return float(np.mean(inside & is_free[np.clip(row, 0, len(free.y_m) - 1), np.clip(column, 0, len(free.x_m) - 1)]))


def _all_free(free: FreeSpace, is_free: np.ndarray, points_m: Float[Array, "point 2"]) -> bool:
    return _share_free(free, is_free, points_m) >= _FREE_SHARE


def _piece(kind: str, seed: int) -> Piece:
    rng = stream(seed, "furnish", kind)
    return make_piece(RECORD_OF[kind], sample_palette(rng, _WALLS, _FLOORS), rng)


def _with_piece(scene: Scene, kind: str, place_m: tuple[float, float], facing_rad: float | None, seed: int) -> Scene:
    x, y = place_m
    if kind not in RECORD_OF:
        raise InputError(f"no furniture {kind!r} is known; known: {', '.join(RECORD_OF)}")
    if not (abs(x) <= FARTHEST_M and 0 < y <= FARTHEST_M):
        raise InputError(
            f"the {kind} at {x:g},{y:g} is not in front of the radar; give metres right of and ahead of it, for example"
            f" {kind}=0.5,2"
        )
    piece = _piece(kind, seed)
    front_rad = float(np.arctan2(-y, -x)) if facing_rad is None else facing_rad
    placed = PlacedPiece(piece=piece, x_m=x, y_m=y, z_m=scene.floor_z_m, yaw_rad=front_rad + np.pi / 2)
    parts = [(part, *part_triangles(part)) for part in piece.parts]
    vertices = [placed.points(corners) for _, corners, _ in parts]
    starts = np.cumsum([0, *map(len, vertices)])[:-1]
    faces = np.concatenate([triangles + start for (_, _, triangles), start in zip(parts, starts, strict=True)])
    of_part = np.repeat(np.arange(len(parts)), [len(triangles) for _, _, triangles in parts])
    names = scene.material_names
    materials = tuple(dict.fromkeys(part.appearance.material for part, *_ in parts))
    names = (*names, *(name for name in materials if name not in names))
    index = np.array([names.index(part.appearance.material) for part, *_ in parts])
    corners_m = np.concatenate(vertices)
    colours = np.array([part.appearance.colour for part, *_ in parts])[of_part]
    footprint_m = _footprint(placed, scene.free_space)
    free = _occupied(scene.free_space, footprint_m)
    seats = tuple(
        Seat(
            position_m=placed.points(np.array([seat.x_m, seat.y_m, seat.height_m])),
            facing_rad=front_rad,
            size_m=(seat.width_m, seat.depth_m),
        )
        for seat in piece.seats
    )
    marks = [mark for mark in scene.landmarks if mark.kind != kind]
    if kind in LANDMARK_KINDS and kind not in SEATS:
        squares = footprint_m if len(footprint_m) else np.array([[x, y]])
        middle = np.array([x, y, scene.floor_z_m + max(piece.top_m, 0.5)])
        marks.append(find_approach(LandmarkCandidate(kind=kind, position_m=middle, squares_m=squares), free))
    return replace(
        scene,
        photo=_photo_with(scene, corners_m, faces, colours),
        vertices_m=np.concatenate([scene.vertices_m, corners_m.astype(scene.vertices_m.dtype)]),
        faces=np.concatenate([scene.faces, (faces + len(scene.vertices_m)).astype(scene.faces.dtype)]),
        face_material=np.concatenate([scene.face_material, index[of_part].astype(scene.face_material.dtype)]),
        material_names=names,
        free_space=free,
        seats=(*scene.seats, *seats),
        landmarks=tuple(marks),
        assumptions=(*scene.assumptions, f"A {kind} that the photo does not show stands at x {x:.2f} m, y {y:.2f} m."),
    )


def _footprint(placed: PlacedPiece, free: FreeSpace) -> Float[Array, "cell 2"]:
    """Cells (x, y) of the grid below the piece."""
    low, high = placed.piece.low_m, placed.piece.high_m
    x, y = np.meshgrid(free.x_m, free.y_m)
    gaps = np.stack([x - placed.x_m, y - placed.y_m], axis=-1)
    cosine, sine = np.cos(placed.yaw_rad), np.sin(placed.yaw_rad)
    own = np.stack([gaps @ (cosine, sine), gaps @ (-sine, cosine)], axis=-1)
    inside = ((own >= low[:2]) & (own <= high[:2])).all(axis=-1)
    return np.stack([x[inside], y[inside]], axis=-1)


def _occupied(free: FreeSpace, footprint_m: Float[Array, "cell 2"]) -> FreeSpace:
    columns = np.searchsorted(free.x_m, footprint_m[:, 0] - 1e-9)
    rows = np.searchsorted(free.y_m, footprint_m[:, 1] - 1e-9)
    is_free, is_assumed = free.is_free.copy(), None if free.is_assumed is None else free.is_assumed.copy()
    is_free[rows, columns] = False
    if is_assumed is not None:
        is_assumed[rows, columns] = False
    return replace(free, is_free=is_free, is_assumed=is_assumed)


def _photo_with(
    scene: Scene, corners_m: Float[Array, "n 3"], faces: np.ndarray, colours: Float[Array, "face 3"]
) -> RgbdPhoto:
    """The photo with the piece before what is behind it: depth, colour and, where there are classes, none."""
    photo = scene.photo
    rays = viewing_rays(photo.intrinsics).reshape(-1, 3) @ scene.radar_from_camera.T
    length = np.linalg.norm(rays, axis=1)
    eye_m = np.broadcast_to(scene.radar_pose.seen(np.zeros(3)), rays.shape)
    distance, face = RayCaster(corners_m, faces).first_hit(eye_m, rays / length[:, None])
    depth = np.where(face >= 0, distance / length, np.inf).reshape(photo.depth_m.shape)
    covers = depth < np.where(np.isfinite(photo.depth_m), photo.depth_m, np.inf)
    corner = corners_m[faces]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-9)[:, None]
    shade = 0.45 + 0.55 * np.abs(normal @ _LIGHT)
    linear = np.clip(colours * shade[:, None], 0, 1)
    rgb = photo.rgb.copy()
    hit = covers.reshape(-1) & (face >= 0)
    rgb.reshape(-1, 3)[hit] = np.round(255 * linear[face[hit]] ** (1 / 2.2)).astype(np.uint8)
    classes = photo.classes
    if classes is not None:
        classes = replace(classes, index=np.where(covers, 0, classes.index).astype(classes.index.dtype))
    depth_m = np.where(covers, depth, photo.depth_m).astype(photo.depth_m.dtype)
    return replace(photo, rgb=rgb, depth_m=depth_m, classes=classes)
