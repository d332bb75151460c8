"""A labelled set of activities on disk: one Zarr group that xarray opens with coordinates.

    OUT/sequences.zarr/               attributes: radar, label_names, schema_version
        iq        (sequence, frame_time, range, radial_velocity, antenna, part)  float16 or float32, times iq_scale;
                  without it signals are synthesised from geometry/ on demand (`signals_on_demand`)
        iq_scale  (sequence)   sqrt(mW)
        joints_m  (sequence, frame_time, joint, axis)   float32
        points    (point, column)   float32: x, y, z in metres, radial velocity in m/s, SNR in dB
        point_sequence, point_frame   (point)
        label, subject, place, room, draw, heading, height   (sequence)
        label_name, text, split, split_subject, split_place, split_room, split_sentence   (sequence)  strings
        frame_time, range, radial_velocity   coordinates in s, m, m/s; antenna_position_m (antenna, axis)
    OUT/set.json, activities.toml, leaks.json, SHA256SUMS

A data set of rooms has the same arrays in one group per room (`dataset_store`). Signals are stored in shards without
compression, so that the size of a sequence carries no information on its label; every chunk ends in its CRC-32C, and
all files are checked against SHA256SUMS before use. Reference: docs/decisions/matched-draws.md.
"""

import json
from collections.abc import Iterable
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
from mmweaver.datasets.checked_folder import CheckedFolder, stored_iq
from mmweaver.datasets.dataset_plan import shell_words
from mmweaver.datasets.signals_on_demand import GEOMETRY, SetGeometry, SignalsOnDemand, write_set_geometry
from mmweaver.datasets.zarr_arrays import IQ_DIMENSIONS, consolidate, put_array, put_texts, write_iq, zarr_module
from mmweaver.io.npz_files import POINT_COLUMNS

SET_FILE, LEAKS_FILE, ACTIVITIES_FILE, STORE = "set.json", "leaks.json", "activities.toml", "sequences.zarr"
SCHEMA_VERSION = 2
SPLITS = ("train", "validation", "test")
SPLIT_KEYS = ("subject", "place", "room", "sentence")
STRINGS = ("label_name", "text", "split", *(f"split_{key}" for key in SPLIT_KEYS))
NUMBERS = {
    "label": "int32",
    "subject": "int32",
    "place": "int32",
    "room": "int32",
    "draw": "int32",
    "heading": "float32",
    "height": "float32",
}
IQ_KINDS = ("float16", "float32", "none")
MADE_BY = "mmweaver dataset"
MOST = 2**31 - 1  # largest index or count
FARTHEST_M = 1000.0  # largest coordinate of joints and points; anything beyond indicates damage


def write_set(
    folder: Path,
    config: RadarConfig,
    labels: tuple[str, ...],
    columns: dict[str, Any],
    arrays: dict[str, np.ndarray],
    signals: Iterable[np.ndarray] | SetGeometry,
    kind: str,
) -> None:
    """Writes a new store into a folder.

    Args:
        folder: The folder.
        config: Radar of all sequences.
        labels: Names of the labels by number.
        columns: One value per sequence for each of STRINGS and NUMBERS.
        arrays: "joints_m", "points", "point_sequence", "point_frame" and "iq_scale", as in the module's table.
        signals: Signals packed by `zarr_arrays.packed_iq`, one sequence at a time, or the geometry from which they are
            synthesised on demand.
        kind: Number type of the signals, one of IQ_KINDS.
    """
    group: Any = zarr_module().open_group(folder / STORE, mode="w")
    frames = arrays["joints_m"].shape[1]
    grid = CubeGrid.of(config, frames)
    group.attrs["schema_version"] = SCHEMA_VERSION
    group.attrs["radar"] = parse_json(config.to_json(), "the radar")
    group.attrs["label_names"] = list(labels)
    coordinates = {
        "frame_time": grid.frame_time_s,
        "range": grid.range_m,
        "radial_velocity": grid.radial_velocity_mps,
    }
    for name, values in coordinates.items():
        put_array(group, name, np.asarray(values, np.float64), (name,))
    put_array(group, "antenna_position_m", grid.antenna_position_m, ("antenna", "axis"))
    for name in STRINGS:
        put_texts(group, name, columns[name])
    for name, number in NUMBERS.items():
        put_array(group, name, np.asarray(columns[name], number), ("sequence",))
    put_array(group, "joints_m", arrays["joints_m"], ("sequence", "frame_time", "joint", "axis"))
    group["joints_m"].attrs["joint_names"] = list(JOINT_NAMES)
    for name, dimensions in (
        ("points", ("point", "column")),
        ("point_sequence", ("point",)),
        ("point_frame", ("point",)),
    ):
        put_array(group, name, arrays[name], dimensions)
    group["points"].attrs["columns"] = list(POINT_COLUMNS)
    if isinstance(signals, SetGeometry):
        write_set_geometry(group, signals)
    else:
        put_array(group, "iq_scale", arrays["iq_scale"], ("sequence",))
        write_iq(group, kind, (len(columns["label"]), *CubeGrid.of(config, frames).shape, 2), signals)
    consolidate(folder / STORE)


def bytes_of_signals(folder: Path, sequences: int) -> list[int]:
    """Size of the file that contains the signals of each sequence.

    Args:
        folder: The set.
        sequences: Number of sequences.

    Returns:
        Bytes per sequence; empty without stored signals.
    """
    store = open_zarr(folder / STORE)
    if "iq" not in store:
        return []
    rows, rest = store.rows_a_file("iq"), "/".join("0" for _ in IQ_DIMENSIONS[1:])
    return [(folder / STORE / "iq" / "c" / str(n // rows) / rest).stat().st_size for n in range(sequences)]


@dataclass(frozen=True, kw_only=True)
class ActivitySet:
    """A stored labelled set; everything except the signals is in memory."""

    files: CheckedFolder
    arrays: ZarrFolder
    config: RadarConfig
    label_names: tuple[str, ...]
    columns: dict[str, np.ndarray]  # (sequence,) each
    joints_m: np.ndarray  # (sequence, frame, 22, 3)
    points: np.ndarray  # (point, 5)
    point_sequence: np.ndarray  # (point,)
    point_frame: np.ndarray  # (point,)
    iq_scale: np.ndarray | None  # (sequence,); None without stored signals
    on_demand: SignalsOnDemand | None  # synthesises signals that are not stored; None in sets before mmweaver 1.0

    def __len__(self) -> int:
        return len(self.columns["label"])

    def cube(self, index: int) -> RadarCube:
        """Reads or synthesises the cube of one sequence.

        Args:
            index: Index of the sequence.

        Returns:
            Cube in sqrt(mW).

        Raises:
            InputError: If a file is damaged, or the set has no signals.
        """
        if self.on_demand is not None:
            room, subject = (int(self.columns[name][index]) for name in ("room", "subject"))
            return self.on_demand.cube(index, room=room, subject=subject)
        if self.iq_scale is None:
            raise InputError(f"{self.files.folder} was made without signals; only joints and points are stored")
        grid = CubeGrid.of(self.config, self.joints_m.shape[1])
        values = stored_iq(self.files, self.arrays, f"{STORE}/", index, grid.shape, float(self.iq_scale[index]))
        return RadarCube(values=values, grid=grid, config=self.config, scale=1.0)

    def cloud(self, index: int) -> PointCloud:
        """Point cloud of one sequence.

        Args:
            index: Index of the sequence.

        Returns:
            The stored points.
        """
        own = self.point_sequence == index
        columns = dict(zip(POINT_COLUMNS, self.points[own].T.astype(np.float64), strict=True))
        return PointCloud(frame=self.point_frame[own].astype(int), **columns)


def is_activity_set(folder: Path) -> bool:
    """Whether a folder contains a labelled set, complete or not."""
    return (folder / SET_FILE).is_file()


def made_by(command: Any) -> str:
    """Command that made a set, with each word quoted again for safe pasting.

    Args:
        command: The command stored in the set.

    Returns:
        The command line; the bare command if the stored one is something else.
    """
    try:
        words = shell_words(command)
    except ValueError:
        return MADE_BY
    return words if words.startswith(f"{MADE_BY} ") else MADE_BY


def read_activity_set(folder: Path) -> ActivitySet:
    """Opens a labelled set.

    Args:
        folder: The set.

    Returns:
        The set, with checksums verified.

    Raises:
        InputError: If the folder is not a labelled set, is incomplete, or damaged.
    """
    if not is_activity_set(folder):
        raise InputError(f"{folder} holds no labelled set (no {SET_FILE}); make one: mmweaver dataset OUT --activities")
    plan = read_json(folder / SET_FILE)
    again = made_by(plan.get("command")) if isinstance(plan, dict) else MADE_BY
    if not (folder / STORE).is_dir():
        raise InputError(f"{folder} is not complete; make the rest with: {again}")
    files = CheckedFolder.of(folder, again)
    files.require_sums()
    files.check(but=(f"{STORE}/iq/c/", f"{STORE}/{GEOMETRY}/motion_m/c/"))
    with files.reading():
        group = open_zarr(folder / STORE)
        if group.attr("schema_version", int) != SCHEMA_VERSION:
            raise InputError(
                f"{folder} has version {group.attrs['schema_version']} of its layout, this mmweaver reads"
                f" {SCHEMA_VERSION}; make it anew with: {again}"
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
    config = RadarConfig.from_json(json.dumps(group.attr("radar", dict)))
    joints_m = group.numbers("joints_m", pose, kinds="f", **near)
    is_made = group.has_group(GEOMETRY)
    return ActivitySet(
        files=files,
        arrays=group,
        config=config,
        label_names=labels,
        columns=columns,
        joints_m=joints_m,
        on_demand=SignalsOnDemand(files, f"{STORE}/{GEOMETRY}/", config, joints_m.shape[1]) if is_made else None,
        points=group.numbers("points", ("point", len(POINT_COLUMNS)), kinds="f", **near),
        point_sequence=group.numbers("point_sequence", ("point",), kinds="iu", low=0, high=len(columns["label"])),
        point_frame=group.numbers("point_frame", ("point",), kinds="iu", low=0, high=MOST),
        iq_scale=group.numbers("iq_scale", each, kinds="f", low=0) if "iq" in group else None,
    )
