"""A data set on disk: one Zarr group per room, readable with plain zarr or xarray, including axes and units.

    OUT/                       root group: plan.json, radar.json, axes
    OUT/office_003/            one group per room
        iq          (sequence, frame, range, doppler, antenna, part)  float16; times iq_scale: sqrt(mW)
        iq_scale    (sequence,)
        joints_m, joint_velocity_mps   (sequence, frame, joint, axis)
        subject, seed, label, label_name, text, split    (sequence,)
        photo_rgb, photo_depth_m, photo_class  (row, column[, colour])
        empty_iq    (range, antenna, part)  static clutter of the room
        SHA256SUMS  of all files of the room; the root has one of its own files
        geometry/   instead of iq: stored geometry from which signals are synthesised (`geometry_store`)
    OUT/office_003.zip         instead of the folder, if the set is packed: the same files, uncompressed

Every chunk ends in its CRC-32C, and every file is checked before use: signals and geometry when they are first read,
all other files of a room when it is opened. Written by `dataset_writer`. Reference: Zarr v3, xarray's
`_ARRAY_DIMENSIONS`.
"""

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.checksums import check_file
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube, RgbdPhoto
from mmweaver.core.safe_files.regular_files import Place
from mmweaver.core.safe_files.safe_text import parse_json, read_text
from mmweaver.core.safe_files.safe_zarr import ZarrFolder, open_zarr
from mmweaver.datasets.checked_folder import CheckedFolder, stored_iq
from mmweaver.datasets.dataset_folder import PLAN_FILE, finished, room_place
from mmweaver.datasets.dataset_plan import PEOPLE_HEIGHT_M, check_plan, command_of, room_name
from mmweaver.datasets.geometry_store import GEOMETRY, StoredGeometry
from mmweaver.datasets.zarr_arrays import stored_photo

FARTHEST_M, FASTEST_MPS = 1000.0, 1000.0  # limits of joints and depths; anything beyond indicates damage


@dataclass(frozen=True, kw_only=True)
class StoredRoom:
    """A room of a data set: joints in memory; photo and cubes are read, or cubes synthesised, on demand."""

    files: CheckedFolder
    kind: str
    layout: int
    lighting: str
    static: np.ndarray  # (range, antenna) complex64, static clutter at the peak of zero Doppler, sqrt(mW)
    joints_m: np.ndarray  # (sequence, frame, 22, 3)
    joint_velocity_mps: np.ndarray  # (sequence, frame, 22, 3)
    person: np.ndarray  # (sequence,)
    activity: tuple[str, ...]
    text: tuple[str, ...]
    split: tuple[str, ...]
    seed: np.ndarray  # (sequence,)
    config: RadarConfig
    geometry: StoredGeometry | None = None  # for data sets without signals
    device: str = "cpu"  # device on which signals are synthesised from geometry
    given_photo: RgbdPhoto | None = None  # instead of the stored one

    @property
    def folder(self) -> Place:
        """Folder of the room, or its root in a zip."""
        return self.files.folder

    @cached_property
    def photo(self) -> RgbdPhoto:
        """Photo of the room. Raises InputError if it is damaged."""
        if self.given_photo is not None:
            return self.given_photo
        with self.files.reading():
            return stored_photo(self._arrays)

    def cube(self, index: int, frames: np.ndarray | None = None, *, realization: int = 0) -> RadarCube:
        """Reads or synthesises the cube of one sequence.

        Args:
            index: Index of the sequence.
            frames: Indices of frames. Default: all.
            realization: Realization of speckle and noise, if signals are synthesised. Default: 0.

        Returns:
            Cube in sqrt(mW).

        Raises:
            InputError: If a file is damaged.
        """
        if self.geometry is not None:
            wanted = np.arange(len(self.joints_m[index])) if frames is None else frames
            values = self.geometry.cube(self._traced_motion(index), wanted, realization=realization, device=self.device)
        else:
            values = self._stored(index)
            values = values if frames is None else values[frames]
        return RadarCube(values=values, grid=CubeGrid.of(self.config, len(values)), config=self.config, scale=1.0)

    def body_paths(self, index: int, frames: np.ndarray) -> Any:
        """Propagation paths of the person, for data sets with geometry.

        Args:
            index: Index of the sequence.
            frames: Indices of frames.

        Returns:
            The paths, `propagation.body_paths.BodyPaths`.
        """
        assert self.geometry is not None, "signals are stored, not geometry"
        return self.geometry.resynthesis("cpu").person(self._traced_motion(index), frames)

    def _traced_motion(self, index: int) -> Any:
        assert self.geometry is not None
        person = int(self.person[index])
        return self.geometry.motion(index, person=person, height_m=PEOPLE_HEIGHT_M[person], seed=int(self.seed[index]))

    @cached_property
    def _arrays(self) -> ZarrFolder:
        with self.files.reading():
            return open_zarr(self.folder)

    @cached_property
    def _iq_scale(self) -> np.ndarray:
        with self.files.reading():
            return self._arrays.numbers("iq_scale", (len(self.seed),), kinds="f", low=0)

    def _stored(self, index: int) -> np.ndarray:
        grid = CubeGrid.of(self.config, self.joints_m.shape[1])
        return stored_iq(self.files, self._arrays, "", index, grid.shape, float(self._iq_scale[index]))


def read_rooms(folder: Path, *, device: str = "cpu") -> list[StoredRoom]:
    """Reads all rooms of a data set that contain sequences.

    Args:
        folder: The data set.
        device: Device on which signals that are not stored are synthesised. Default: CPU.

    Returns:
        The rooms, sorted by name.

    Raises:
        InputError: If the folder is not a data set, rooms are missing, or files are damaged.
    """
    plan = read_plan(folder)
    names = sorted(room_name(kind, layout) for kind in plan["kinds"] for layout in range(plan["num_layouts"]))
    missing = sorted(set(names) - finished(folder, names))
    made_by = command_of(plan, folder)
    if missing:
        others = f" and {len(missing) - 1} more of its {len(names)} rooms are" if len(missing) > 1 else " is"
        raise InputError(f"{folder} is not complete: {missing[0]}{others} missing; make the rest with: {made_by}")
    config = read_radar(folder)
    rooms = (_room(CheckedFolder.of(room_place(folder, name), made_by), config, device) for name in names)
    return [room for room in rooms if room is not None]


def read_radar(folder: Path) -> RadarConfig:
    """Reads the radar of a data set.

    Args:
        folder: The data set.

    Returns:
        The radar.

    Raises:
        InputError: If the folder is not a data set, or damaged.
    """
    root = CheckedFolder.of(folder, command_of(read_plan(folder), folder))
    root.check()
    with root.reading():
        group = open_zarr(folder)
        if "checksums" in group.attrs:
            root.require_sums()
        return RadarConfig.from_json(json.dumps(group.attr("radar", dict)))


def plan_text(folder: Path) -> str:
    """Reads the plan of a data set as JSON text.

    Args:
        folder: The data set.

    Returns:
        Content of plan.json.

    Raises:
        InputError: If the folder is not a data set, or its plan is damaged.
    """
    if not (folder / PLAN_FILE).is_file():
        raise InputError(f"{folder} holds no data set (no {PLAN_FILE}); make one with: mmweaver dataset {folder}")
    check_file(folder / PLAN_FILE)
    return read_text(folder / PLAN_FILE)


def read_plan(folder: Path) -> dict[str, Any]:
    """Reads the plan of a data set as a dictionary. Raises InputError as `plan_text` does."""
    return check_plan(parse_json(plan_text(folder), str(folder / PLAN_FILE)), folder / PLAN_FILE)


def _room(files: CheckedFolder, config: RadarConfig, device: str) -> StoredRoom | None:
    """Reads a room after checking its files; None if no sequence fits into it."""
    files.check(but=("iq/c/", f"{GEOMETRY}/"))
    with files.reading():
        group = open_zarr(files.folder)
        if "checksums" in group.attrs:
            files.require_sums()
        elif not (files.folder / "iq").is_dir() and not (files.folder / GEOMETRY / "visibility").is_dir():
            return None
        return _stored_room(files, group, config, device) if group.words("text") else None


def _stored_room(files: CheckedFolder, group: ZarrFolder, config: RadarConfig, device: str) -> StoredRoom:
    pose, one_each = ("sequence", "frame", 22, 3), ("sequence",)
    joints_m = group.numbers("joints_m", pose, kinds="f", low=-FARTHEST_M, high=FARTHEST_M)
    static_shape = (len(config.range_m), len(config.antenna_position_m), 2)
    static = group.numbers("empty_iq", static_shape, kinds="f")
    people = "subject" if "subject" in group else "person"  # name before 1.0
    words = {name: group.words(name) for name in ("activity", "text", "split")}
    for name, values in words.items():
        group.check_shape(name, (len(values),), one_each)
    return StoredRoom(
        files=files,
        kind=group.attr("kind", str),
        layout=group.attr("layout", int),
        lighting=group.attr("lighting", str),
        static=(static[..., 0] + 1j * static[..., 1]).astype(np.complex64),
        joints_m=joints_m,
        joint_velocity_mps=group.numbers("joint_velocity_mps", pose, kinds="f", low=-FASTEST_MPS, high=FASTEST_MPS),
        person=group.numbers(people, one_each, kinds="iu", low=0, high=len(PEOPLE_HEIGHT_M) - 1),
        activity=words["activity"],
        text=words["text"],
        split=words["split"],
        seed=group.numbers("seed", one_each, kinds="iu", low=0),
        config=config,
        geometry=StoredGeometry(files=files, config=config) if group.has_group(GEOMETRY) else None,
        device=device,
    )
