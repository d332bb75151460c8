"""Where the camera was at each frame of a scan: folders of Stray Scanner, Record3D, Polycam, ScanNet and TUM RGB-D."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.scene.photo.number_table import number_table
from mmweaver.scene.photo.posed_photo import Pose

Y_UP_CAMERA = np.diag([1.0, -1.0, -1.0, 1.0])  # from x right, y down, z forward to ARKit's x right, y up, z backward
TUM_APART_S = 0.05
DEGREES_A_METRE = 30.0  # how far a camera turns to show as much that is new as a metre further on
ENOUGH = 1.0  # metres, or so turned: nearer frames show little that is new


def scan_pose(folder: Path, kind: str, frame: Path) -> Pose | None:
    """The pose of the frame of a colour or depth picture, as stored, camera (x right, y down, z forward) to world.

    None where the scan does not say it.
    """
    number = frame.stem
    if kind != "ScanNet" and not number.replace(".", "", 1).isdigit():
        return None
    if kind == "Stray Scanner":
        return _nearest_row(folder / "odometry.csv", float(number), 1, slice(2, 9), apart=0.5)
    if kind == "TUM RGB-D":
        return _nearest_row(folder / "groundtruth.txt", float(number), 0, slice(1, 8), apart=TUM_APART_S)
    if kind == "ScanNet":
        file = folder / "pose" / f"{number}.txt"
        return _matrix(number_table(file, allow_infinite=True)) if file.is_file() else None
    if kind == "Polycam":
        cameras = "corrected_cameras" if (folder / "keyframes" / "corrected_images").is_dir() else "cameras"
        said = read_json(folder / "keyframes" / cameras / f"{number}.json")
        return _polycam_pose(said)
    poses = read_json(folder / "metadata").get("poses")
    if not isinstance(poses, list) or int(number) >= len(poses):
        return None
    values = poses[int(number)]
    return _quaternion_pose([*values[4:7], *values[:4]], Y_UP_CAMERA) if isinstance(values, list) else None


def spread_out(poses: Sequence[Pose | None], first: int, most: int = 5) -> list[int]:
    """The frames whose cameras stand and look most differently from the first, whose pose is known, and each other."""
    known = {index: pose for index, pose in enumerate(poses) if pose is not None}
    places = {index: _place_and_direction(pose) for index, pose in known.items()}
    chosen = [first]
    while len(chosen) <= most:
        new = {
            index: min(float(np.linalg.norm(place - places[one])) for one in chosen) for index, place in places.items()
        }
        best = max(new, key=lambda index: new[index])
        if new[best] < ENOUGH:
            break
        chosen.append(best)
    return chosen[1:]


def _place_and_direction(pose: Pose) -> np.ndarray:
    """Metres; the direction is scaled so that DEGREES_A_METRE are one."""
    return np.concatenate([pose[:3, 3], pose[:3, 2] * 57.3 / DEGREES_A_METRE])


def _nearest_row(path: Path, key: float, column: int, values: slice, *, apart: float) -> Pose | None:
    """The row of a table of poses (place, quaternion x y z w) nearest to a key."""
    if not path.is_file():
        return None
    rows = number_table(path)
    if rows.shape[1] == 7 and column:  # Stray Scanner until 2021: a line a frame, no time and number
        return _quaternion_pose(rows[int(key)].tolist(), np.eye(4)) if int(key) < len(rows) else None
    if rows.shape[1] < values.stop:
        return None
    nearest = int(np.argmin(np.abs(rows[:, column] - key)))
    if abs(rows[nearest, column] - key) > apart:
        return None
    return _quaternion_pose(rows[nearest, values].tolist(), np.eye(4))


def _quaternion_pose(values: Sequence[Any], own_axes: np.ndarray) -> Pose | None:
    """From place and quaternion (x, y, z, w); None where they are no pose."""
    from scipy.spatial.transform import Rotation

    try:
        numbers = np.array(values, float)
    except (TypeError, ValueError):
        return None
    if numbers.shape != (7,) or not np.isfinite(numbers).all() or np.linalg.norm(numbers[3:]) < 0.5:
        return None
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.from_quat(numbers[3:]).as_matrix(), numbers[:3]
    return pose @ own_axes


def _polycam_pose(said: Any) -> Pose | None:
    try:
        rows = [[float(said[f"t_{row}{column}"]) for column in range(4)] for row in range(3)]
    except (KeyError, TypeError, ValueError):
        return None
    return _matrix(np.array([*rows, [0.0, 0.0, 0.0, 1.0]]) @ Y_UP_CAMERA)


def _matrix(pose: np.ndarray) -> Pose | None:
    """A pose; None for what is none (ScanNet writes -inf where tracking was lost)."""
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        return None
    is_rotation = np.abs(pose[:3, :3] @ pose[:3, :3].T - np.eye(3)).max() < 1e-2
    return pose if is_rotation else None
