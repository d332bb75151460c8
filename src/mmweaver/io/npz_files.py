"""radar.npz, pose.npz and points.npz: the project's own files, plain numpy archives.

They contain no pickles, compression or dates, so equal arrays give equal bytes.

Reference: docs/conventions.md, "Files".
"""

import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.checksums import check_file
from mmweaver.core.errors import InputError, file_named
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PointCloud, PoseSequence, RadarCube
from mmweaver.core.safe_files.regular_files import open_regular
from mmweaver.core.safe_files.safe_arrays import NpzArrays, read_npz
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.shapes import PerFrame
from mmweaver.core.skeleton import JOINT_NAMES

CUBE_AXES = ("frame", "range", "doppler", "antenna")
CUBE_UNITS = {
    "cube": "sqrt(mW) at the receiver's port, divided by scale",
    "frame_time_s": "s",
    "range_m": "m",
    "radial_velocity_mps": "m/s, positive = moving away",
    "antenna_position_m": "m, (x right, y away, z up)",
    "wavelength_m": "m",
    "scale": "sqrt(mW) for a value of 1.0; nan = unknown",
}
POINT_COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
FIRMWARE_COLUMNS = ("intensity",)
MAX_CUBE, MAX_TIME_S = 1e15, 1e12  # far above recorded values; squares and sums stay finite
COPIED_BYTES = 2**24  # at once, of a file
NO_DATE = (1980, 1, 1, 0, 0, 0)  # earliest date of the zip format


class DiskCube(np.memmap):
    """Values of a cube in a file of nothing else; those at zero Doppler, which slow time needs, are held in memory."""

    still: np.ndarray

    def __getitem__(self, key: Any) -> Any:
        """As of an array; a selection is a copy in memory."""
        is_doppler = isinstance(key, tuple) and len(key) == 3 and key[:2] == (slice(None), slice(None))
        if is_doppler and hasattr(self, "still") and key[2] == self.shape[2] // 2:
            return self.still
        return np.array(np.asarray(super().__getitem__(key)))


# radar.npz ----------------------------------------------------------------------------------------------------------
def write_radar_npz(path: Path, cube: RadarCube) -> None:
    """Writes a radar cube with its axes.

    Args:
        path: The file.
        cube: Cube, written as complex64 (frame, range, doppler, antenna); axes in s, m, m/s and m.
    """
    axes = {name: np.asarray(value, np.float64) for name, value in vars(cube.grid).items()}
    write_npz(
        path,
        cube=cube.values if isinstance(cube.values, DiskCube) else np.asarray(cube.values, np.complex64),
        **axes,
        scale=np.float64(cube.scale),
        axes=np.array(CUBE_AXES),
        units=np.array([f"{name}: {unit}" for name, unit in CUBE_UNITS.items()]),
    )


def read_radar_npz(path: str | Path, config: RadarConfig | None = None, *, mapped: bool = False) -> RadarCube:
    """Reads a radar.npz.

    Args:
        path: The file.
        config: Its radar. Default: from the radar.json in the same folder.
        mapped: Whether the cube is memory-mapped, read-only. Default: False.

    Returns:
        Cube, complex64 (frame, range, doppler, antenna).

    Raises:
        InputError: If the file is not such an archive, or its shape does not match the radar.
    """
    path = Path(path)
    if config is None:
        config = _radar_of(path)
    held = _read(path, mapped=("cube",) if mapped else ())
    cube = held.numbers("cube", ("frame", "range", "doppler", "antenna"), kinds="c", low=-MAX_CUBE, high=MAX_CUBE)
    grid = CubeGrid(
        frame_time_s=held.numbers("frame_time_s", ("frame",), low=-MAX_TIME_S, high=MAX_TIME_S),
        range_m=held.numbers("range_m", ("range",), low=0, high=1e6),
        radial_velocity_mps=held.numbers("radial_velocity_mps", ("doppler",), low=-1e6, high=1e6),
        antenna_position_m=held.numbers("antenna_position_m", ("antenna", 3), low=-1e3, high=1e3),
        wavelength_m=float(held.numbers("wavelength_m", (), low=1e-6, high=1e3)),
    )
    scale = float(held.numbers("scale", (), low=1e-30, high=1e30, nan=True))
    if not len(cube):
        raise InputError(f"{path} holds no frames; record or generate it again")
    radar_shape = (config.num_range_bins, config.num_loops, config.num_antennas)
    if cube.shape[1:] != radar_shape:
        raise InputError(f"{path}: the cube is {cube.shape}, radar {config.name!r} makes frames of {radar_shape}")
    return RadarCube(values=cube, grid=grid, config=config, scale=scale)


def _radar_of(path: Path) -> RadarConfig:
    file = path.with_name("radar.json")
    if not file.exists():
        raise InputError(f"no radar.json next to {path}; give the radar that recorded it")
    check_file(file)
    with file_named(file):
        return RadarConfig.from_values(read_json(file))


# pose.npz -----------------------------------------------------------------------------------------------------------
def write_pose_npz(path: Path, *poses: PoseSequence, time_s: PerFrame | None = None) -> None:
    """Writes joints in metres in the radar's frame, with joint names and times.

    Args:
        path: The file.
        *poses: People at common times. One person is written as float32 (frame, 22, 3) with scalar `height_m`; none or
            several as (person, frame, 22, 3) with `height_m` (person,). Where their vital signs are known:
            `breathing_hz`, `heart_hz`, outward displacements `chest_m` and `belly_m` (frame,), times of heartbeats
            `beat_s` and of held breaths `held_s` (hold, 2), per person as the joints.
        time_s: Times in seconds, (frame,), required without people. Default: those of the poses.
    """
    time_s = np.asarray(poses[0].time_s if time_s is None else time_s, np.float64)
    joints_m = np.array([one.joints_m for one in poses], np.float32).reshape(
        len(poses), len(time_s), len(JOINT_NAMES), 3
    )
    height_m, first = np.array([one.height_m for one in poses], np.float64), 0 if len(poses) == 1 else ...
    write_npz(
        path,
        joints_m=joints_m[first],
        joint_names=np.array(JOINT_NAMES),
        frame_time_s=time_s,
        height_m=height_m[first],
        **_vital_arrays(poses, first),
    )


def _vital_arrays(poses: tuple[PoseSequence, ...], first: Any) -> dict[str, np.ndarray]:
    """Breathing and heartbeat of each person, (person, ...), padded with nan; nothing where they are not known."""
    vitals = [one.vitals for one in poses if one.vitals is not None]
    if not poses or len(vitals) < len(poses):
        return {}

    def padded(rows: list[np.ndarray]) -> np.ndarray:
        out = np.full((len(rows), max(map(len, rows)), *rows[0].shape[1:]), np.nan)
        for row, values in zip(out, rows, strict=True):
            row[: len(values)] = values
        return out

    each = {name: np.array([getattr(one, name) for one in vitals]) for name in ("breathing_hz", "heart_hz")}
    each |= {
        name: padded([getattr(one, name) for one in vitals]) for name in ("chest_m", "belly_m", "beat_s", "held_s")
    }
    return {name: np.asarray(values[first]) for name, values in each.items()}


def read_poses_npz(path: str | Path) -> tuple[PoseSequence, ...]:
    """Reads all people of a pose.npz.

    Args:
        path: The file.

    Returns:
        One sequence per person with subjects 0, 1, 2 ...; empty for an empty room.

    Raises:
        InputError: If the file is not a pose.npz.
    """
    path = Path(path)
    held = _read(path)
    is_single = held.take("joints_m").ndim == 3
    people = () if is_single else ("person",)
    joints_m = held.numbers("joints_m", (*people, "frame", len(JOINT_NAMES), 3), kinds="f", low=-1e3, high=1e3)
    if held.texts("joint_names") != JOINT_NAMES:
        raise InputError(f"{path} has other joints than the {len(JOINT_NAMES)} of SMPL")
    time_s = held.numbers("frame_time_s", ("frame",), low=-MAX_TIME_S, high=MAX_TIME_S)
    height_m = np.atleast_1d(held.numbers("height_m", people, low=0.1, high=10))
    if not len(time_s):
        raise InputError(f"{path} holds no frames; generate it again")
    return tuple(
        PoseSequence(time_s=time_s, joints_m=joints, height_m=float(height), subject=index)
        for index, (joints, height) in enumerate(zip(joints_m[None] if is_single else joints_m, height_m, strict=True))
    )


# points.npz ---------------------------------------------------------------------------------------------------------
def write_points_npz(path: Path, points: PointCloud) -> None:
    """Writes detections, one row per point: frame (int32) and five float32 columns.

    Args:
        path: The file.
        points: Point cloud; firmware points have a sixth column, `intensity`, in device counts, logged ones also the
            number of frames, with those without points.
    """
    names = (*POINT_COLUMNS, *(name for name in FIRMWARE_COLUMNS if hasattr(points, name)))
    columns = {name: np.asarray(getattr(points, name), np.float32) for name in names}
    frames = getattr(points, "num_frames", None)
    more = {} if frames is None else {"num_frames": np.int32(frames)}
    write_npz(path, frame=np.asarray(points.frame, np.int32), **columns, **more)


def read_points_npz(path: str | Path) -> PointCloud:
    """Reads a points.npz.

    Args:
        path: The file.

    Returns:
        Point cloud without intensity.

    Raises:
        InputError: If the file is not a points.npz.
    """
    path = Path(path)
    held = _read(path)
    columns = {name: held.numbers(name, ("point",), kinds="f", low=-1e9, high=1e9) for name in POINT_COLUMNS}
    return PointCloud(frame=held.numbers("frame", ("point",), kinds="iu", low=0), **columns)


# archives -----------------------------------------------------------------------------------------------------------
def write_npz(path: Path, **arrays: np.ndarray | np.generic) -> None:
    """Writes an uncompressed numpy archive without dates.

    Args:
        path: The file.
        **arrays: Arrays by name.

    Raises:
        ValueError: If an array contains Python objects.
    """
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED, allowZip64=True) as archive:
        for name, array in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=NO_DATE)
            with archive.open(entry, "w", force_zip64=True) as stream:
                if isinstance(array, DiskCube):
                    _copy_mapped(stream, array)
                else:
                    np.lib.format.write_array(stream, np.asanyarray(array), allow_pickle=False)


def _copy_mapped(stream: Any, array: DiskCube) -> None:
    """Writes a whole file's array like `write_array`, without its pages staying in memory."""
    np.lib.format.write_array_header_1_0(stream, np.lib.format.header_data_from_array_1_0(array))
    with open_regular(Path(str(array.filename))) as file:
        file.seek(array.offset)
        left = array.nbytes
        while left and (piece := file.read(min(left, COPIED_BYTES))):
            stream.write(piece)
            left -= len(piece)


def _read(path: Path, mapped: tuple[str, ...] = ()) -> NpzArrays:
    """Reads an archive after checking it against the checksums of its folder."""
    check_file(path)
    return read_npz(path, mapped=mapped)
