"""The record of a logged point cloud, and the formats that hold one: each is one function, declared by a decorator.

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
    """A PointCloud that a board or a data set stored: `intensity` in its own unit, nan where it has none.

    x to the right, y away from the radar, z up; `frame` counts from 0 in the order of the file.
    """

    intensity: PerPoint


Reader = Callable[[Path], LoggedCloud]


@dataclass(frozen=True)
class PointFormat:
    """A format of point clouds."""

    what: str  # for people
    recognises: Callable[[Path, bytes], bool]  # by name and beginning; of a folder the beginning is empty
    read: Reader


FORMATS: dict[str, PointFormat] = {}


def point_format(name: str, what: str, recognises: Callable[[Path, bytes], bool]) -> Callable[[Reader], Reader]:
    """Declares a reader; at most one format should recognise a file."""

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
    """A cloud of columns (point,) and places (point, 3); missing columns are nan."""
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
