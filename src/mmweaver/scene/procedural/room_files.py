"""Writes a procedural room to files: the input of `mmweaver generate`, the class mask, and the ground truth."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import RgbdPhoto
from mmweaver.core.rotations import pitch_and_roll_rad
from mmweaver.scene.procedural.procedural_room import ProceduralRoom

DEPTH_UNIT_M = 0.0002  # 16 bits reach 13 m; the step is far below a sensor's noise
TRUTH_VERSION = 1


def write_room(folder: Path, room: ProceduralRoom, photo: RgbdPhoto, lighting: str) -> None:
    """Writes rgb.png, depth.png, camera.json, classes.png, classes.json and truth.json.

    Args:
        folder: Existing folder.
        room: The room.
        photo: Photo of it.
        lighting: Lighting of the photo, recorded in truth.json.
    """
    from PIL import Image

    Image.fromarray(photo.rgb).save(folder / "rgb.png")
    counts = np.nan_to_num(np.round(photo.depth_m / DEPTH_UNIT_M), nan=0.0)
    Image.fromarray(np.clip(counts, 0, 65534).astype(np.uint16)).save(folder / "depth.png")
    camera = {**vars(photo.intrinsics), "depth_unit_m": DEPTH_UNIT_M}
    (folder / "camera.json").write_text(json.dumps(camera, indent=1) + "\n", encoding="utf-8")
    if photo.classes is not None:
        Image.fromarray(photo.classes.index).save(folder / "classes.png")
        names = {str(number): name for number, name in enumerate(photo.classes.names)}
        (folder / "classes.json").write_text(json.dumps(names, indent=1) + "\n", encoding="utf-8")
    (folder / "truth.json").write_text(json.dumps(ground_truth_of(room, lighting), indent=1) + "\n", encoding="utf-8")


def ground_truth_of(room: ProceduralRoom, lighting: str) -> dict[str, Any]:
    """The ground truth of a room for JSON.

    Args:
        room: The room.
        lighting: Lighting of the photo.

    Returns:
        Seats, landmarks, boxes and camera orientation: metres in the radar's frame (x right, y away, z up), radians.
    """
    pitch, roll = pitch_and_roll_rad(room.radar_from_camera)
    boxes = room.boxes
    columns = zip(boxes.names, boxes.piece, boxes.centre_m, boxes.half_m, boxes.yaw_rad, strict=True)
    return {
        "schema_version": TRUTH_VERSION,
        **{name: getattr(room, name) for name in ("kind", "layout", "seed")},
        "lighting": lighting,
        "floor_z_m": _rounded(room.floor_z_m),
        "camera_pitch_rad": _rounded(pitch),
        "camera_roll_rad": _rounded(roll),
        "radar_from_camera": np.round(room.radar_from_camera, 6).tolist(),
        "free_floor_m2": _rounded(room.free_m2),
        "walkable_m2": _rounded(room.walkable_m2),
        "seats": [_rounded(vars(seat)) for seat in room.seats],
        "landmarks": [_rounded(vars(mark)) for mark in room.landmarks],
        "boxes": [
            _rounded(dict(zip(("name", "piece", "centre_m", "half_size_m", "yaw_rad"), row, strict=True)))
            for row in columns
        ],
    }


def _rounded(value: Any) -> Any:
    """Numbers rounded to a tenth of a millimetre, as lists; names and integers unchanged."""
    if isinstance(value, dict):
        return {name: _rounded(inner) for name, inner in value.items()}
    return value if isinstance(value, str | int) else np.round(np.asarray(value, float), 4).tolist()
