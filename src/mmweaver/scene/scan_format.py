"""Records of a scan folder: one frame of it, and what a reader of a format consists of."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.safe_files.regular_files import foreign_errors
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.core.shapes import DepthPixels, RgbPixels
from mmweaver.scene.photo.capture_photo import Pose


@dataclass(frozen=True, kw_only=True)
class ScanFrame:
    """One frame of a scan, pictures in their stored orientation."""

    rgb: RgbPixels
    depth_m: DepthPixels
    lens: Any  # fx, fy, cx, cy of the colours
    files: dict[str, Path]
    confidence: np.ndarray | None = None  # of the depth; 0 is the lowest
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class ScanFormat:
    """A kind of scan folder.

    Args:
        markers: Glob patterns of files and folders, all of which identify the format.
        pictures: Glob patterns of the pictures; the first pattern with matches counts. Frames are numbered by the last
            number in their names.
        read: Reads the frame of a picture of the folder.
        pose: Pose of that frame as stored, camera (x right, y down, z forward) to world; None if the scan has none.
        up: Axis of the world that points up; None if pictures are stored upright.
    """

    markers: tuple[str, ...]
    pictures: tuple[str, ...]
    read: Callable[[Path, Path], ScanFrame]
    pose: Callable[[Path, Path], Pose | None]
    up: int | None = None


def number_table(path: Path) -> np.ndarray:
    """Rows of numbers separated by commas or spaces; a header line and comments (#) are skipped."""
    lines = [line.replace(",", " ").split() for line in read_text(path).splitlines() if not line.startswith("#")]
    rows = [line for line in lines if line]
    with foreign_errors(path, "no table of numbers ({reason}); export the scan again"):
        try:
            return np.array(rows, float).reshape(len(rows), -1)
        except ValueError:
            return np.array(rows[1:], float).reshape(len(rows) - 1, -1)


def checked_pose(pose: np.ndarray) -> Pose | None:
    """A pose (4, 4); None if it is none (ScanNet writes -inf where tracking was lost)."""
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        return None
    is_rotation = np.abs(pose[:3, :3] @ pose[:3, :3].T - np.eye(3)).max() < 1e-2
    return pose if is_rotation else None
