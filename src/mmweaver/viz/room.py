"""A room for the playback page: coloured points of the photo, surfaces, free floor, seats and landmarks."""

from typing import Any

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.core.records import Plane, Scene
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.viz.sequence import Playback

MAX_POINTS = 60_000
_REFLECTORS = ("metal", "glass", "marble")


def room_playback(
    scene: Scene, name: str, range_window_m: tuple[float, float], *, max_points: int = MAX_POINTS
) -> Playback:
    """The header and arrays of a room.

    Arrays: `room_points` (point, 3) int16 in millimetres and `room_colours` (point, 3) bytes; `free_floor` (cell, 2)
    float32, x and y in metres of the free cells of the floor, and `standable` (cell,), 1 where the planner allows a
    person of average height to stand in view of the radar.

    Args:
        scene: The room.
        name: Name of the room.
        range_window_m: Nearest and farthest range of the radar.
        max_points: Maximum number of points.
    """
    points_m = AlignedPhoto.of(scene).points_m
    measured = np.isfinite(points_m).all(axis=-1)
    step = max(1, int(np.ceil(np.sqrt(measured.sum() / max_points))))
    chosen = np.zeros_like(measured)
    chosen[::step, ::step] = True
    chosen &= measured
    free = scene.free_space
    rows, columns = np.nonzero(free.is_free)
    walkable = FloorMap(scene, range_window_m, REFERENCE_HEIGHT_M).walkable
    cell_m = float(free.x_m[1] - free.x_m[0]) if len(free.x_m) > 1 else 0.05
    header: dict[str, Any] = {
        "kind": "room",
        "name": name,
        "floor_z_m": scene.floor_z_m,
        "cell_m": cell_m,
        "planes": [_plane(plane) for plane in scene.planes],
        "seats": [seat.position_m for seat in scene.seats],
        "landmarks": [{"kind": mark.kind, "place_m": mark.position_m} for mark in scene.landmarks],
        "assumed": list(scene.assumptions),
    }
    arrays = {
        "room_points": (points_m[chosen] * 1000).round().clip(-32768, 32767).astype(np.int16),
        "room_colours": scene.photo.rgb[chosen].astype(np.uint8),
        "free_floor": np.stack([free.x_m[columns], free.y_m[rows]], -1).astype(np.float32).reshape(-1, 2),
        "standable": walkable[rows, columns].astype(np.uint8),
    }
    return Playback(header=header, arrays=arrays)


def _plane(plane: Plane) -> dict[str, Any]:
    """Corners in order around the rectangle, and the material."""
    return {
        "kind": plane.kind,
        "material": plane.material,
        "corners_m": np.round(plane.corners_m, 3),
        "reflects": any(word in plane.material for word in _REFLECTORS),
    }
