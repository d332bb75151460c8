"""A room for the playback page: the surface that the photo saw with the photo on it, faces, free floor, landmarks."""

from io import BytesIO
from typing import Any

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.core.records import Plane, Scene
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.viz.sequence import Playback

MAX_POINTS = 40_000
MAX_PHOTO_PX = 1024  # longer side of the photo on the surface
EDGE_SHARE, EDGE_M = 0.04, 0.05  # a step in depth between neighbours beyond which the surface is cut
FRUSTUM_M = 0.6  # depth of the camera's pyramid of view as drawn
_REFLECTORS = ("metal", "glass", "marble")


def room_playback(
    scene: Scene, name: str, range_window_m: tuple[float, float], *, max_points: int = MAX_POINTS
) -> Playback:
    """The header and arrays of a room.

    Arrays: `room_points` (vertex, 3) int16 in millimetres with `room_uv` (vertex, 2), its place in the photo from 0 to
    32767 rightwards and downwards; `room_faces` (face, 3), triangles that are cut where depth jumps; `room_photo`, a
    JPEG; `free_floor` (cell, 2) float32, x and y in metres of the free cells of the floor, and `standable`
    (cell,), 1 where the planner allows a person of average height to stand in view of the radar.

    Args:
        scene: The room.
        name: Name of the room.
        range_window_m: Nearest and farthest range of the radar.
        max_points: Maximum number of vertices.
    """
    aligned = AlignedPhoto.of(scene)
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
        "camera_m": aligned.camera_m,
        "camera_corners_m": aligned.camera_m + FRUSTUM_M * aligned.rays[[0, 0, -1, -1], [0, -1, -1, 0]],
    }
    arrays = _surface(aligned, max_points) | {
        "free_floor": np.stack([free.x_m[columns], free.y_m[rows]], -1).astype(np.float32).reshape(-1, 2),
        "standable": walkable[rows, columns].astype(np.uint8),
    }
    return Playback(header=header, arrays=arrays)


def _surface(aligned: AlignedPhoto, max_points: int) -> dict[str, np.ndarray]:
    """Vertices, triangles and photo of the surface; two triangles for each square of pixels without a jump in depth."""
    from PIL import Image

    points_m, depth_m = aligned.points_m, aligned.photo.depth_m
    step = max(1, int(np.ceil(np.sqrt(depth_m.size / max_points))))
    rows, columns = (np.arange(0, size, step) for size in depth_m.shape)
    points_m, depth_m = points_m[rows[:, None], columns], depth_m[rows[:, None], columns]
    number = np.arange(depth_m.size).reshape(depth_m.shape)
    corners = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]])
    triangles = np.concatenate([corners[[0, 1, 2]].reshape(3, -1).T, corners[[0, 2, 3]].reshape(3, -1).T])
    depths_m = depth_m.ravel()[triangles]
    nearest_m, farthest_m = depths_m.min(axis=1), depths_m.max(axis=1)  # nan where one is not measured
    triangles = triangles[farthest_m - nearest_m < EDGE_M + EDGE_SHARE * step * nearest_m]
    used, faces = np.unique(triangles, return_inverse=True)
    height, width = aligned.photo.depth_m.shape
    row, column = np.divmod(used, len(columns))
    uv = np.stack([(columns[column] + 0.5) / width, (rows[row] + 0.5) / height], axis=-1)
    photo, file = Image.fromarray(aligned.photo.rgb), BytesIO()
    photo.thumbnail((MAX_PHOTO_PX, MAX_PHOTO_PX))
    photo.save(file, "JPEG", quality=85)
    return {
        "room_points": (points_m.reshape(-1, 3)[used] * 1000).round().clip(-32768, 32767).astype(np.int16),
        "room_uv": (uv * 32767).round().astype(np.int16),
        "room_faces": faces.reshape(-1, 3).astype(np.int32),
        "room_photo": np.frombuffer(file.getvalue(), np.uint8),
    }


def _plane(plane: Plane) -> dict[str, Any]:
    """Corners in order around the rectangle, and the material."""
    return {
        "kind": plane.kind,
        "material": plane.material,
        "corners_m": np.round(plane.corners_m, 3),
        "reflects": any(word in plane.material for word in _REFLECTORS),
    }
