"""Recordings generated to train a recogniser: motions in rooms seen in photos, and what makes signals of them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence, RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_plan import ACTIVITIES, PEOPLE_HEIGHT_M, SequenceSpec
from mmweaver.datasets.dataset_store import StoredRoom
from mmweaver.datasets.room_generation import pose_of
from mmweaver.models.activity_network import ACTIVITY_NAMES
from mmweaver.models.frame_motion import MIDDLE_DB, SPREAD_DB, FrameMotion
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.propagation.receiver import IDEAL, Receiver
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.cube import radar_cube
from mmweaver.training.activity_training import compute_log_maps
from studies.network.learned_scores import OTHER

Motion = tuple[str, PoseSequence, "PhotographedRoom"]
Maker = Callable[[Motion, int], RadarCube]  # a motion and a seed


@dataclass(frozen=True)
class PhotographedRoom:
    """A stored room of which its photo alone is used."""

    stored: StoredRoom

    @cached_property
    def scene(self) -> Scene:
        return reconstruct(self.stored.photo)

    @property
    def config(self) -> RadarConfig:
        return self.stored.config

    @property
    def num_frames(self) -> int:
        return self.stored.joints_m.shape[1]


@dataclass(frozen=True, kw_only=True)
class Recordings:
    """Log maps as `ActivityExamples` has them, and labels."""

    doppler: Tensor
    angle: Tensor
    label: Tensor

    def __len__(self) -> int:
        return len(self.label)

    def part(self, chosen: np.ndarray) -> "Recordings":
        """Some of them."""
        index = torch.from_numpy(np.asarray(chosen))
        return Recordings(doppler=self.doppler[index], angle=self.angle[index], label=self.label[index])


def motions(rooms: Sequence[PhotographedRoom], people: Sequence[int], count: int, purpose: str) -> Iterator[Motion]:
    """`count` motions, the activities and rooms in turn, of people at random; those without a place are left out."""
    rng, names = stream(0, "generated recordings", purpose), list(ACTIVITIES)
    for number in range(count):
        activity = names[(number + number // len(rooms)) % len(names)]  # so that no room has one activity alone
        room = rooms[number % len(rooms)]
        spec = SequenceSpec(
            index=number, person=int(rng.choice(people)), activity=activity,
            text=str(rng.choice(ACTIVITIES[activity])), seed=int(rng.integers(2**31)), split="",
        )  # fmt: skip
        try:
            pose = pose_of(spec, room.scene, room.config, room.num_frames)
        except InputError:
            continue
        height_m = PEOPLE_HEIGHT_M[spec.person]
        yield activity, replace(pose, subject=OTHER + spec.person, height_m=height_m), room


def by_network(network: WeaverNetwork, room_of: Callable[[PhotographedRoom], PhotographedRoom]) -> Maker:
    """The network, in the room that `room_of` says for a motion's own."""
    learned: dict[int, LearnedRoom] = {}

    def make(motion: Motion, seed: int) -> RadarCube:
        _, pose, own = motion
        room = room_of(own)
        if id(room) not in learned:
            learned[id(room)] = LearnedRoom(network, room.scene, room.config, room_seed=1)
        return learned[id(room)].cube([FrameMotion.of(pose, room.config, room.num_frames)], seed=seed)

    return make


def made_by(maker: Maker, found: Sequence[Motion]) -> Recordings:
    """Log maps of what a maker makes of some motions."""
    cubes = (maker(motion, number) for number, motion in enumerate(found))
    return recorded(cubes, found)


def recorded(cubes: Iterator[RadarCube], found: Sequence[Motion]) -> Recordings:
    """Log maps of cubes of motions."""
    doppler, angle = compute_log_maps(cubes, found[0][2].config)
    label = torch.tensor([ACTIVITY_NAMES.index(activity) for activity, *_ in found])
    return Recordings(doppler=doppler, angle=angle, label=label)


def as_loud_with_noise(cubes: list[RadarCube], like: Recordings) -> Iterator[RadarCube]:
    """Cubes of unknown scale with one gain, so that moving echoes have the recordings' mean power, and the noise."""
    _, angle = compute_log_maps(iter(cubes), cubes[0].config)
    gain = np.float32(np.sqrt(_moving_power(like.angle) / _moving_power(angle)))
    for number, cube in enumerate(cubes):
        yield replace(cube, values=cube.values * gain + _noise(cube, number), scale=1.0)


def _moving_power(angle: Tensor) -> float:
    """Mean power of the moving range-azimuth maps over the noise."""
    return float((10 ** ((angle[:, :, 1].float() * SPREAD_DB + MIDDLE_DB) / 10) - 1).mean())


def _noise(cube: RadarCube, seed: int) -> np.ndarray:
    config, frames = cube.config, len(cube.values)
    receiver = Receiver(config, replace(IDEAL, thermal_noise=True), seed=seed)
    shape = (config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    samples = np.stack([receiver.noise(shape, frame) for frame in range(frames)])
    return radar_cube(AdcCube(samples=samples, config=config, scale=1.0)).values
