"""Training batches of the learned method, sampled from a data set; equal steps give equal batches.

Expected power maps from stored geometry: training targets without speckle and noise fluctuation.

A simulated signal is one random realization in every cell; the simulator's paths give its mean directly.
Reference: docs/decisions/loss-on-mean-power.md.
"""

from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.datasets.dataset_store import StoredRoom, read_rooms
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.image_method import moving_points, static_points
from mmweaver.propagation.mean_power import MeanPower, PowerMaps
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import static_cube
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    has_elevation,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)
from mmweaver.training.device import Share
from mmweaver.training.network_loss import Targets


class ExpectedMaps:
    """Mean power maps of one room of a data set with geometry."""

    def __init__(self, room: StoredRoom):
        """Computes the maps of the static room.

        Args:
            room: Room with geometry.
        """
        assert room.geometry is not None, "signals are stored, not geometry"
        self.room, self.radar = room, _radar(room)
        self.static = self.radar.maps(static_points(room.geometry.room.paths, self.radar.response))

    def frames(self, index: int, frames: np.ndarray) -> tuple[PowerMaps, PowerMaps]:
        """Computes maps of frames of a sequence.

        Args:
            index: Index of the sequence.
            frames: Indices of frames.

        Returns:
            Power maps (frame, range, other) of room, person and noise together, and of the person only.
        """
        person = self.room.body_paths(index, frames)
        both = [self._frame(person, number) for number in range(len(frames))]
        return PowerMaps.stack([whole for whole, _ in both]), PowerMaps.stack([alone for _, alone in both])

    def _frame(self, person: BodyPaths, number: int) -> tuple[PowerMaps, PowerMaps]:
        response = self.radar.response
        segments = person.paths(number)
        moving = self.radar.maps(moving_points(segments[len(segments) // 2], response))
        occluded = self.radar.maps(static_points(person.occluded_paths(number), response))
        names = [field.name for field in fields(PowerMaps)]
        maps = {}
        for name, noise in zip(names, self.radar.noise_maps(), strict=True):
            static = getattr(self.static, name)
            visible = (static - getattr(occluded, name)).clamp(min=0)
            maps[name] = visible + getattr(moving, name) + noise
        return PowerMaps(**maps), moving


_RADARS: dict[str, MeanPower] = {}


def _radar(room: StoredRoom) -> MeanPower:
    """The radar, shared by all rooms of the same configuration."""
    key = room.config.to_json()
    if key not in _RADARS:
        _RADARS[key] = MeanPower(room.config)
    return _RADARS[key]


_OTHER_SIDE = {"left": "right", "right": "left"}
_POINT_X = (1, 5)  # columns of a point's features: position and direction
_PLANE_X = (6,)  # columns of a plane's features: normal


def reflected_scene(scene: SceneTensors) -> SceneTensors:
    """Reflects a scene at the plane x = 0.

    Args:
        scene: Scene tensors.

    Returns:
        The reflected scene, including image, camera, points and planes.
    """
    flip = scene.point_m.new_tensor([-1.0, 1.0, 1.0])
    camera = scene.camera.clone()
    camera[..., 2] = scene.image.shape[-1] - 1 - camera[..., 2]
    return replace(
        scene,
        image=scene.image.flip(-1),
        depth_m=scene.depth_m.flip(-1),
        point_m=scene.point_m * flip,
        point_features=_negated(scene.point_features, _POINT_X),
        camera_from_radar=scene.camera_from_radar * flip * flip[:, None],
        camera_m=scene.camera_m * flip,
        camera=camera,
        plane_centre_m=scene.plane_centre_m * flip,
        plane_axes=scene.plane_axes * flip,
        plane_features=_negated(scene.plane_features, _PLANE_X),
    )


def reflected_joints(joints: Tensor) -> Tensor:
    """Reflects a person at the plane x = 0.

    Args:
        joints: Positions or velocities, (..., 22, 3).

    Returns:
        The reflected ones, with left and right joints swapped.
    """
    order = [JOINT_NAMES.index(_other(name)) for name in JOINT_NAMES]
    return joints[..., order, :] * joints.new_tensor([-1.0, 1.0, 1.0])


def reflected_targets(targets: Targets) -> Targets:
    """Reverses azimuth in the targets; range, Doppler and elevation are unchanged.

    Args:
        targets: Target maps.

    Returns:
        The reflected targets.
    """
    person = None if targets.person is None else _azimuth_flipped(targets.person)
    return Targets(maps=_azimuth_flipped(targets.maps), static=_azimuth_flipped(targets.static), person=person)


def _azimuth_flipped(maps: PowerMaps) -> PowerMaps:
    return replace(maps, range_azimuth=maps.range_azimuth.flip(-1))


def _negated(features: Tensor, columns: tuple[int, ...]) -> Tensor:
    sign = torch.ones(features.shape[-1], device=features.device)
    sign[list(columns)] = -1
    return features * sign


def _other(name: str) -> str:
    side, _, part = name.partition("_")
    return f"{_OTHER_SIDE[side]}_{part}" if side in _OTHER_SIDE else name


@dataclass(frozen=True, kw_only=True)
class NetworkBatch:
    """Rooms, entire motions, and power maps of some of their frames."""

    scene: SceneTensors
    joints_m: Tensor  # (sequence, frame, 22, 3), all frames
    velocity_mps: Tensor  # (sequence, frame, 22, 3)
    frames: Tensor  # (sequence, sampled) frame indices
    targets: Targets


class RoomExamples:
    """One stored room: its scene tensors, and the sequences of one split."""

    def __init__(self, room: StoredRoom, split: str):
        self.room = room
        self.indices = [index for index, name in enumerate(room.split) if name == split]

    @cached_property
    def scene(self) -> SceneTensors:
        """The room as at inference, reconstructed from its photo."""
        geometry = self.room.geometry
        reconstructed = reconstruct(self.room.photo)
        return SceneTensors.of(reconstructed, self.room.config, None if geometry is None else geometry.photographed)

    def maps(self, index: int, frames: np.ndarray) -> tuple[PowerMaps, PowerMaps | None]:
        """Power maps of frames of a sequence.

        Stored signals give the maps of one realization, stored geometry the mean over realizations.

        Args:
            index: Index of the sequence.
            frames: Indices of frames.

        Returns:
            Maps (frame, range, other), and those of the person only if geometry is stored.
        """
        if self._expected is not None:
            return self._expected.frames(index, frames)
        cube = self.room.cube(index, frames)
        return power_maps(cube.values, cube.config), None

    @cached_property
    def static(self) -> PowerMaps:
        """Power maps (range, other) of the room without a person."""
        if self._expected is not None:
            return self._expected.static
        return power_maps(static_cube(self.room.static, self.room.config).values, self.room.config)[0]

    @cached_property
    def _expected(self) -> ExpectedMaps | None:
        return None if self.room.geometry is None else ExpectedMaps(self.room)


def examples(folder: Path, split: str) -> list[RoomExamples]:
    """Loads the rooms of a data set that have sequences of a split.

    Args:
        folder: The data set.
        split: Name of the split.

    Returns:
        The rooms.

    Raises:
        InputError: If there are none.
    """
    device = "cuda" if torch.cuda.is_available() else "cpu"
    rooms = [RoomExamples(room, split) for room in read_rooms(folder, device=device)]
    rooms = [room for room in rooms if room.indices]
    if not rooms:
        raise InputError(
            f"{folder} has no sequences of split {split!r}; make a larger set, such as mmweaver dataset --layouts 10"
        )
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
    """Samples a batch of sequences from different rooms.

    Args:
        rooms: The rooms.
        seed: Seed of the run.
        step: Step of the training.
        size: Number of sequences, over all processes.
        frames: Number of frames sampled from each sequence.
        share: Rank and number of processes. Default: a single process.
        mirror: Whether every second batch, on average, is reflected left-right. Default: False.

    Returns:
        The part of the batch that belongs to this process.
    """
    rng = stream(seed, "batch", step)
    chosen = rng.choice(len(rooms), size=size, replace=len(rooms) < size)
    scenes, joints, velocity, sampled, maps, static = [], [], [], [], [], []
    alone: list[PowerMaps | None] = []
    for number, which in enumerate(chosen):
        one = rooms[int(which)]
        index = one.indices[int(rng.integers(len(one.indices)))]
        length = len(one.room.joints_m[index])
        some = np.sort(rng.choice(length, size=min(frames, length), replace=False))
        if number % share[1] != share[0]:
            continue
        scenes.append(one.scene)
        joints.append(torch.from_numpy(one.room.joints_m[index]))
        velocity.append(torch.from_numpy(one.room.joint_velocity_mps[index]))
        sampled.append(torch.from_numpy(some))
        whole, person = one.maps(index, some)
        maps.append(whole)
        alone.append(person)
        static.append(one.static)
    batch = NetworkBatch(
        scene=SceneTensors.stack(scenes),
        joints_m=torch.stack(joints),
        velocity_mps=torch.stack(velocity),
        frames=torch.stack(sampled),
        targets=Targets(maps=PowerMaps.stack(maps), static=PowerMaps.stack(static), person=_all_or_none(alone)),
    )
    return _reflected(batch) if mirror and rng.random() < 0.5 else batch


def _all_or_none(maps: list[PowerMaps | None]) -> PowerMaps | None:
    known = [one for one in maps if one is not None]
    return PowerMaps.stack(known) if len(known) == len(maps) else None


def _reflected(batch: NetworkBatch) -> NetworkBatch:
    return replace(
        batch,
        scene=reflected_scene(batch.scene),
        joints_m=reflected_joints(batch.joints_m),
        velocity_mps=reflected_joints(batch.velocity_mps),
        targets=reflected_targets(batch.targets),
    )


def power_maps(values: np.ndarray, config: RadarConfig) -> PowerMaps:
    """Computes the power maps of a cube.

    Args:
        values: Cube, (frame, range, doppler, antenna).
        config: The radar.

    Returns:
        Power maps (frame, range, other); elevation is empty for arrays without elevation.
    """
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
