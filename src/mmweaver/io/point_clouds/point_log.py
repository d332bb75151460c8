"""Record of a logged point cloud, and the registry of formats: one decorated reader function per format.

@point_format("csv", "CSV with Frame, X, Y, Z, Doppler", lambda path, head: path.suffix.lower() == ".csv")
def read_csv_points(path: Path) -> LoggedCloud: ...
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.shapes import PerIndex, PerPoint

MISSING = float("nan")
MAX_MISSING = 10_000  # frames; a larger step of the counter is a restart


@dataclass(frozen=True, kw_only=True, repr=False)
class LoggedCloud(PointCloud):
    """A PointCloud stored by a board or a data set, with `intensity` in its own unit (nan if missing).

    x to the right, y away from the radar, z up; `frame` counts from 0. `num_frames` includes frames without points,
    those that the log lacks and those at its end; `notes` are sentences on what was found. `missing` are the frames
    that the board counted and the log lacks; None where the format does not tell them from frames without points.
    """

    intensity: PerPoint
    num_frames: int
    notes: tuple[str, ...] = ()
    missing: PerIndex | None = None


Reader = Callable[[Path], LoggedCloud]


@dataclass(frozen=True)
class PointFormat:
    """A format of point clouds.

    Attributes:
        what: Description for messages.
        recognises: Detects the format from the path and the first bytes (empty for a folder).
        read: Reader.
    """

    what: str
    recognises: Callable[[Path, bytes], bool]
    read: Reader


FORMATS: dict[str, PointFormat] = {}


def point_format(name: str, what: str, recognises: Callable[[Path, bytes], bool]) -> Callable[[Reader], Reader]:
    """Decorator that registers a reader; at most one format should recognise a file.

    Args:
        name: Name of the format.
        what: Description for messages.
        recognises: Detects the format from the path and the first bytes.
    """

    def register(read: Reader) -> Reader:
        FORMATS[name] = PointFormat(what, recognises, read)
        return read

    return register


def logged_cloud(
    frame: np.ndarray,
    xyz_m: np.ndarray,
    velocity_mps: np.ndarray,
    *,
    snr_db: np.ndarray | None = None,
    intensity: np.ndarray | None = None,
    num_frames: int | None = None,
    notes: tuple[str, ...] = (),
    missing: np.ndarray | None = None,
) -> LoggedCloud:
    """Builds a cloud from columns; missing columns become nan.

    Args:
        frame: Frame index, (point,).
        xyz_m: Positions in metres, (point, 3).
        velocity_mps: Radial velocity in m/s, (point,).
        snr_db: SNR in dB, (point,). Default: missing.
        intensity: Intensity in the unit of the source, (point,). Default: missing.
        num_frames: Number of frames. Default: up to the last point.
        notes: Sentences on what was found. Default: none.
        missing: Frames that the log is known to lack, (missing,). Default: unknown.

    Returns:
        The cloud.
    """
    nothing = np.full(len(frame), MISSING)
    x, y, z = np.asarray(xyz_m, float).reshape(-1, 3).T
    return LoggedCloud(
        frame=np.asarray(frame, int),
        x_m=x,
        y_m=y,
        z_m=z,
        radial_velocity_mps=np.asarray(velocity_mps, float),
        snr_db=nothing if snr_db is None else np.asarray(snr_db, float),
        intensity=nothing if intensity is None else np.asarray(intensity, float),
        num_frames=(int(np.max(frame)) + 1 if len(frame) else 0) if num_frames is None else num_frames,
        notes=notes,
        missing=missing,
    )


@dataclass(frozen=True, kw_only=True)
class CountedFrames:
    """Frame of each packet by the board's own counter, the number of frames, sentences on losses, missing frames."""

    frame: np.ndarray
    num_frames: int
    notes: tuple[str, ...]
    missing: np.ndarray


def counted_frames(number: np.ndarray) -> CountedFrames:
    """Frames of packets: numbers that are missing are frames without points, a smaller number is a restart.

    Args:
        number: Frame number of each packet in file order, (packet,). Sub-frames of a frame share its number.

    Returns:
        Frames from 0.

    >>> counted_frames(np.array([7, 8, 10, 3])).frame.tolist()
    [0, 1, 3, 4]
    """
    step = np.diff(number.astype(np.int64))
    is_restart = (step < 0) | (step > MAX_MISSING)
    frame = np.concatenate([[0], np.cumsum(np.where(is_restart, 1, step))]).astype(int)[: len(number)]
    restarts = int(is_restart.sum())
    total = int(frame[-1]) + 1 if len(frame) else 0
    missing = np.setdiff1d(np.arange(total), frame)
    lost = f"{len(missing)} of {total} frames that the board counted are missing from the log"
    notes = (lost,) if len(missing) else ()
    if restarts:
        notes += (f"the board's counter restarts {restarts} times; the length of these pauses is not known",)
    return CountedFrames(frame=frame, num_frames=total, notes=notes, missing=missing)
