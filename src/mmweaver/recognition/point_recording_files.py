"""Point-cloud recordings on disk: RadHAR's published text files, and .npz.

Axes of these files: x ahead, y to the left, z up, velocity positive = receding. Reference: Singh et al., "RadHAR:
Human Activity Recognition from Point Clouds Generated through a Millimeter-wave Radar", 2019; its public repository.
"""

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import PointCloud
from mmweaver.core.safe_files.regular_files import read_bytes
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import MAX_TEXT_BYTES
from mmweaver.recognition.point_recording import PointRecording

FRAME_RATE_HZ = 30.0
NUMBERS = ("point_id", "x", "y", "z", "velocity")
LINE = re.compile(rb"^(point_id|x|y|z|velocity): *(\S+)", re.MULTILINE)


def read_point_recordings(
    folder: Path | str, labels: Iterable[str], *, frame_rate_hz: float = FRAME_RATE_HZ
) -> list[PointRecording]:
    """Reads every .txt and .npz recording in a folder and its subfolders, sorted by name.

    The activity is the name of a subfolder, or a word of the file name ("Train_walk_3.npz"). Raises InputError for an
    empty folder, and for a file that names no activity or several, or cannot be read.
    """
    folder, known = Path(folder), tuple(labels)
    if not folder.is_dir():
        raise InputError(f"{folder} is not a folder; give the one that holds the recordings (.txt or .npz)")
    files = sorted(path for path in folder.rglob("*") if path.suffix in (".txt", ".npz") and path.is_file())
    if not files:
        raise InputError(f"{folder} holds no recordings; .txt as RadHAR publishes them or .npz are read")
    return [read_point_recording(path, _label(path, folder, known), frame_rate_hz) for path in files]


def read_point_recording(path: Path, label: str = "", frame_rate_hz: float = FRAME_RATE_HZ) -> PointRecording:
    """Reads one recording. Raises InputError for other files."""
    frame, columns = _from_npz(path) if path.suffix == ".npz" else _from_text(path)
    if len(frame) == 0:
        raise InputError(f"{path} holds no points; leave it out")
    if not np.isfinite(columns).all() or (np.diff(frame) < 0).any():
        raise InputError(f"{path} holds values that are not finite, or frames out of order; leave it out")
    ahead, left, up, velocity = columns.T.astype(float)
    cloud = PointCloud(
        frame=frame - frame[0], x_m=-left, y_m=ahead, z_m=up, radial_velocity_mps=velocity,
        snr_db=np.full(len(frame), np.nan),
    )  # fmt: skip
    return PointRecording(
        name=path.stem, cloud=cloud, num_frames=int(cloud.frame[-1]) + 1, frame_rate_hz=frame_rate_hz, label=label
    )


def _label(path: Path, folder: Path, known: tuple[str, ...]) -> str:
    inside = path.relative_to(folder)
    by_folder = [name for name in known if name in inside.parts[:-1]]
    words = re.split(r"[^a-z]+", path.stem.lower())
    found = by_folder or [name for name in known if name in words]
    if len(found) != 1:
        raise InputError(
            f"{path} does not name its activity; put it into a folder named {', '.join(known[:-1])} or {known[-1]}"
        )
    return found[0]


def _from_npz(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """`frame` (point,) and `pts` (point, 8): x, y, z, range, velocity, Doppler bin, bearing, intensity."""
    held = read_npz(path, only=("frame", "pts"))
    frame = held.numbers("frame", ("point",), low=0, high=1e9).astype(int)
    points = held.numbers("pts", ("point", "column"), low=-1e9, high=1e9)
    if points.shape[1] < 5:
        raise InputError(f"{path} is no recording; pts has shape {points.shape}, (point, 8) is expected")
    return frame, points[:, [0, 1, 2, 4]]


def _from_text(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """One message per point, as `rostopic echo` prints it; point 0 starts a frame."""
    found: dict[bytes, list[bytes]] = {name.encode(): [] for name in NUMBERS}
    for name, value in LINE.findall(read_bytes(path, max_bytes=MAX_TEXT_BYTES)):
        found[name].append(value)
    try:
        point, *columns = (np.array(found[name.encode()], float) for name in NUMBERS)
        table = np.stack(columns, axis=1)
    except ValueError:
        raise InputError(f"{path} is no RadHAR text file; each point needs point_id, x, y, z and velocity") from None
    if len(point) != len(table):
        raise InputError(f"{path} ends in the middle of a point; repair or leave it out")
    return np.maximum(np.cumsum(point == 0) - 1, 0), table
