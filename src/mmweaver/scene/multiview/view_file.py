"""views.json: several photos of one room with depth, and the poses of their cameras.

    {"photos": [
      {"rgb": "a.png", "depth": "a_depth.png", "camera": "camera.json"},
      {"rgb": "b.png", "depth": "b_depth.png", "camera": "camera.json", "place_m": [1.5, 3.0], "turned_deg": 170}
    ]}

The radar is at the first camera. A further photo has either a rough `place_m`, metres right of and ahead of the first
camera, and `turned_deg`, its yaw to the right of it; or `pose`, the 4 x 4 matrix from its camera (x right, y down, z
forward) to a world frame in metres shared by all photos, in which case the first photo has one too.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.scene.photo.capture_photo import CapturedPhoto, Pose, PosedPhoto
from mmweaver.scene.read_photo import read_photo

MAX_PHOTOS = 24
FILES = ("rgb", "depth", "camera", "classes")
KEYS = {*FILES, "pose", "place_m", "turned_deg"}
ROTATION_ERROR = 1e-2


def read_views(path: Path, *, segmenter: str | None = None) -> CapturedPhoto:
    """Reads the photos that a views.json names, paths relative to it.

    Args:
        path: The views.json, in the format above.
        segmenter: Segmentation model for photos without `classes`, as in `read_photo`; None for none.

    Returns:
        The first photo with the others posed relative to it.

    Raises:
        InputError: If the file or one of the photos cannot be used.
    """
    content = read_json(path)
    entries = content.get("photos") if isinstance(content, dict) else None
    if not isinstance(entries, list) or not 1 <= len(entries) <= MAX_PHOTOS:
        raise InputError(f'{path} must be {{"photos": [...]}} with 1 to {MAX_PHOTOS} photos')
    photos, poses, files, notes = [], [], {}, []
    for number, entry in enumerate(entries, 1):
        if not isinstance(entry, dict) or not {"rgb", "depth"} <= set(entry) or not set(entry) <= KEYS:
            raise InputError(f"{path}: photo {number} needs rgb and depth, and may have {', '.join(sorted(KEYS))}")
        own = {name: path.parent / _name(path, number, entry[name]) for name in FILES if entry.get(name) is not None}
        photo, said = read_photo(
            own["rgb"],
            own["depth"],
            own.get("camera"),
            classes=own.get("classes"),
            segmenter=None if "classes" in own else segmenter,
        )
        photos.append(photo)
        poses.append(_pose(path, number, entry))
        files |= {f"{name} {number}": file for name, file in own.items()}
        notes += said
    others = _posed(path, photos, poses)
    return CapturedPhoto(
        photo=photos[0],
        folder=path.parent,
        files={"views": path, **files},
        assumptions=tuple(dict.fromkeys(notes)),
        others=others,
    )


def _name(path: Path, number: int, name: Any) -> str:
    if not isinstance(name, str):
        raise InputError(f"{path}: photo {number}: a file's name is text, not {str(name)[:40]!r}")
    return name


def _pose(path: Path, number: int, entry: dict[str, Any]) -> Pose | RadarPose | None:
    """Pose of an entry's camera; None if the entry has none."""
    if "pose" in entry:
        if "place_m" in entry or "turned_deg" in entry:
            raise InputError(f"{path}: photo {number} has a pose; leave out place_m and turned_deg, or the pose")
        return rigid(entry["pose"], f"{path}: photo {number}")
    if "place_m" not in entry and "turned_deg" not in entry:
        return None
    place, turned = entry.get("place_m", [0, 0]), entry.get("turned_deg", 0)
    is_place = isinstance(place, list) and len(place) == 2 and all(map(_is_number, place))
    if not is_place or not _is_number(turned) or abs(turned) > 360:
        raise InputError(f"{path}: photo {number}: place_m is [right, ahead] in metres, turned_deg from -360 to 360")
    return RadarPose(x_m=float(place[0]), y_m=float(place[1]), yaw_deg=float(turned))


def rigid(values: Any, where: str) -> Pose:
    """Validates a rigid transform and orthonormalizes its rotation.

    Args:
        values: Matrix, (4, 4), as nested lists or array.
        where: Start of the error message.

    Returns:
        The pose, (4, 4).

    Raises:
        InputError: If it is not a finite (4, 4) matrix with a rotation in its upper left.
    """
    try:
        pose = np.array(values, float)
    except (TypeError, ValueError):
        pose = np.zeros(0)
    if pose.shape != (4, 4) or not np.isfinite(pose).all() or not np.allclose(pose[3], [0, 0, 0, 1], atol=1e-6):
        raise InputError(f"{where}: a pose is a 4 x 4 matrix of numbers whose last row is 0, 0, 0, 1")
    turn = pose[:3, :3]
    if np.abs(turn @ turn.T - np.eye(3)).max() > ROTATION_ERROR or np.linalg.det(turn) < 0:
        raise InputError(f"{where}: the pose's first three columns are no rotation; from the camera to the world?")
    left, _, right = np.linalg.svd(turn)
    pose[:3, :3] = left @ right
    return pose


def _posed(path: Path, photos: list[RgbdPhoto], poses: list[Pose | RadarPose | None]) -> tuple[PosedPhoto, ...]:
    """The further photos, their poses relative to the first."""
    first, found = poses[0], []
    if isinstance(first, RadarPose):
        raise InputError(f"{path}: the first photo's place is where the others are measured from; leave its own out")
    for number, (photo, pose) in enumerate(zip(photos[1:], poses[1:], strict=True), 2):
        if pose is None:
            raise InputError(f"{path}: where was photo {number} taken? give pose, or place_m and turned_deg")
        if isinstance(pose, RadarPose):
            found.append(PosedPhoto(photo=photo, pose=pose))
        elif first is None:
            raise InputError(f"{path}: photo {number} has a pose and the first has none; give it one of the same world")
        else:
            found.append(PosedPhoto(photo=photo, pose=np.linalg.inv(first) @ pose))
    return tuple(found)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
