"""Point clouds as tables: CSV logs, MM-Fi's frames of float64, RadHAR's text, mHomeGes's archives.

Reference: An and Ogras, MARS (CSV of frame, count, x, y, z, Doppler, intensity); Yang et al., MM-Fi (frames of x, y, z,
Doppler, intensity as float64); Singh et al., RadHAR (text of ROS messages, x ahead and y to the left).
"""

import csv
import re
from array import array
from pathlib import Path

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE, foreign_errors, read_bytes
from mmweaver.core.safe_files.safe_arrays import read_npz
from mmweaver.core.safe_files.safe_text import read_text
from mmweaver.io.point_clouds.point_log import LoggedCloud, logged_cloud, point_format
from mmweaver.io.point_clouds.ti_uart import MAGIC

MAX_BYTES = 500 * MEGABYTE
MAX_FRAME = 2**31
ROS_NOTE = "x ahead and y to the left, ROS's axes, were turned to x right and y away"
MMFI_COLUMNS = 5  # x, y, z, Doppler, intensity
TIMES = ("timestamp", "time", "times", "timems")  # columns that count frames where no other does
# column names of a CSV, reduced to letters and digits -> name here
COLUMNS = {
    "frame": "frame",
    "framenumber": "frame",
    "framenum": "frame",
    "x": "x",
    "y": "y",
    "z": "z",
    "doppler": "velocity",
    "velocity": "velocity",
    "v": "velocity",
    "intensity": "intensity",
    "snr": "snr",
    "snrdb": "snr",
}
RADHAR_LINE = re.compile(rb"^(point_id|x|y|z|velocity|intensity): *(\S+)", re.MULTILINE)
LINE = re.compile(r"[^\n]*\n|[^\n]+$")
NUMBERED = re.compile(r"(\d+)")


@point_format(
    "csv", "CSV with Frame, X, Y, Z, Doppler (MARS, mRI, mHomeGes)", lambda path, head: path.suffix.lower() == ".csv"
)
def read_csv_points(path: Path) -> LoggedCloud:
    """Reads a CSV whose header names frame, x, y, z (m) and Doppler (m/s), as MARS and mRI write it.

    Args:
        path: The file.

    Returns:
        The cloud, with SNR and intensity if the file has them.

    Raises:
        InputError: If a column is missing or a value is not a number.
    """
    text = read_text(path, max_bytes=MAX_BYTES)
    rows = csv.reader(line[0] for line in LINE.finditer(text))  # one by one: a list of them takes 20 times the text
    with foreign_errors(path, "no CSV ({reason}); export it again"):
        header = next(rows, [])
    at = csv_columns(header, str(path))
    names = [_plain(name) for name in header]
    more = {} if "bearing" not in names else {"bearing": names.index("bearing")}
    values, picked = array("d"), [*at.values(), *more.values()]
    with foreign_errors(path, "no CSV ({reason}); export it again"):
        try:
            for row in rows:
                if row:
                    values.extend([float(row[index]) for index in picked])
        except (ValueError, IndexError):
            raise InputError(f"{path} holds a line that is not a number in each column; leave it out") from None
    column = dict(zip([*at, *more], np.array(values).reshape(-1, len(picked)).T, strict=True))
    if names[at["frame"]] in TIMES:  # points of one time are a frame
        column["frame"] = np.cumsum(np.diff(column["frame"], prepend=column["frame"][:1]) != 0)
    place, is_ros = np.column_stack([column[axis] for axis in "xyz"]), _has_ros_axes(names, column)
    return logged_cloud(
        _renumbered(path, column["frame"]),
        place[:, [1, 0, 2]] * [-1, 1, 1] if is_ros else place,
        column["velocity"],
        snr_db=column.get("snr"),
        intensity=column.get("intensity"),
        notes=(ROS_NOTE,) if is_ros else (),
    )


def _has_ros_axes(names: list[str], column: dict[str, np.ndarray]) -> bool:
    """Whether the columns are those of ti_mmwave_rospkg's RadarScan: its bearing says where x points."""
    if "bearing" not in column:
        return {"pointid", "dopplerbin"} <= set(names)
    x, y, bearing = (column[name] for name in ("x", "y", "bearing"))
    off_ros, off_radar = (
        np.abs(np.abs(np.degrees(angle)) - np.abs(bearing)) for angle in (np.arctan2(y, x), np.arctan2(x, y))
    )
    return bool(np.median(off_ros) < np.median(off_radar)) if len(x) else True


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


def csv_columns(header: list[str], place: str) -> dict[str, int]:
    """Locates the columns of a CSV by its header.

    Args:
        header: Names of the columns.
        place: Name of the source for error messages.

    Returns:
        Index of frame, x, y, z, velocity and, if present, snr and intensity.

    Raises:
        InputError: If a required column is missing.
    """
    names = [COLUMNS.get(_plain(name)) for name in header]
    at = {name: index for index, name in enumerate(names) if name is not None}
    by_time = [index for index, name in enumerate(header) if _plain(name) in TIMES]
    if "frame" not in at and by_time:
        at = {"frame": by_time[0], **at}
    if missing := [name for name in ("frame", "x", "y", "z", "velocity") if name not in at]:
        raise InputError(f"{place}: its first line must name Frame, X, Y, Z and Doppler; {missing[0]} is missing")
    return at


def _is_mmfi(path: Path, head: bytes) -> bool:
    return (path.is_dir() and not (path / "metadata.yaml").is_file()) or (
        path.suffix.lower() == ".bin" and len(head) % (8 * MMFI_COLUMNS) == 0 and MAGIC not in head
    )


@point_format("mmfi", "frames of float64 (MM-Fi), a file or a folder", _is_mmfi)
def read_mmfi(path: Path) -> LoggedCloud:
    """Reads one frame of MM-Fi (.bin of float64), or a folder of frames in numerical order.

    Args:
        path: File or folder. Frames without points count: each file is a frame.

    Returns:
        The cloud, with intensity.

    Raises:
        InputError: If a file is not a frame of MM-Fi.
    """
    files = sorted(path.glob("*.bin"), key=_number) if path.is_dir() else [path]
    if not files:
        raise InputError(f"{path} holds no frames (.bin)")
    tables = []
    for file in files:
        raw = read_bytes(file, max_bytes=MAX_BYTES)
        if len(raw) % (8 * MMFI_COLUMNS):
            raise InputError(f"{file} has {len(raw)} bytes; a frame of MM-Fi has 40 per point, five float64")
        table = np.frombuffer(raw, "<f8").reshape(-1, MMFI_COLUMNS)
        if not np.isfinite(table).all() or np.abs(table[:, :3]).max(initial=0.0) > 1e3:
            raise InputError(f"{file} holds no point cloud of MM-Fi: float64 x, y, z, Doppler, intensity")
        tables.append(table)
    frame, table = np.repeat(np.arange(len(tables)), list(map(len, tables))), np.concatenate(tables)
    return logged_cloud(frame, table[:, :3], table[:, 3], intensity=table[:, 4])


@point_format("radhar", "text of RadHAR", lambda path, head: b"point_id:" in head)
def read_radhar_text(path: Path) -> LoggedCloud:
    """Reads RadHAR's text: one message per point, a new frame at each point_id 0; x ahead, y to the left.

    Args:
        path: The file.

    Returns:
        The cloud, with intensity if every point has one.

    Raises:
        InputError: If the file is not such a text.
    """
    columns: dict[bytes, list[float]] = {}
    for name, word in RADHAR_LINE.findall(read_bytes(path, max_bytes=MAX_BYTES)):
        try:
            columns.setdefault(name, []).append(float(word))
        except ValueError:
            raise InputError(f"{path} holds {word[:20]!r} where a number should be; leave it out") from None
    needed = [columns.get(name, []) for name in (b"point_id", b"x", b"y", b"z", b"velocity")]
    if not needed[0] or len({len(column) for column in needed}) != 1:
        raise InputError(f"{path} is no text of RadHAR: point_id, x, y, z and velocity, one line each")
    point, ahead, left, up, velocity = (np.array(column) for column in needed)
    frame = np.cumsum(point == 0) - (point[0] == 0)
    own = columns.get(b"intensity", [])
    intensity = np.array(own) if len(own) == len(point) else None
    return logged_cloud(frame, np.column_stack([-left, ahead, up]), velocity, intensity=intensity)


@point_format(
    "npz",
    "archive with frame and pts (mHomeGes, RadHAR)",
    lambda path, head: path.suffix.lower() == ".npz" and {"frame", "pts"} <= set(read_npz(path)),
)
def read_point_npz(path: Path) -> LoggedCloud:
    """Reads `frame` and `pts` of mHomeGes (x, y, z, velocity, intensity), or of RadHAR as .npz (eight columns).

    Args:
        path: The file.

    Returns:
        The cloud, with intensity.

    Raises:
        InputError: If the archive has other arrays or shapes.
    """
    held = read_npz(path)
    if not {"frame", "pts"} <= set(held):
        raise InputError(f"{path} holds {', '.join(held)}, not frame and pts")
    frame = held.numbers("frame", ("point",))
    points = held.numbers("pts", ("point", "column"), nan=True).astype(float)
    if points.shape[1] not in (5, 8):
        raise InputError(f"{path}: pts is {points.shape}; 5 columns (mHomeGes) or 8 (RadHAR) are known")
    frame = _renumbered(path, frame)
    if points.shape[1] == 5:
        return logged_cloud(frame, points[:, :3], points[:, 3], intensity=points[:, 4])
    return logged_cloud(
        frame, points[:, [1, 0, 2]] * [-1, 1, 1], points[:, 4], intensity=points[:, 7]
    )  # x ahead, y left


def _renumbered(path: Path, frame: np.ndarray) -> np.ndarray:
    """Frame numbers from 0, gaps kept. Raises InputError if they are not ascending integers."""
    frame = np.asarray(frame, float)
    is_whole = bool((np.abs(frame) < MAX_FRAME).all()) and not (frame % 1).any()
    if not is_whole or (np.diff(frame) < 0).any():
        raise InputError(f"{path} has frame numbers that are not whole or not in order; leave it out")
    return (frame - frame[0]).astype(int) if len(frame) else frame.astype(int)


def _number(file: Path) -> tuple[int, str]:
    found = NUMBERED.findall(file.stem)
    return (int(found[-1]) if found else -1), file.name
