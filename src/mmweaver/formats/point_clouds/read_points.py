"""The one reader of point clouds: whatever a board or a public data set stores, with stated axes.

x to the right, y away from the radar, z up, in metres; radial velocity in m/s, positive = moving away.
"""

from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.array_checks import ArrayChecks
from mmweaver.core.safe_files.regular_files import check_exists, open_regular
from mmweaver.formats.npz_files import POINT_COLUMNS, read_points_npz
from mmweaver.formats.point_clouds.point_log import LoggedCloud, logged_cloud
from mmweaver.formats.point_clouds.point_tables import read_csv_points, read_mmfi, read_point_npz, read_radhar_text
from mmweaver.formats.point_clouds.ti_uart import is_ti_uart, read_ti_uart

KINDS = {
    "points": "points.npz of mmWeaver",
    "ti_uart": ".dat of a TI demo's data port",
    "csv": "CSV with Frame, X, Y, Z, Doppler (MARS, mRI, mHomeGes)",
    "mmfi": "frames of float64 (MM-Fi), a file or a folder",
    "radhar": "text of RadHAR",
    "npz": "archive with frame and pts (mHomeGes, RadHAR)",
}
PROBE_BYTES = 1 << 16
FARTHEST_M = 1e5  # of a point; what is beyond is damage


def read_points(path: str | Path, kind: str | None = None) -> LoggedCloud:
    """Reads a point cloud; which kind of KINDS it is follows from the file where `kind` is not given.

    Frames count from 0. `snr_db` and `intensity` are nan where the file has none. Raises InputError where the file
    cannot be read so.
    """
    path = Path(path)
    check_exists(path, "a file or a folder of point clouds")
    kind = kind or points_kind(path)
    if kind not in KINDS:
        raise InputError(f"unknown kind of point cloud {kind!r}; known: {', '.join(KINDS)}")
    readers = {
        "points": _own, "csv": read_csv_points, "mmfi": read_mmfi, "radhar": read_radhar_text,
        "npz": read_point_npz,
    }  # fmt: skip
    cloud = read_ti_uart(path).points if kind == "ti_uart" else readers[kind](path)
    checks = ArrayChecks(path)
    for name in ("x_m", "y_m", "z_m"):
        checks.numbers(name, getattr(cloud, name), ("point",), low=-FARTHEST_M, high=FARTHEST_M)
    for name in ("radial_velocity_mps", "snr_db", "intensity"):
        checks.numbers(name, getattr(cloud, name), ("point",), nan=True)
    return cloud


def _own(path: Path) -> LoggedCloud:
    points = read_points_npz(path)
    xyz_m = np.stack([points.x_m, points.y_m, points.z_m], axis=1)
    return logged_cloud(points.frame, xyz_m, points.radial_velocity_mps, snr_db=points.snr_db)


def points_kind(path: Path) -> str:
    """The kind of a file or folder, by its name and its beginning. Raises InputError where it is none."""
    if path.is_dir():
        return "mmfi"
    suffix = path.suffix.lower()
    if suffix == ".npz":
        from mmweaver.core.safe_files.safe_arrays import read_npz

        return "points" if set(POINT_COLUMNS) <= set(read_npz(path)) else "npz"
    if suffix == ".csv":
        return "csv"
    with open_regular(path) as stream:
        head = stream.read(PROBE_BYTES)
    if is_ti_uart(head):
        return "ti_uart"
    if b"point_id:" in head:
        return "radhar"
    if suffix == ".bin" and len(head) % 40 == 0:
        return "mmfi"
    known = "; ".join(KINDS.values())
    raise InputError(f"{path} is no point cloud that is known: {known}; name its kind with --layout")
