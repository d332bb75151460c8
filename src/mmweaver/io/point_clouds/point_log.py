"""Record of a logged point cloud, and the registry of formats: one decorated reader function per format.

@point_format("csv", "CSV with Frame, X, Y, Z, Doppler", lambda path, head: path.suffix.lower() == ".csv")
def read_csv_points(path: Path) -> LoggedCloud: ...
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.shapes import PerPoint

MISSING = float("nan")


@dataclass(frozen=True, kw_only=True, repr=False)
class LoggedCloud(PointCloud):
    """A PointCloud stored by a board or a data set, with `intensity` in its own unit (nan if missing).

    x to the right, y away from the radar, z up; `frame` counts from 0 in file order.
    """

    intensity: PerPoint


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
) -> LoggedCloud:
    """Builds a cloud from columns; missing columns become nan.

    Args:
        frame: Frame index, (point,).
        xyz_m: Positions in metres, (point, 3).
        velocity_mps: Radial velocity in m/s, (point,).
        snr_db: SNR in dB, (point,). Default: missing.
        intensity: Intensity in the unit of the source, (point,). Default: missing.

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
    )
