"""A generated or recorded sequence for the playback page: maps on one absolute dB scale, points and bodies by frame.

A room for the playback page: the surface that the photo saw with the photo on it, faces, free floor, landmarks.
"""

from dataclasses import dataclass, replace
from io import BytesIO
from typing import Any

import numpy as np
from jaxtyping import Float, Int, UInt8

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.body_capsules import CAPSULES, REFERENCE_HEIGHT_M, pose_capsules, radii_m
from mmweaver.core.records import Plane, PointCloud, PoseSequence, RadarCube, Scene
from mmweaver.core.shapes import Array
from mmweaver.core.skeleton import BONES, joint
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.signal.cube import remove_static
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power, range_doppler_power
from mmweaver.viz.theme import evenly_spaced

MAX_FRAMES = 600  # longer sequences are thinned out
BELOW_NOISE_DB = 6.0  # lower end of the scale
_NUM_AZIMUTHS = 81


@dataclass(frozen=True, kw_only=True)
class Playback:
    """A header for JSON and the arrays of a sequence, ready for `wire.pack`.

    Arrays: `range_doppler`, `range_doppler_moving` (frame, range, doppler), `range_azimuth`, `range_azimuth_moving`
    (frame, range, azimuth), `range_time` (frame, range) and `micro_doppler` (frame, doppler) as bytes of power in
    decibels, 0 = `header["db"]["low"]`, 255 = `header["db"]["high"]`; `points` (point, 5): x, y, z in metres, radial
    velocity in m/s, SNR in dB, with `point_frame` (point,); `joints` (person, frame, 22, 3) and `capsules` (person,
    frame, capsule, 6): start and end of each part of the body in metres, with `radii` (person, capsule, 2).
    """

    header: dict[str, Any]
    arrays: dict[str, np.ndarray]


def make_playback(
    cube: RadarCube,
    points: PointCloud,
    poses: tuple[PoseSequence, ...] = (),
    meta: dict[str, Any] | None = None,
    *,
    scale_db: tuple[float, float] | None = None,
) -> Playback:
    """A sequence as a `Playback`.

    Args:
        cube: The cube.
        points: Points of all frames.
        poses: Each person's joints at the cube's frames.
        meta: Contents of its meta.json.
        scale_db: Fixed ends of the scale; by default chosen for this sequence.
    """
    count = len(cube.grid.frame_time_s)
    shown = evenly_spaced(count, MAX_FRAMES)
    time_s = cube.grid.frame_time_s[shown]
    cube = replace(cube, values=cube.values[shown], grid=replace(cube.grid, frame_time_s=time_s))
    maps, azimuth_rad = _maps(cube)
    low_db, high_db, noise_db = _scale(maps)
    low_db, high_db = scale_db or (low_db, high_db)
    arrays: dict[str, np.ndarray] = {name: as_bytes(power_db, low_db, high_db) for name, power_db in maps.items()}
    place_of = np.full(count, -1)
    place_of[shown] = np.arange(len(shown))
    visible = points.select(place_of[points.frame] >= 0)
    visible = visible.select(
        np.argsort(place_of[visible.frame], kind="stable")
    )  # the page finds a frame's by its first
    columns = (visible.x_m, visible.y_m, visible.z_m, visible.radial_velocity_mps, visible.snr_db)
    arrays["points"] = np.stack(columns, -1).astype(np.float32).reshape(-1, 5)
    arrays["point_frame"] = place_of[visible.frame].astype(np.int32)
    if poses:
        arrays |= _bodies(poses, shown)
    config = cube.config
    header = {
        "kind": "sequence",
        "frames": len(shown),
        "frames_in_all": count,
        "time_s": time_s,
        "frame_period_s": config.frame_period_s,
        "range_m": _edges(cube.grid.range_m, config.range_resolution_m),
        "velocity_mps": _edges(cube.grid.radial_velocity_mps, config.velocity_resolution_mps),
        "azimuth_rad": _edges(azimuth_rad, float(azimuth_rad[1] - azimuth_rad[0])),
        "db": {
            "low": low_db,
            "high": high_db,
            "noise": noise_db,
            "unit": "dBm" if np.isfinite(cube.scale) else "dB, uncalibrated",
        },
        "people": len(poses),
        "bones": BONES,
        "pelvis": joint("pelvis"),
        "radar": config.name,
        "meta": meta or {},
    }
    return Playback(header=header, arrays=arrays)


def as_bytes(power_db: Float[Array, "*shape"], low_db: float, high_db: float) -> UInt8[Array, "*shape"]:
    """Decibels as bytes.

    Args:
        power_db: Power (...) in dB.
        low_db: Level of byte 0 and below.
        high_db: Level of byte 255 and above.
    """
    share = (power_db - low_db) / (high_db - low_db)
    return (np.clip(share, 0, 1) * 255).round().astype(np.uint8)


def _maps(cube: RadarCube) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """All maps in decibels, and the azimuths of the range-azimuth ones."""
    azimuth_rad = azimuth_axis_rad(_NUM_AZIMUTHS)
    moving = remove_static(cube)
    doppler, doppler_moving = range_doppler_power(cube), range_doppler_power(moving)
    power = {
        "range_doppler": doppler,
        "range_doppler_moving": doppler_moving,
        "range_azimuth": range_azimuth_power(cube, azimuth_rad),
        "range_azimuth_moving": range_azimuth_power(moving, azimuth_rad),
        "range_time": doppler_moving.max(axis=2),
        "micro_doppler": doppler_moving.max(axis=1),
    }
    scale = cube.scale if np.isfinite(cube.scale) else 1.0
    floor = np.finfo(np.float64).tiny
    return {name: 10 * np.log10(np.maximum(values * scale**2, floor)) for name, values in power.items()}, azimuth_rad


def _scale(maps: dict[str, np.ndarray]) -> tuple[float, float, float]:
    """Lower end, upper end and noise level in decibels, for all maps alike."""
    cells = maps["range_doppler_moving"]
    used = cells[cells > -1000]
    noise_db = float(np.median(used)) if used.size else -100.0
    high_db = max(float(maps["range_doppler"].max()), float(maps["range_azimuth"].max()), noise_db + 20)
    return noise_db - BELOW_NOISE_DB, high_db, noise_db


def _bodies(poses: tuple[PoseSequence, ...], shown: Int[Array, " frame"]) -> dict[str, np.ndarray]:
    joints, capsules, radii = [], [], []
    for pose in poses:
        chosen = pose.joints_m[shown]
        posed = pose_capsules(chosen, pose.height_m)
        joints.append(chosen)
        capsules.append(np.concatenate([posed.start_m, posed.start_m + posed.axis_m], axis=-1))
        width = np.sqrt([capsule.width_per_depth for capsule in CAPSULES])[:, None]
        radii.append(radii_m(pose.height_m) * width)
    return {
        "joints": np.stack(joints).astype(np.float32),
        "capsules": np.stack(capsules).astype(np.float32),
        "radii": np.stack(radii).astype(np.float32),
    }


def _edges(values: np.ndarray, step: float) -> tuple[float, float]:
    """Outer edges of the first and the last bin."""
    return float(values[0]) - step / 2, float(values[-1]) + step / 2


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
