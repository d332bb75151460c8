"""Batches for training the weaver, drawn from a data set; the same step always gives the same batch."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_rooms
from mmweaver.dsp.cube import static_cube
from mmweaver.dsp.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    has_elevation,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.paths.mean_power import PowerMaps
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.training.device import Share
from mmweaver.training.expected_maps import ExpectedMaps
from mmweaver.training.network_loss import Targets
from mmweaver.training.reflection_augmentation import reflected_joints, reflected_scene, reflected_targets


@dataclass(frozen=True, kw_only=True)
class NetworkBatch:
    """Rooms, whole motions, and the power maps of some of their frames."""

    view: SceneTensors
    joints_m: Tensor  # (sequence, frame, 22, 3), all frames
    velocity_mps: Tensor
    frames: Tensor  # (sequence, chosen) indices
    targets: Targets


class RoomExamples:
    """One stored room: its view, and the sequences of one split."""

    def __init__(self, room: StoredRoom, split: str):
        self.room = room
        self.indices = [index for index, name in enumerate(room.split) if name == split]

    @cached_property
    def view(self) -> SceneTensors:
        """What the product would see of the room: its photo, reconstructed."""
        geometry = self.room.geometry
        scene = reconstruct(self.room.photo)
        return SceneTensors.of(scene, self.room.config, None if geometry is None else geometry.photographed)

    def maps(self, index: int, frames: np.ndarray) -> tuple[PowerMaps, PowerMaps | None]:
        """Maps (frame, range, other) of frames of a sequence, and of the person alone where geometry is stored.

        Stored signals give those of their one draw, stored geometry the mean of all draws.
        """
        if self._expected is not None:
            return self._expected.frames(index, frames)
        cube = self.room.cube(index, frames)
        return power_maps(cube.values, cube.config), None

    @cached_property
    def empty(self) -> PowerMaps:
        """Maps (range, other) of the room without a person."""
        if self._expected is not None:
            return self._expected.empty
        return power_maps(static_cube(self.room.static, self.room.config).values, self.room.config)[0]

    @cached_property
    def _expected(self) -> ExpectedMaps | None:
        return None if self.room.geometry is None else ExpectedMaps(self.room)


def examples(folder: Path, split: str) -> list[RoomExamples]:
    """The rooms of a data set that have sequences of a split. Raises InputError where there are none."""
    device = "cuda" if torch.cuda.is_available() else "cpu"
    rooms = [RoomExamples(room, split) for room in read_rooms(folder, device=device)]
    rooms = [room for room in rooms if room.indices]
    if not rooms:
        raise InputError(f"{folder} has no sequences of split {split!r}; make more with: mmweaver dataset")
    return rooms


def sample_batch(
    rooms: list[RoomExamples],
    seed: int,
    step: int,
    *,
    size: int,
    frames: int,
    share: Share = (0, 1),
    mirror: bool = False,
) -> NetworkBatch:
    """`size` sequences of as many rooms, and `frames` frames of each to look at; of them the share of one process.

    With `mirror`, every second batch shows its rooms and people with left and right exchanged.
    """
    rng = stream(seed, "batch", step)
    chosen = rng.choice(len(rooms), size=size, replace=len(rooms) < size)
    views, joints, velocity, picked, maps, empty = [], [], [], [], [], []
    alone: list[PowerMaps | None] = []
    for number, which in enumerate(chosen):
        one = rooms[int(which)]
        index = one.indices[int(rng.integers(len(one.indices)))]
        length = len(one.room.joints_m[index])
        some = np.sort(rng.choice(length, size=min(frames, length), replace=False))
        if number % share[1] != share[0]:
            continue
        views.append(one.view)
        joints.append(torch.from_numpy(one.room.joints_m[index]))
        velocity.append(torch.from_numpy(one.room.joint_velocity_mps[index]))
        picked.append(torch.from_numpy(some))
        whole, person = one.maps(index, some)
        maps.append(whole)
        alone.append(person)
        empty.append(one.empty)
    batch = NetworkBatch(
        view=SceneTensors.stack(views),
        joints_m=torch.stack(joints),
        velocity_mps=torch.stack(velocity),
        frames=torch.stack(picked),
        targets=Targets(maps=PowerMaps.stack(maps), empty=PowerMaps.stack(empty), person=_all_or_none(alone)),
    )
    return _mirrored(batch) if mirror and rng.random() < 0.5 else batch


def _all_or_none(maps: list[PowerMaps | None]) -> PowerMaps | None:
    known = [one for one in maps if one is not None]
    return PowerMaps.stack(known) if len(known) == len(maps) else None


def _mirrored(batch: NetworkBatch) -> NetworkBatch:
    return replace(
        batch,
        view=reflected_scene(batch.view),
        joints_m=reflected_joints(batch.joints_m),
        velocity_mps=reflected_joints(batch.velocity_mps),
        targets=reflected_targets(batch.targets),
    )


def power_maps(values: np.ndarray, config: RadarConfig) -> PowerMaps:
    """The maps of a cube's values (frame, range, doppler, antenna)."""
    cube = RadarCube(values=values, grid=CubeGrid.of(config, len(values)), config=config, scale=1.0)
    if has_elevation(config):
        elevation = range_elevation_power(cube, elevation_axis_rad())
    else:
        elevation = np.zeros((*values.shape[:2], 0))
    return PowerMaps(
        range_doppler=_tensor(range_doppler_power(cube)),
        range_azimuth=_tensor(range_azimuth_power(cube, azimuth_axis_rad())),
        range_elevation=_tensor(elevation),
    )


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(values.astype(np.float32))
