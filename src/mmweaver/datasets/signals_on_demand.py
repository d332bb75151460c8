"""Geometry that a labelled set stores instead of signals: rooms, motions and seeds, from which its method remakes them.

    OUT/sequences.zarr/geometry/     attributes: method, made_by (version), board
        motion_m        (sequence, time, joint, axis) float32   densely sampled joints in the radar's frame
        motion_time_s   (time)
        seed, height_m, girth, moving_power_db   (sequence)
        room_0/         photo_rgb, photo_depth_m[, photo_class] of the first room
        room_0/view_1/  a further photo of it, with its pose

Signals come from `methods.METHODS` by the same call as in `Weaver`, so there is no second implementation. The moving
power of each signal is compared with the stored one, which detects another version of method or weights.
Reference: docs/decisions/data-set-plan.md.
"""

from collections import OrderedDict
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import PoseSequence, RadarCube, RgbdPhoto, Scene
from mmweaver.core.safe_files.safe_zarr import ZarrFolder, open_zarr
from mmweaver.core.seeding import single_precision
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.core.stages import Stages
from mmweaver.datasets.checked_folder import CheckedFolder, stored_sequence
from mmweaver.datasets.zarr_arrays import put_array, put_photo, put_sequences, stored_photo
from mmweaver.models.methods import METHODS, Method
from mmweaver.scene.photo.capture_photo import PosedPhoto
from mmweaver.scene.reconstruction import reconstruct

GEOMETRY = "geometry"
POWER_TOLERANCE_DB = 0.2  # processors differ by less than 0.01 dB, other people or weights by more than 1 dB
MAX_ROOMS = 8  # prepared rooms in the cache
FARTHEST_M = 1000.0


def moving_power_db(cube: RadarCube) -> float:
    """Mean power over cells of the deviation from the mean over frames.

    Args:
        cube: The cube.

    Returns:
        Power in dBm.
    """
    values = cube.values - cube.values.mean(axis=0, keepdims=True)
    power = float(np.mean(np.abs(values).astype(np.float64) ** 2)) * cube.scale**2
    return float(10 * np.log10(max(power, 1e-300)))


def storable(pose: PoseSequence) -> PoseSequence:
    """Rounds joints to their stored precision, so that the signal can be reproduced from the stored motion."""
    return replace(pose, joints_m=pose.joints_m.astype(np.float32).astype(np.float64))


@dataclass(frozen=True, kw_only=True)
class SetGeometry:
    """Everything from which the signals of a set are made.

    Attributes:
        method: Name of the method.
        board: Board of all sequences.
        rooms: Photo and further views of each room.
        time_s: Times of all motions in seconds, (time,).
        sequences: seed, height_m, girth and moving_power_db, (sequence,) each.
        motions_m: Joints of one sequence after the other, float32 (time, joint, 3).
    """

    method: str
    board: Board
    rooms: Sequence[tuple[RgbdPhoto, Sequence[PosedPhoto]]]
    time_s: np.ndarray
    sequences: dict[str, np.ndarray]
    motions_m: Iterable[np.ndarray]


def write_set_geometry(store: Any, geometry: SetGeometry) -> None:
    """Writes geometry into the Zarr group of a labelled set.

    Args:
        store: The group.
        geometry: The geometry.
    """
    from zarr.codecs import BloscCodec

    group = store.create_group(GEOMETRY)
    group.attrs.update({"method": geometry.method, "made_by": __version__, "board": geometry.board.to_json()})
    put_array(group, "motion_time_s", geometry.time_s, ("time",))
    for name, values in geometry.sequences.items():
        put_array(group, name, values, ("sequence",))
    shape = (len(geometry.sequences["seed"]), len(geometry.time_s), len(JOINT_NAMES), 3)
    packing = BloscCodec(cname="zstd", clevel=7, shuffle="bitshuffle")
    axes = ("sequence", "time", "joint", "axis")
    put_sequences(group, "motion_m", "float32", shape, axes, geometry.motions_m, packing=[packing])
    for number, (photo, others) in enumerate(geometry.rooms):
        room = group.create_group(f"room_{number}")
        put_photo(room, photo, "float64")
        room.attrs["views"] = len(others)
        for view, other in enumerate(others, start=1):
            below = room.create_group(f"view_{view}")
            put_photo(below, other.photo, "float64")
            if isinstance(other.pose, RadarPose):
                below.attrs["rough_pose"] = asdict(other.pose)
            else:
                put_array(below, "pose", np.asarray(other.pose, np.float64), ("to", "from"))


class SignalsOnDemand:
    """Synthesises the signals of a stored set. Rooms are prepared at first use, separately in every worker."""

    def __init__(self, files: CheckedFolder, below: str, config: RadarConfig, num_frames: int):
        """Reads the geometry except for motions and photos.

        Args:
            files: Folder of the set.
            below: Path of the geometry group in the folder, ending in "/".
            config: The radar.
            num_frames: Frames per sequence.

        Raises:
            InputError: If it is damaged.
        """
        self.files, self.below, self.config, self.num_frames = files, below, config, num_frames
        each = ("sequence",)
        self._group = group = open_zarr(files.folder / below)
        self.method = group.attr("method", str)
        self.made_by = group.attr("made_by", str)
        self.board = Board.from_json(group.attr("board", str), f"{group.path}: its board")
        self._time_s = group.numbers("motion_time_s", ("time",), kinds="f", low=-10.0, high=1e6)
        self._seed = group.numbers("seed", each, kinds="i", low=0)
        self._height_m = group.numbers("height_m", each, kinds="f", low=0.3, high=3.0)
        self._girth = group.numbers("girth", each, kinds="f", low=0.1, high=10.0)
        self._power_db = group.numbers("moving_power_db", each, kinds="f")
        self._rooms: OrderedDict[int, tuple[Scene, Method]] = OrderedDict()

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_rooms": OrderedDict()}

    @single_precision()
    def cube(self, index: int, *, room: int, subject: int) -> RadarCube:
        """Synthesises the signal of one sequence.

        Args:
            index: Index of the sequence.
            room: Index of its room.
            subject: Index of its person.

        Returns:
            Cube in sqrt(mW).

        Raises:
            InputError: If this version makes a different signal, or the geometry is damaged.
        """
        scene, method = self._prepared(room)
        pose = self.motion(index, subject)
        board: dict[str, Any] = {} if self.board.is_ideal else {"board": self.board}
        cube = method(
            scene,
            (pose,),
            self.config,
            num_frames=self.num_frames,
            seed=int(self._seed[index]),
            keep_adc=False,
            stages=Stages(),
            **board,
        ).cube
        if abs(moving_power_db(cube) - self._power_db[index]) > POWER_TOLERANCE_DB:
            raise InputError(
                f"{self.files.folder}: mmweaver {__version__} makes another signal of sequence {index} than"
                f" {self.made_by}, which made this set; make the set again, or with --iq float16, which keeps signals"
            )
        return cube

    def motion(self, index: int, subject: int) -> PoseSequence:
        """Reads the densely sampled motion of one sequence.

        Args:
            index: Index of the sequence.
            subject: Index of its person.

        Returns:
            The motion.

        Raises:
            InputError: If it is damaged.
        """
        shape = (len(self._time_s), len(JOINT_NAMES), 3)
        near = {"low": -FARTHEST_M, "high": FARTHEST_M}
        joints_m = stored_sequence(self.files, self._group, self.below, "motion_m", index, shape, **near)
        return PoseSequence(
            time_s=self._time_s.astype(np.float64),
            joints_m=joints_m.astype(np.float64),
            subject=subject,
            height_m=float(self._height_m[index]),
            girth=float(self._girth[index]),
        )

    def _prepared(self, room: int) -> tuple[Scene, Method]:
        """The room and its own instance of the method, which caches what it prepares."""
        if room not in self._rooms:
            if self.method not in METHODS:
                raise InputError(f"{self.files.folder} is of method {self.method!r}, which is not installed here")
            while len(self._rooms) >= MAX_ROOMS:
                self._rooms.popitem(last=False)
            self._rooms[room] = self._scene(room), METHODS[self.method]()
        self._rooms.move_to_end(room)
        return self._rooms[room]

    def _scene(self, room: int) -> Scene:
        with self.files.reading():
            group = self._group.group(f"room_{room}")
            others = [_view(group.group(f"view_{number + 1}")) for number in range(group.attr("views", int))]
            return reconstruct(stored_photo(group), others)


def _view(group: ZarrFolder) -> PosedPhoto:
    photo = stored_photo(group)
    if "rough_pose" in group.attrs:
        try:
            return PosedPhoto(photo=photo, pose=RadarPose(**group.attr("rough_pose", dict)))
        except TypeError:
            raise InputError(f"{group.path} is damaged: its rough_pose; make it again") from None
    return PosedPhoto(photo=photo, pose=group.numbers("pose", (4, 4), kinds="f", low=-FARTHEST_M, high=FARTHEST_M))
