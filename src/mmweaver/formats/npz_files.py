"""radar.npz, pose.npz and points.npz: the project's own files, plain numpy archives.

They are not pickled, not compressed, and have no dates: the same arrays give the same bytes.

Reference: docs/conventions.md, "Files".
"""

import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PointCloud, PoseSequence, RadarCube
from mmweaver.core.skeleton import JOINT_NAMES

CUBE_AXES = ("frame", "range", "doppler", "antenna")
POINT_COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
FIRMWARE_COLUMNS = ("intensity",)
NO_DATE = (1980, 1, 1, 0, 0, 0)  # the first a zip file can name


# radar.npz ----------------------------------------------------------------------------------------------------------
def write_radar_npz(path: Path, cube: RadarCube) -> None:
    """Writes a cube with its axes: complex64 (frame, range, doppler, antenna), s, m, m/s, m."""
    grid = cube.grid
    units = {
        "cube": "sqrt(mW) at the receiver's port, divided by scale",
        "frame_time_s": "s",
        "range_m": "m",
        "radial_velocity_mps": "m/s, positive = moving away",
        "antenna_position_m": "m, (x right, y away, z up)",
        "wavelength_m": "m",
        "scale": "sqrt(mW) for a value of 1.0; nan = unknown",
    }
    write_npz(
        path,
        cube=np.asarray(cube.values, np.complex64),
        frame_time_s=np.asarray(grid.frame_time_s, np.float64),
        range_m=np.asarray(grid.range_m, np.float64),
        radial_velocity_mps=np.asarray(grid.radial_velocity_mps, np.float64),
        antenna_position_m=np.asarray(grid.antenna_position_m, np.float64),
        wavelength_m=np.float64(grid.wavelength_m),
        scale=np.float64(cube.scale),
        axes=np.array(CUBE_AXES),
        units=np.array([f"{name}: {unit}" for name, unit in units.items()]),
    )


def read_radar_npz(path: str | Path, config: RadarConfig | None = None) -> RadarCube:
    """Reads a radar.npz. `config` defaults to the radar.json in the same folder.

    Raises InputError where the file is not such an archive, or its shape does not match the radar.
    """
    path = Path(path)
    if config is None:
        config = _radar_of(path)
    arrays = read_npz(path)
    names = ("cube", "frame_time_s", "range_m", "radial_velocity_mps", "antenna_position_m", "wavelength_m", "scale")
    cube, time_s, range_m, velocity_mps, antenna_m, wavelength_m, scale = (_take(path, arrays, name) for name in names)
    grid = CubeGrid(
        frame_time_s=time_s,
        range_m=range_m,
        radial_velocity_mps=velocity_mps,
        antenna_position_m=antenna_m,
        wavelength_m=float(wavelength_m),
    )
    radar_shape = (config.num_range_bins, config.num_loops, config.num_antennas)
    if cube.shape != grid.shape or cube.shape[1:] != radar_shape:
        raise InputError(
            f"{path}: the cube is {cube.shape}, its axes {grid.shape}, radar {config.name!r} {radar_shape}"
        )
    return RadarCube(values=cube, grid=grid, config=config, scale=float(scale))


def _radar_of(path: Path) -> RadarConfig:
    try:
        text = path.with_name("radar.json").read_text(encoding="utf-8")
    except OSError:
        raise InputError(f"no radar.json next to {path}; give the radar that recorded it") from None
    return RadarConfig.from_json(text)


# pose.npz -----------------------------------------------------------------------------------------------------------
def write_pose_npz(path: Path, pose: PoseSequence, *others: PoseSequence) -> None:
    """Writes joints in metres in the radar's frame, with names and times: float32 (frame, 22, 3) for one person.

    For several people, all at the same times: (person, frame, 22, 3), and `height_m` (person,).
    """
    poses = (pose, *others)
    joints_m = np.stack([np.asarray(one.joints_m, np.float32) for one in poses])
    height_m = np.array([one.height_m for one in poses], np.float64)
    is_single = not others
    write_npz(
        path,
        joints_m=joints_m[0] if is_single else joints_m,
        joint_names=np.array(JOINT_NAMES),
        frame_time_s=np.asarray(pose.time_s, np.float64),
        height_m=height_m[0] if is_single else height_m,
    )


def read_pose_npz(path: str | Path) -> PoseSequence:
    """Reads a pose.npz of one person. Raises InputError for anything else, several people included."""
    poses = read_poses_npz(path)
    if len(poses) != 1:
        raise InputError(f"{path} holds {len(poses)} people; read it with read_poses_npz")
    return poses[0]


def read_poses_npz(path: str | Path) -> tuple[PoseSequence, ...]:
    """Reads all people of a pose.npz, as subjects 0, 1, 2 ... Raises InputError for anything else."""
    path = Path(path)
    arrays = read_npz(path)
    joints_m, names = _take(path, arrays, "joints_m"), _take(path, arrays, "joint_names")
    if (
        tuple(names.tolist()) != JOINT_NAMES
        or joints_m.ndim not in (3, 4)
        or joints_m.shape[-2:] != (len(JOINT_NAMES), 3)
    ):
        raise InputError(f"{path}: joints_m is {joints_m.shape}; the {len(JOINT_NAMES)} joints of SMPL are needed")
    time_s, height_m = _take(path, arrays, "frame_time_s"), np.atleast_1d(_take(path, arrays, "height_m"))
    people = joints_m if joints_m.ndim == 4 else joints_m[None]
    if len(height_m) != len(people):
        raise InputError(f"{path}: {len(people)} people, but {len(height_m)} heights")
    return tuple(
        PoseSequence(time_s=time_s, joints_m=joints, height_m=float(height), subject=index)
        for index, (joints, height) in enumerate(zip(people, height_m, strict=True))
    )


# points.npz ---------------------------------------------------------------------------------------------------------
def write_points_npz(path: Path, points: PointCloud) -> None:
    """Writes detections, one row each: frame (int32) and five float32 columns, all of one length.

    Points of the firmware have a sixth, `intensity`, in the device's counts.
    """
    names = (*POINT_COLUMNS, *(name for name in FIRMWARE_COLUMNS if hasattr(points, name)))
    columns = {name: np.asarray(getattr(points, name), np.float32) for name in names}
    write_npz(path, frame=np.asarray(points.frame, np.int32), **columns)


def read_points_npz(path: str | Path) -> PointCloud:
    """Reads a points.npz. Raises InputError for anything else."""
    path = Path(path)
    arrays = read_npz(path)
    columns = {name: _take(path, arrays, name) for name in POINT_COLUMNS}
    return PointCloud(frame=_take(path, arrays, "frame"), **columns)


# archives -----------------------------------------------------------------------------------------------------------
def write_npz(path: Path, **arrays: np.ndarray | np.generic) -> None:
    """Writes a numpy archive, uncompressed and without dates; arrays of Python objects are refused."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED, allowZip64=True) as archive:
        for name, array in arrays.items():
            entry = zipfile.ZipInfo(f"{name}.npy", date_time=NO_DATE)
            with archive.open(entry, "w", force_zip64=True) as stream:
                np.lib.format.write_array(stream, np.asanyarray(array), allow_pickle=False)


def read_npz(path: str | Path) -> dict[str, Any]:
    """Reads all arrays of a numpy archive. Raises InputError where it is missing, damaged or holds objects."""
    path = Path(path)
    try:
        with np.load(path, allow_pickle=False) as archive:
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise InputError(f"{path} is not an .npz archive")
            return {name: archive[name] for name in archive.files}
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    except (ValueError, EOFError, zipfile.BadZipFile, KeyError, TypeError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} is not a plain .npz archive, or it is damaged ({error})") from None


def _take(path: Path, arrays: dict[str, Any], name: str) -> np.ndarray:
    try:
        return arrays[name]
    except KeyError:
        raise InputError(f"{path} holds no {name!r}; it has {', '.join(arrays) or 'nothing'}") from None
