"""A labelled set of activities on disk: one Zarr group that xarray opens with coordinates.

    OUT/sequences.zarr/               attributes: radar, label_names, schema_version
        iq        (sequence, frame_time, range, radial_velocity, antenna, part)  float16, times iq_scale: sqrt(mW)
        iq_scale  (sequence)
        joints    (sequence, frame_time, joint, axis)   float32, metres
        points    (point, column)   float32: x, y, z in metres, radial velocity in m/s, SNR in dB
        point_sequence, point_frame   (point)
        label, subject, place, room, draw, heading, height   (sequence)
        label_name, text, split, split_subject, split_place, split_room, split_sentence   (sequence)  strings
        frame_time, range, radial_velocity   coordinates in s, m, m/s; antenna_position (antenna, axis) in m
    OUT/set.json, activities.toml, leaks.json, SHA256SUMS

Arrays of signals are not compressed, so that the size of a sequence says nothing of its label; every chunk ends in its
CRC-32C, and all files are checked against SHA256SUMS before they are used. Reference: decision 210.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, PointCloud, RadarCube
from mmweaver.core.safe_files.safe_text import parse_json, read_json
from mmweaver.core.safe_files.safe_zarr import ZarrFolder, open_zarr
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.datasets.checked_folder import CheckedFolder
from mmweaver.datasets.dataset_plan import shell_words
from mmweaver.datasets.zarr_arrays import put_texts, zarr_module
from mmweaver.formats.npz_files import POINT_COLUMNS

SET_FILE, LEAKS_FILE, ACTIVITIES_FILE, STORE = "set.json", "leaks.json", "activities.toml", "sequences.zarr"
SCHEMA_VERSION = 1
SPLITS = ("train", "validation", "test")
SPLIT_KEYS = ("subject", "place", "room", "sentence")
STRINGS = ("label_name", "text", "split", *(f"split_{key}" for key in SPLIT_KEYS))
NUMBERS = {"label": "int32", "subject": "int32", "place": "int32", "room": "int32", "draw": "int32",
           "heading": "float32", "height": "float32"}  # fmt: skip
UNITS = {"heading": "rad", "height": "m", "joints": "m", "frame_time": "s", "range": "m", "radial_velocity": "m/s",
         "antenna_position": "m"}  # fmt: skip
IQ_DIMENSIONS = ("sequence", "frame_time", "range", "radial_velocity", "antenna", "part")
MADE_BY = "mmweaver dataset"
MOST = 2**31 - 1  # of a number that counts something
FARTHEST_M = 1000.0  # of joints and points; what is beyond is damage
_PEAK = 16384.0  # of the largest float16 of a sequence


def packed_iq(cube: RadarCube) -> tuple[np.ndarray, float]:
    """float16 (frame, range, doppler, antenna, part) and the factor to sqrt(mW)."""
    scale = cube.scale if np.isfinite(cube.scale) else 1.0
    pairs = np.ascontiguousarray(cube.values).view(np.float32).reshape(*cube.values.shape, 2)
    peak = float(np.abs(pairs).max(initial=0.0)) or 1.0
    return (pairs * (_PEAK / peak)).astype(np.float16), scale * peak / _PEAK


def write_set(
    folder: Path, config: RadarConfig, labels: tuple[str, ...], columns: dict[str, Any], arrays: dict[str, np.ndarray]
) -> None:
    """Writes the arrays into a new store in the folder: `columns` along the sequences, `arrays` as described above."""
    group: Any = zarr_module().open_group(folder / STORE, mode="w")
    frames = arrays["joints"].shape[1]
    grid = CubeGrid.of(config, frames)
    group.attrs["schema_version"] = SCHEMA_VERSION
    group.attrs["radar"] = parse_json(config.to_json(), "the radar")
    group.attrs["label_names"] = list(labels)
    coordinates = {
        "frame_time": grid.frame_time_s, "range": grid.range_m, "radial_velocity": grid.radial_velocity_mps,
    }  # fmt: skip
    for name, values in coordinates.items():
        _put(group, name, np.asarray(values, np.float64), (name,))
    _put(group, "antenna_position", grid.antenna_position_m, ("antenna", "axis"))
    for name in STRINGS:
        put_texts(group, name, columns[name])
    for name, kind in NUMBERS.items():
        _put(group, name, np.asarray(columns[name], kind), ("sequence",))
    _put(group, "joints", arrays["joints"], ("sequence", "frame_time", "joint", "axis"))
    group["joints"].attrs["joint_names"] = list(JOINT_NAMES)
    for name, dimensions in (
        ("points", ("point", "column")),
        ("point_sequence", ("point",)),
        ("point_frame", ("point",)),
    ):
        _put(group, name, arrays[name], dimensions)
    group["points"].attrs["columns"] = list(POINT_COLUMNS)
    if "iq_scale" in arrays:
        _put(group, "iq_scale", arrays["iq_scale"], ("sequence",))
        group["iq_scale"].attrs["units"] = "sqrt(mW)"


def create_iq(folder: Path, sequences: int, config: RadarConfig, frames: int) -> Any:
    """The array of signals, to be filled one sequence at a time: one chunk, in a file of its own, for each."""
    from zarr.codecs import Crc32cCodec

    group: Any = zarr_module().open_group(folder / STORE, mode="a")
    shape = (sequences, *CubeGrid.of(config, frames).shape, 2)
    array = group.create_array(
        "iq", shape=shape, chunks=(1, *shape[1:]), dtype="float16", dimension_names=IQ_DIMENSIONS,
        compressors=[Crc32cCodec()], config={"write_empty_chunks": True},
    )  # fmt: skip
    array.attrs["units"] = "1 (times iq_scale: sqrt(mW))"
    array.attrs["part_names"] = ["in-phase", "quadrature"]
    return array


def _put(group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...]) -> None:
    from zarr.codecs import Crc32cCodec, ZstdCodec

    chunks = tuple(max(1, size) for size in values.shape)
    array = group.create_array(
        name, shape=values.shape, dtype=values.dtype, chunks=chunks, dimension_names=dimensions,
        compressors=[ZstdCodec(), Crc32cCodec()], config={"write_empty_chunks": True},
    )  # fmt: skip
    array[...] = values
    if name in UNITS:
        array.attrs["units"] = UNITS[name]


@dataclass(frozen=True, kw_only=True)
class ActivitySet:
    """A stored set: everything but the signals in memory."""

    files: CheckedFolder
    arrays: ZarrFolder
    config: RadarConfig
    label_names: tuple[str, ...]
    columns: dict[str, np.ndarray]  # along the sequences
    joints_m: np.ndarray  # (sequence, frame, 22, 3)
    points: np.ndarray  # (point, 5)
    point_sequence: np.ndarray  # (point,)
    point_frame: np.ndarray  # (point,)
    iq_scale: np.ndarray | None  # (sequence,); None where no signals are stored

    def __len__(self) -> int:
        return len(self.columns["label"])

    def cube(self, index: int) -> RadarCube:
        """The cube of one sequence in sqrt(mW). Raises InputError where none is stored, or its file is damaged."""
        if self.iq_scale is None:
            raise InputError(f"{self.files.folder} was made without signals; only joints and points are stored")
        self.files.check(f"{STORE}/iq/zarr.json", f"{STORE}/iq/c/{index}/")
        grid = CubeGrid.of(self.config, self.joints_m.shape[1])
        with self.files.reading():
            pairs = self.arrays.row("iq", index, (*grid.shape, 2), kinds="f").astype(np.float32)
        values = np.ascontiguousarray(pairs * np.float32(self.iq_scale[index])).view(np.complex64)[..., 0]
        return RadarCube(values=values, grid=CubeGrid.of(self.config, len(values)), config=self.config, scale=1.0)

    def cloud(self, index: int) -> PointCloud:
        """The point cloud of one sequence."""
        own = self.point_sequence == index
        columns = dict(zip(POINT_COLUMNS, self.points[own].T.astype(np.float64), strict=True))
        return PointCloud(frame=self.point_frame[own].astype(int), **columns)


def is_activity_set(folder: Path) -> bool:
    """Whether a folder holds a labelled set, complete or not."""
    return (folder / SET_FILE).is_file()


def _made_by(command: Any) -> str:
    try:
        words = shell_words(command)
    except ValueError:
        return MADE_BY
    return words if words.startswith(f"{MADE_BY} ") else MADE_BY


def read_activity_set(folder: Path) -> ActivitySet:
    """Opens a set. Raises InputError for a folder that is none, is not complete, or is damaged."""
    if not is_activity_set(folder):
        raise InputError(f"{folder} holds no labelled set (no {SET_FILE}); make one: mmweaver dataset OUT --activities")
    plan = read_json(folder / SET_FILE)
    made_by = _made_by(plan.get("command")) if isinstance(plan, dict) else MADE_BY
    if not (folder / STORE).is_dir():
        raise InputError(f"{folder} is not complete; make the rest with: {made_by}")
    files = CheckedFolder.of(folder, made_by)
    files.require_sums()
    files.check(but=(f"{STORE}/iq/c/",))
    with files.reading():
        group = open_zarr(folder / STORE)
        if group.attr("schema_version", int) != SCHEMA_VERSION:
            raise InputError(
                f"{folder} has version {group.attrs['schema_version']} of its layout; this mmweaver reads 1"
            )
        return _activity_set(files, group)


def _activity_set(files: CheckedFolder, group: ZarrFolder) -> ActivitySet:
    each, labels = ("sequence",), group.words("label_names")
    columns = {name: group.texts(name, "sequence") for name in STRINGS}
    for name, kind in NUMBERS.items():
        limits = {"low": -FARTHEST_M, "high": FARTHEST_M} if kind[0] == "f" else {"low": -1, "high": MOST}
        columns[name] = group.numbers(name, each, kinds=kind[0], **limits)
    group.numbers("label", each, kinds="i", low=0, high=len(labels) - 1)
    pose, near = ("sequence", "frame_time", len(JOINT_NAMES), 3), {"low": -FARTHEST_M, "high": FARTHEST_M}
    return ActivitySet(
        files=files, arrays=group, config=RadarConfig.from_json(json.dumps(group.attr("radar", dict))),
        label_names=labels, columns=columns, joints_m=group.numbers("joints", pose, kinds="f", **near),
        points=group.numbers("points", ("point", len(POINT_COLUMNS)), kinds="f", **near),
        point_sequence=group.numbers("point_sequence", ("point",), kinds="iu", low=0, high=len(columns["label"])),
        point_frame=group.numbers("point_frame", ("point",), kinds="iu", low=0, high=MOST),
        iq_scale=group.numbers("iq_scale", each, kinds="f", low=0) if "iq" in group else None,
    )  # fmt: skip
