"""The single reader of point clouds from boards and public data sets, with common axes.

x to the right, y away from the radar, z up, in metres; radial velocity in m/s, positive = moving away.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.regular_files import check_exists, open_regular
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.io.npz_files import POINT_COLUMNS, read_points_npz

# imported for their formats, which register themselves
from mmweaver.io.point_clouds import point_arrays, point_tables, ros_points, ti_replay, ti_uart  # noqa: F401
from mmweaver.io.point_clouds.point_log import FORMATS, LoggedCloud, logged_cloud, point_format
from mmweaver.io.point_clouds.point_tables import ROS_NOTE

PROBE_BYTES = 1 << 16
MAX_PLACE_M = 1e5  # anything beyond indicates damage
UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001}
FARTHEST_M, FAR_PERCENTILE = 300.0, 90  # no board sees most of its points farther away


@point_format(
    "points",
    "points.npz of mmWeaver",
    lambda path, head: path.suffix.lower() == ".npz" and set(POINT_COLUMNS) <= set(read_npz(path)),
)
def read_own_points(path: Path) -> LoggedCloud:
    """Reads a points.npz of mmWeaver, without intensities. Raises InputError if it is malformed."""
    points, held = read_points_npz(path), read_npz(path, only=("num_frames", "intensity"))
    last = int(points.frame.max()) + 1 if len(points.frame) else 0
    frames = held.numbers("num_frames", (), kinds="iu", low=last, high=2**31) if "num_frames" in held else None
    return logged_cloud(
        points.frame,
        points.xyz_m,
        points.radial_velocity_mps,
        snr_db=points.snr_db,
        intensity=held.numbers("intensity", ("point",), nan=True) if "intensity" in held else None,
        num_frames=None if frames is None else int(frames),
    )


def read_points(
    path: str | Path, kind: str | None = None, *, unit: str | None = None, axes: str | None = None
) -> LoggedCloud:
    """Reads a point cloud.

    Args:
        path: File or folder.
        kind: Format, a key of FORMATS. Default: detected.
        unit: Unit of positions, a key of UNITS_M. Default: metres, unless most points were then farther away than a
            radar sees.
        axes: "radar" (x right, y away) or "ros" (x ahead, y left), for tables whose header does not show which.
            Default: by the format.

    Returns:
        The points; frames count from 0, `snr_db` and `intensity` are nan if the file lacks them. Its notes report what
        was found.

    Raises:
        InputError: If the format is unknown or the file is malformed.
    """
    path = Path(path)
    check_exists(path, "a file or a folder of point clouds")
    kind = kind or points_kind(path)
    if kind not in FORMATS:
        raise InputError(f"unknown kind of point cloud {kind!r}; known: {', '.join(FORMATS)}")
    cloud, checks = _in_metres(FORMATS[kind].read(path), unit), ArrayChecks(path)
    if axes == "ros" and not any(ROS_NOTE in note for note in cloud.notes):
        cloud = replace(cloud, x_m=-cloud.y_m, y_m=cloud.x_m, notes=(*cloud.notes, ROS_NOTE))
    elif axes == "radar" and any(ROS_NOTE in note for note in cloud.notes):
        cloud = replace(cloud, x_m=cloud.y_m, y_m=-cloud.x_m, notes=())
    for name in ("x_m", "y_m", "z_m"):
        checks.numbers(name, getattr(cloud, name), ("point",), low=-MAX_PLACE_M, high=MAX_PLACE_M)
    for name in ("radial_velocity_mps", "snr_db", "intensity"):
        checks.numbers(name, getattr(cloud, name), ("point",), nan=True)
    return cloud


def _in_metres(cloud: LoggedCloud, unit: str | None) -> LoggedCloud:
    """The cloud in metres. Raises InputError for an unknown unit."""
    if unit is not None and unit not in UNITS_M:
        raise InputError(f"unknown unit {unit!r}; known: {', '.join(UNITS_M)}")
    if unit is None:
        far = float(np.percentile(np.abs(cloud.xyz_m).max(axis=1), FAR_PERCENTILE)) if len(cloud.frame) else 0.0
        unit = "m" if far <= FARTHEST_M else "cm" if far <= 10 * FARTHEST_M else "mm"
        if unit != "m":
            cloud = replace(cloud, notes=(*cloud.notes, f"positions up to {far:.0f} were taken as {unit}"))
    if unit == "m":
        return cloud
    scale = UNITS_M[unit]
    return replace(cloud, x_m=cloud.x_m * scale, y_m=cloud.y_m * scale, z_m=cloud.z_m * scale)


def recognised_kind(path: Path) -> str | None:
    """Detects the format of a point cloud by its name and first 64 KiB.

    Args:
        path: File or folder.

    Returns:
        Key of FORMATS; None if no format recognises it.
    """
    head = b""
    if not path.is_dir():
        with open_regular(path) as stream:
            head = stream.read(PROBE_BYTES)
    return next((name for name, one in FORMATS.items() if one.recognises(path, head)), None)


def points_kind(path: Path) -> str:
    """Format of a file or folder, as `recognised_kind`.

    Args:
        path: File or folder.

    Returns:
        Key of FORMATS.

    Raises:
        InputError: If no format recognises it.
    """
    if (kind := recognised_kind(path)) is None:
        known = "; ".join(one.what for one in FORMATS.values())
        raise InputError(f"{path} is no point cloud that is known: {known}; name its kind with --layout")
    return kind
