"""Batches of recipe `paper_power`: cross sections at places of a field, half of which lie where echoes are."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.core.tensor_record import TensorRecord
from mmweaver.models.power_cells import REACH, REFERENCE, WIDEST, density
from mmweaver.models.power_network import pelvis_of
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.paths.apparent_paths import moving_points, static_points
from mmweaver.paths.mean_echoes import MeanEchoes
from mmweaver.paths.mean_power import MeanPower
from mmweaver.paths.radar_equation import echoes_of, points_of
from mmweaver.training.device import Share
from mmweaver.training.network_examples import RoomExamples
from mmweaver.training.reflection_augmentation import reflected_joints, reflected_scene

ROOM_PLACES, PERSON_PLACES = 3072, 512  # of a room, and of each frame
EMPHASIS = 0.5  # power of the weights that undo the choice of places; 1 undoes it, 0 leaves it
CHOICE = 0.25  # power of an echo's strength by which places are chosen
FLOOR_OF_NOISE, FLOOR_OF_PEAK = 0.02, 1e-6  # powers below are all the same


@dataclass(frozen=True, kw_only=True)
class FieldTargets(TensorRecord):
    """What a field holds at some places; powers are those received, mW, from a reference cell."""

    at: Tensor  # (..., place, 3 or 4) range, [velocity,] direction cosines
    power_mw: Tensor  # (..., place)
    gain_mw: Tensor  # (..., place) power from a square metre there
    least_mw: Tensor  # (..., 1)
    weight: Tensor  # (..., place)


@dataclass(frozen=True, kw_only=True)
class PowerBatch:
    """Rooms, whole motions, and their fields at some places."""

    scene: SceneTensors
    joints_m: Tensor  # (sequence, frame, 22, 3), all frames
    velocity_mps: Tensor  # (sequence, frame, 22, 3)
    frames: Tensor  # (sequence, sampled) indices of frames
    room: FieldTargets  # (sequence, ...)
    person: FieldTargets  # (sequence, sampled, ...)


class PowerExamples(RoomExamples):
    """A stored room with its echoes."""

    @cached_property
    def echoes(self) -> MeanEchoes:
        """Those of the room without people, (echo,)."""
        if self.room.geometry is None:
            raise InputError(
                f"{self.room.folder} stores signals, not echoes; recipe paper_power needs a data set made with"
                " --geometry-only"
            )
        response = radar_of(self.room.config).response
        return echoes_of(static_points(self.room.geometry.room.paths, response), response)

    def person_echoes(self, index: int, frames: np.ndarray) -> list[MeanEchoes]:
        """Those of the person and their ghosts in each of some frames, (echo,)."""
        response, body = radar_of(self.room.config).response, self.room.body_paths(index, frames)
        segments = [body.paths(number) for number in range(len(frames))]
        return [echoes_of(moving_points(each[len(each) // 2], response), response) for each in segments]


@lru_cache(maxsize=4)
def _radar(text: str) -> MeanPower:
    return MeanPower(RadarConfig.from_json(text))


def radar_of(config: RadarConfig) -> MeanPower:
    """The radar of a configuration, made once."""
    return _radar(config.to_json())


def sample_power_batch(
    rooms: list[PowerExamples], seed: int, step: int, *, size: int, frames: int, share: Share = (0, 1),
    mirror: bool = False,
) -> PowerBatch:  # fmt: skip
    """`size` sequences of different rooms, `frames` frames of each; the share of one process of them.

    With `mirror`, every second batch is reflected left-right. Determined by seed and step.
    """
    rng = stream(seed, "power batch", step)
    chosen = rng.choice(len(rooms), size=size, replace=len(rooms) < size)
    is_mirrored = mirror and rng.random() < 0.5
    scenes, motions, sampled, at_rest, moving = [], [], [], [], []
    for number, which in enumerate(chosen):
        own, one = stream(seed, "power places", step, number), rooms[int(which)]
        if number % share[1] != share[0]:
            continue
        index = one.indices[int(own.integers(len(one.indices)))]
        length = len(one.room.joints_m[index])
        some = np.sort(own.choice(length, size=min(frames, length), replace=False))
        joints, velocity = (torch.from_numpy(part[index]) for part in (one.room.joints_m, one.room.joint_velocity_mps))
        pelvis = pelvis_of(joints, velocity)[some]
        scenes.append(one.scene)
        motions.append(torch.stack([joints, velocity]))
        sampled.append(torch.from_numpy(some))
        radar = radar_of(one.room.config)
        at_rest.append(room_targets(one.echoes, radar, own))
        each = zip(one.person_echoes(index, some), pelvis, strict=True)
        moving.append(FieldTargets.stack([person_targets(echoes, place, radar, own) for echoes, place in each]))
    joints, velocity = torch.stack(motions).unbind(1)
    batch = PowerBatch(
        scene=SceneTensors.stack(scenes), joints_m=joints, velocity_mps=velocity, frames=torch.stack(sampled),
        room=FieldTargets.stack(at_rest), person=FieldTargets.stack(moving),
    )  # fmt: skip
    return _reflected(batch) if is_mirrored else batch


def room_targets(echoes: MeanEchoes, radar: MeanPower, rng: np.random.Generator) -> FieldTargets:
    """A room's field at ROOM_PLACES nodes of a raster of half cells with a random offset."""
    received = points_of(echoes, radar.response).amplitude.square()
    ranges, size = radar.config.range_m, np.array(REFERENCE)[[0, 2, 3]]
    low = np.array([float(ranges[0]) - size[0], -1.0, -1.0]) + size / 2 * rng.random(3)
    shape = tuple(np.ceil((np.array([float(ranges[-1]) + size[0], 1.0, 1.0]) - low) / (size / 2)).astype(int).tolist())
    place = torch.stack([echoes.range_m, *echoes.direction.unbind(-1)], -1).double().numpy()
    values = np.stack([echoes.cross_section_m2.double().numpy(), received.double().numpy() ** CHOICE])
    section, near = raster_density(place, values, low, size, shape)
    chance = 0.5 / near.size + 0.5 * near / max(near.sum(), 1e-300)
    chosen = rng.choice(near.size, size=ROOM_PLACES, p=chance / chance.sum())
    node = np.stack(np.unravel_index(chosen, shape), -1)
    at = torch.from_numpy(low + node * size / 2).float()
    inside = at[:, 1:].square().sum(-1) < WIDEST
    weight = torch.from_numpy((chance[chosen] * near.size) ** -EMPHASIS).float() * inside
    whole = torch.stack([at[:, 0], torch.zeros_like(at[:, 0]), at[:, 1], at[:, 2]], -1)
    return _received(whole, torch.from_numpy(section[chosen]).float(), weight, received, radar, at)


def raster_density(
    place: np.ndarray, values: np.ndarray, low: np.ndarray, size: np.ndarray, shape: tuple[int, ...]
) -> tuple[np.ndarray, ...]:
    """Values (kind, echo) at places (echo, 3), shared out by tents of `size` to nodes half a size apart from `low` on.

    Returns (node,) of each kind, in row order of `shape`; what lies beyond is lost.
    """
    at = (place - low) / (size / 2)
    node = np.floor(at).astype(np.int64)[:, :, None] + np.arange(-1, 3)  # (echo, axis, near node)
    share = np.maximum(1 - np.abs(node - at[:, :, None]) / 2, 0) * ((node >= 0) & (node < np.array(shape)[:, None]))
    node = np.clip(node, 0, np.array(shape)[:, None] - 1)
    index = (node[:, 0, :, None, None] * shape[1] + node[:, 1, None, :, None]) * shape[2] + node[:, 2, None, None]
    tent = share[:, 0, :, None, None] * share[:, 1, None, :, None] * share[:, 2, None, None]
    count = int(np.prod(shape))
    flat, tent = index.ravel(), tent.reshape(len(place), -1)
    return tuple(np.bincount(flat, (tent * each[:, None]).ravel(), minlength=count) for each in values)


def person_targets(echoes: MeanEchoes, pelvis: Tensor, radar: MeanPower, rng: np.random.Generator) -> FieldTargets:
    """A person's field at PERSON_PLACES places of the box about the pelvis (4,)."""
    reach = torch.tensor([*REACH, 1.0])
    middle = torch.cat([pelvis[:3], pelvis.new_zeros(1)])
    return _targets(echoes, radar, middle - reach, middle + reach, PERSON_PLACES, rng)


def _targets(
    echoes: MeanEchoes, radar: MeanPower, low: Tensor, high: Tensor, count: int, rng: np.random.Generator
) -> FieldTargets:
    """The field in a box at `count` places: half of them anywhere, half within a cell of an echo."""
    received = points_of(echoes, radar.response).amplitude.square()
    own = torch.stack([echoes.range_m, echoes.velocity_mps, *echoes.direction.unbind(-1)], -1)
    chance = received.double() ** CHOICE * ((own >= low) & (own <= high)).all(-1)
    chance = chance / chance.sum().clamp(min=1e-30)
    anywhere = low + (high - low) * torch.from_numpy(rng.random((count, 4))).float()
    at = anywhere
    if float(chance.sum()) > 0.5:
        around = torch.from_numpy(rng.choice(len(own), size=count // 2, p=chance.numpy() / float(chance.sum())))
        step = torch.from_numpy(rng.uniform(-1, 1, (count // 2, 4))).float() * torch.tensor(REFERENCE)
        at = torch.cat([anywhere[: count - count // 2], own[around] + step])
    section, near = density(echoes, at, chance.float())
    # how likely a place is to be chosen, over how likely it would be anywhere
    volume = ((high - low) / torch.tensor(REFERENCE) / 2).prod()
    inside = ((at >= low) & (at <= high)).all(-1) & (at[:, 2:].square().sum(-1) < WIDEST)
    weight = (0.5 + 0.5 * near * volume) ** -EMPHASIS * inside
    return _received(at, section, weight, received, radar, at)


def _received(
    place: Tensor, section: Tensor, weight: Tensor, received: Tensor, radar: MeanPower, at: Tensor
) -> FieldTargets:
    """Targets of cross sections (place,) at places (place, 4), which are given as `at`."""
    gain = points_of(_square_metres(place), radar.response).amplitude.square()
    return FieldTargets(
        at=at, power_mw=section * gain, gain_mw=gain, weight=weight,
        least_mw=(FLOOR_OF_NOISE * radar.noise + FLOOR_OF_PEAK * received.max())[None],
    )  # fmt: skip


def _square_metres(at: Tensor) -> MeanEchoes:
    return MeanEchoes(
        range_m=at[:, 0], velocity_mps=at[:, 1], direction=at[:, 2:], cross_section_m2=torch.ones_like(at[:, 0])
    )


def _reflected(batch: PowerBatch) -> PowerBatch:
    def other_side(targets: FieldTargets) -> FieldTargets:
        sign = torch.ones(targets.at.shape[-1])
        sign[-2] = -1
        return replace(targets, at=targets.at * sign)

    return replace(
        batch, scene=reflected_scene(batch.scene), joints_m=reflected_joints(batch.joints_m),
        velocity_mps=reflected_joints(batch.velocity_mps), room=other_side(batch.room), person=other_side(batch.person),
    )  # fmt: skip
