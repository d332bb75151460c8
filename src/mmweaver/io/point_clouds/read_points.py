"""The single reader of point clouds from boards and public data sets, with common axes.

x to the right, y away from the radar, z up, in metres; radial velocity in m/s, positive = moving away.
"""

from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.regular_files import check_exists, open_regular
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.io.npz_files import POINT_COLUMNS, read_points_npz

# imported for their formats, which register themselves
from mmweaver.io.point_clouds import point_tables, ti_uart  # noqa: F401
from mmweaver.io.point_clouds.point_log import FORMATS, LoggedCloud, logged_cloud, point_format

PROBE_BYTES = 1 << 16
MAX_PLACE_M = 1e5  # anything beyond indicates damage


@point_format(
    "points",
    "points.npz of mmWeaver",
    lambda path, head: path.suffix.lower() == ".npz" and set(POINT_COLUMNS) <= set(read_npz(path)),
)
def read_own_points(path: Path) -> LoggedCloud:
    """Reads a points.npz of mmWeaver, without intensities. Raises InputError if it is malformed."""
    points = read_points_npz(path)
    return logged_cloud(points.frame, points.xyz_m, points.radial_velocity_mps, snr_db=points.snr_db)


def read_points(path: str | Path, kind: str | None = None) -> LoggedCloud:
    """Reads a point cloud.

    Args:
        path: File or folder.
        kind: Format, a key of FORMATS. Default: detected.

    Returns:
        The points; frames count from 0, `snr_db` and `intensity` are nan if the file lacks them.

    Raises:
        InputError: If the format is unknown or the file is malformed.
    """
    path = Path(path)
    check_exists(path, "a file or a folder of point clouds")
    kind = kind or points_kind(path)
    if kind not in FORMATS:
        raise InputError(f"unknown kind of point cloud {kind!r}; known: {', '.join(FORMATS)}")
    cloud, checks = FORMATS[kind].read(path), ArrayChecks(path)
    for name in ("x_m", "y_m", "z_m"):
        checks.numbers(name, getattr(cloud, name), ("point",), low=-MAX_PLACE_M, high=MAX_PLACE_M)
    for name in ("radial_velocity_mps", "snr_db", "intensity"):
        checks.numbers(name, getattr(cloud, name), ("point",), nan=True)
    return cloud


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
