"""A data set on disk: one Zarr group a room, readable with plain zarr or xarray, axes and units inside.

    OUT/                       root group: plan, radar, axes
    OUT/office_003/            one group a room
        iq          (sequence, frame, range, doppler, antenna, part)  float16; times iq_scale: sqrt(mW)
        iq_scale    (sequence,)
        joints_m, joint_velocity_mps   (sequence, frame, joint, axis)
        person, seed, activity, text, split    (sequence,)
        photo_rgb, photo_depth_m, photo_class  (row, column[, colour])
        empty_iq    (range, antenna, part)  static clutter of the room
        geometry/   instead of iq: stored geometry from which signals are synthesised (`geometry_store`)

A room is written under a temporary name and renamed when complete, so that a kill at any point loses only unfinished
rooms. Reference: Zarr v3, xarray's `_ARRAY_DIMENSIONS`; decision 92.
"""

import json
import os
import platform
import shutil
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CameraIntrinsics, ClassMask, CubeGrid, RadarCube, RgbdPhoto
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M, DatasetPlan
from mmweaver.datasets.geometry_store import GEOMETRY, StoredGeometry, write_geometry
from mmweaver.datasets.room_generation import GeneratedRoom, GeneratedSequence, TracedSequence

PLAN_FILE = "plan.json"
SEQUENCES_A_SHARD = 8
ABANDONED_S = 3600.0  # after which an unfinished room of another machine counts as abandoned
UNITS = {
    "iq": "1 (times iq_scale: sqrt(mW))", "iq_scale": "sqrt(mW)", "joints_m": "m", "joint_velocity_mps": "m/s",
    "photo_depth_m": "m", "range_m": "m", "radial_velocity_mps": "m/s", "frame_time_s": "s",
    "antenna_position_m": "m", "empty_iq": "sqrt(mW)",
}  # fmt: skip


def _zarr() -> Any:
    """The zarr module, imported lazily. Raises InputError where it is not installed."""
    try:
        import zarr
    except ImportError as error:
        raise InputError("data sets need Zarr; install it with: pip install 'mmweaver[dataset]'") from error
    return zarr


def open_dataset(folder: Path, plan: DatasetPlan, config: RadarConfig) -> None:
    """Creates the folder of a data set, or checks that an existing one has the same plan. Raises InputError if not."""
    zarr = _zarr()
    text = plan.to_json()
    file = folder / PLAN_FILE
    if file.is_file():
        if file.read_text(encoding="utf-8") != text:
            raise InputError(f"{folder} holds a data set of another plan; choose another folder or the same settings")
        return
    if folder.exists() and any(folder.iterdir()):
        raise InputError(f"{folder} is not empty and holds no data set; choose another folder")
    folder.mkdir(parents=True, exist_ok=True)
    root = zarr.open_group(folder, mode="a")
    grid = CubeGrid.of(config, plan.num_frames)
    for name in ("frame_time_s", "range_m", "radial_velocity_mps"):
        dimension = {"frame_time_s": "frame", "range_m": "range", "radial_velocity_mps": "doppler"}[name]
        _put(root, name, getattr(grid, name), (dimension,))
    _put(root, "antenna_position_m", grid.antenna_position_m, ("antenna", "axis"))
    root.attrs.update(
        {"made_by": "mmweaver dataset", "radar": json.loads(config.to_json()), "joints": list(JOINT_NAMES),
         "wavelength_m": config.wavelength_m}
    )  # fmt: skip
    partial = folder / f".{PLAN_FILE}"
    partial.write_text(text, encoding="utf-8")
    partial.replace(file)


def is_done(folder: Path, name: str) -> bool:
    """Whether a room has been written completely."""
    return (folder / name / "zarr.json").is_file()


def is_being_written(partial: Path) -> bool:
    """Whether an unfinished room belongs to a process that still runs here, or may run on another machine.

    Workers outlive a killed parent by a room or two; their unfinished rooms must not be deleted.
    """
    *_, host, process = partial.name.rsplit(".", 2)
    if host != _host() or os.name == "nt":  # on Windows os.kill would end the process instead of asking after it
        return time.time() - partial.stat().st_mtime < ABANDONED_S
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, ValueError):
        return False
    except PermissionError:
        return True
    return not _is_zombie(process)


def _is_zombie(process: str) -> bool:
    """Whether the process has ended but was not waited for; False where there is no /proc."""
    try:
        state = Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except (OSError, IndexError):
        return False
    return state == "Z"


def _host() -> str:
    return platform.node().replace(".", "-") or "here"


def write_room(folder: Path, generated: GeneratedRoom) -> None:
    """Writes one room atomically."""
    zarr = _zarr()
    partial = folder / f".{generated.spec.name}.{_host()}.{os.getpid()}"
    shutil.rmtree(partial, ignore_errors=True)
    group = zarr.open_group(partial, mode="w")
    sequences = generated.sequences
    traced = tuple(s for s in sequences if isinstance(s, TracedSequence))
    signals = [s.cube.values for s in sequences if isinstance(s, GeneratedSequence)]
    if signals:
        iq, scale = _packed(signals)
        _put(group, "iq", iq, ("sequence", "frame", "range", "doppler", "antenna", "part"), each=True)
        _put(group, "iq_scale", scale, ("sequence",))
    if generated.geometry is not None:
        write_geometry(group, generated.geometry, traced)
    if sequences:
        pose = ("sequence", "frame", "joint", "axis")
        _put(group, "joints_m", np.stack([s.joints_m for s in sequences]), pose)
        _put(group, "joint_velocity_mps", np.stack([s.joint_velocity_mps for s in sequences]), pose)
        _put(group, "person", np.array([s.spec.person for s in sequences]), ("sequence",))
        _put(group, "seed", np.array([s.spec.seed for s in sequences]), ("sequence",))
    photo = generated.photo
    _put(group, "photo_rgb", photo.rgb, ("row", "column", "colour"))
    _put(group, "photo_depth_m", photo.depth_m.astype(np.float32), ("row", "column"))
    if photo.classes is not None:
        _put(group, "photo_class", photo.classes.index, ("row", "column"))
    _put(
        group,
        "empty_iq",
        np.stack([np.real(generated.static), np.imag(generated.static)], -1),
        ("range", "antenna", "part"),
    )
    group.attrs.update(
        {
            "kind": generated.spec.kind, "layout": generated.spec.layout, "lighting": generated.spec.lighting,
            "activity": [s.spec.activity for s in sequences], "text": [s.spec.text for s in sequences],
            "split": [s.spec.split for s in sequences], "index": [s.spec.index for s in sequences],
            "refused": [list(entry) for entry in generated.refused],
            "camera": asdict(photo.intrinsics),
            "class_names": list(photo.classes.names) if photo.classes else [],
        }
    )  # fmt: skip
    if not is_done(folder, generated.spec.name):
        shutil.rmtree(folder / generated.spec.name, ignore_errors=True)
    try:
        partial.rename(folder / generated.spec.name)
    except OSError:  # another process has written the identical room in the meantime
        if not is_done(folder, generated.spec.name):
            raise
        shutil.rmtree(partial, ignore_errors=True)


def _packed(cubes: Sequence[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Cubes as float16 pairs (cube, ..., part) and the scale of each (cube,): relative error below 5e-4."""
    out = np.empty((len(cubes), *cubes[0].shape, 2), np.float16)
    scale = np.empty(len(cubes), np.float32)
    for index, values in enumerate(cubes):  # one at a time: 120 sequences would fill gigabytes
        scale[index] = max(np.abs(values).max(), 1e-30)
        unit = values / scale[index]
        # float16 loses precision below 6e-5, where the cell noise lies: 1.0 is stored as 1024
        out[index] = np.stack([unit.real, unit.imag], axis=-1) * 1024
    return out, scale / np.float32(1024)


def _put(group: Any, name: str, values: np.ndarray, dimensions: tuple[str, ...], *, each: bool = False) -> None:
    """Writes one array as one chunk, or (`each`) one chunk per sequence, gathered into shards."""
    values = np.ascontiguousarray(values)
    options: dict[str, Any] = {"chunks": values.shape if values.size else (1,) * values.ndim}
    if each:
        rest = values.shape[1:]
        options = {"chunks": (1, *rest), "shards": (min(SEQUENCES_A_SHARD, len(values)), *rest)}
        if len(values) % options["shards"][0]:
            options["shards"] = (1, *rest)
    array = group.create_array(
        name, shape=values.shape, dtype=values.dtype, dimension_names=dimensions, overwrite=True, **options
    )
    array[...] = values
    if name in UNITS:
        array.attrs["units"] = UNITS[name]


@dataclass(frozen=True, kw_only=True)
class StoredRoom:
    """A room of a data set: photo and joints in memory, cubes read or synthesised on demand."""

    folder: Path
    kind: str
    layout: int
    lighting: str
    photo: RgbdPhoto
    static: np.ndarray  # (range, antenna) complex64, static clutter at the peak of zero Doppler, sqrt(mW)
    joints_m: np.ndarray  # (sequence, frame, 22, 3)
    joint_velocity_mps: np.ndarray  # (sequence, frame, 22, 3)
    person: np.ndarray  # (sequence,)
    activity: tuple[str, ...]
    text: tuple[str, ...]
    split: tuple[str, ...]
    seed: np.ndarray  # (sequence,)
    config: RadarConfig
    geometry: StoredGeometry | None = None  # of a data set without signals
    device: str = "cpu"  # where signals are synthesised from geometry

    def cube(self, index: int, frames: np.ndarray | None = None, *, realization: int = 0) -> RadarCube:
        """The cube of one sequence, or some of its frames, in sqrt(mW).

        Signals that are not stored are synthesised; another `realization` has other surface micro-phases and noise.
        """
        if self.geometry is not None:
            wanted = np.arange(len(self.joints_m[index])) if frames is None else frames
            values = self.geometry.cube(self._traced_motion(index), wanted, realization=realization, device=self.device)
        else:
            values = self._stored(index)
            values = values if frames is None else values[frames]
        return RadarCube(values=values, grid=CubeGrid.of(self.config, len(values)), config=self.config, scale=1.0)

    def body_paths(self, index: int, frames: np.ndarray) -> Any:
        """The person's paths (`paths.body_paths.BodyPaths`) in frames of one sequence, of a set with geometry."""
        assert self.geometry is not None, "signals are stored, not geometry"
        return self.geometry.resynthesis("cpu").person(self._traced_motion(index), frames)

    def _traced_motion(self, index: int) -> Any:
        assert self.geometry is not None
        person = int(self.person[index])
        return self.geometry.motion(index, person=person, height_m=PEOPLE_HEIGHT_M[person], seed=int(self.seed[index]))

    def _stored(self, index: int) -> np.ndarray:
        zarr = _zarr()
        group: Any = zarr.open_group(self.folder, mode="r")
        pairs = np.asarray(group["iq"][index]).astype(np.float32) * np.float32(group["iq_scale"][index])
        return np.ascontiguousarray(pairs).view(np.complex64)[..., 0]


def read_rooms(folder: Path, *, device: str = "cpu") -> list[StoredRoom]:
    """All rooms of a data set; signals that are not stored are synthesised on `device`.

    Raises InputError where the folder is not a data set.
    """
    if not (folder / PLAN_FILE).is_file():
        raise InputError(f"{folder} holds no data set (no {PLAN_FILE}); make one with: mmweaver dataset {folder}")
    config = read_radar(folder)
    names = sorted(path.name for path in folder.iterdir() if not path.name.startswith(".") and _has_sequences(path))
    return [_room(folder / name, config, device) for name in names]


def _has_sequences(room: Path) -> bool:
    return (room / "iq").is_dir() or (room / GEOMETRY / "visibility").is_dir()


def read_radar(folder: Path) -> RadarConfig:
    """The radar of a data set."""
    return RadarConfig.from_json(json.dumps(_zarr().open_group(folder, mode="r").attrs["radar"]))


def plan_text(folder: Path) -> str:
    """The plan of a data set as JSON text."""
    return (folder / PLAN_FILE).read_text(encoding="utf-8")


def read_plan(folder: Path) -> dict[str, Any]:
    """The plan of a data set as a dictionary."""
    return json.loads(plan_text(folder))


def _room(folder: Path, config: RadarConfig, device: str) -> StoredRoom:
    zarr = _zarr()
    group = zarr.open_group(folder, mode="r")
    attrs: dict[str, Any] = dict(group.attrs)
    names = tuple(attrs["class_names"])
    classes = ClassMask(index=np.asarray(group["photo_class"]), names=names) if names else None
    static = np.asarray(group["empty_iq"])
    return StoredRoom(
        folder=folder, kind=attrs["kind"], layout=attrs["layout"], lighting=attrs["lighting"],
        photo=RgbdPhoto(
            rgb=np.asarray(group["photo_rgb"]), depth_m=np.asarray(group["photo_depth_m"]).astype(np.float64),
            intrinsics=CameraIntrinsics(**attrs["camera"]), classes=classes,
        ),
        static=(static[..., 0] + 1j * static[..., 1]).astype(np.complex64),
        joints_m=np.asarray(group["joints_m"]), joint_velocity_mps=np.asarray(group["joint_velocity_mps"]),
        person=np.asarray(group["person"]), activity=tuple(attrs["activity"]), text=tuple(attrs["text"]),
        split=tuple(attrs["split"]), seed=np.asarray(group["seed"]), config=config,
        geometry=StoredGeometry(folder=folder, config=config) if GEOMETRY in group else None, device=device,
    )  # fmt: skip
