"""Batches for a hypernetwork of target signal: photos, motions, and patches that favour ranges with activity.

The paper samples 16,384 of the coordinates per step. Its complex SSIM and its perceptual loss compare neighbours, so
whole patches are sampled here: 2 frames of 21 ranges, all 32 Doppler bins and all 12 antennas, 16,128 coordinates of a
sequence. Half of them lie around a range in which something moves, half anywhere.
"""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube
from mmweaver.core.seeding import stream
from mmweaver.datasets.dataset_store import StoredRoom, read_rooms
from mmweaver.inr.inr_field import normalised
from mmweaver.models.hypernetwork import motion_input, unit_sqrt_mw
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.signal.spectra import moving_doppler
from mmweaver.training.device import Share

POINTS, FRAMES = 16_384, 2


@dataclass(frozen=True, kw_only=True)
class SignalBatch:
    """Sequences, each of another room, with a patch of each."""

    image: Tensor  # (sequence, 5, row, column)
    motion: Tensor  # (sequence, frame, 22, 6), all frames
    frames: Tensor  # (sequence, 2) those of the patch
    points: Tensor  # (sequence, range doppler antenna, 3) in [-1, 1], coordinates of the patch
    truth: Tensor  # (sequence, 2, range, doppler, antenna) complex, in the network's unit
    span: Tensor  # (sequence,) data range of these two frames, in the network's unit


class SignalRoomExamples:
    """One stored room: its photo as the network gets it, and the sequences of one split."""

    def __init__(self, room: StoredRoom, split: str):
        self.room = room
        self.indices = [index for index, name in enumerate(room.split) if name == split]

    @cached_property
    def image(self) -> Tensor:
        """(5, row, column): colour, depth and classes of the reconstructed room."""
        geometry = self.room.geometry
        photographed = None if geometry is None else geometry.photographed
        return SceneTensors.of(reconstruct(self.room.photo), self.room.config, photographed).image


def signal_rooms(folder: Path, split: str, device: str = "cpu") -> list[SignalRoomExamples]:
    """The rooms that have sequences of a split; signals that are not stored are synthesised on `device` when needed.

    Raises InputError where there are none.
    """
    rooms = [SignalRoomExamples(room, split) for room in read_rooms(folder, device=device) if split in room.split]
    if not rooms:
        raise InputError(f"{folder} has no sequences of split {split!r}; make more with: mmweaver dataset")
    return rooms


def sample_signal_batch(
    rooms: list[SignalRoomExamples], seed: int, step: int, *, size: int, share: Share = (0, 1)
) -> SignalBatch:
    """`size` sequences of as many rooms, and of them the share of one process; determined by seed and step."""
    rng = stream(seed, "paper batch", step)
    images, motions, frames, points, truth, span = [], [], [], [], [], []
    for number, which in enumerate(rng.choice(len(rooms), size=size, replace=len(rooms) < size)):
        own = stream(seed, "paper patch", step, number)
        if number % share[1] != share[0]:
            continue
        one = rooms[int(which)]
        index = one.indices[int(own.integers(len(one.indices)))]
        num_frames = len(one.room.joints_m[index])
        chosen = np.sort(own.choice(num_frames, size=FRAMES, replace=num_frames < FRAMES))
        cube, unit = one.room.cube(index, chosen), unit_sqrt_mw(one.room.config)
        first, length = _patch(cube, own)
        joints, velocity = (part[index] for part in (one.room.joints_m, one.room.joint_velocity_mps))
        images.append(one.image)
        motions.append(motion_input(torch.from_numpy(joints), torch.from_numpy(velocity)))
        frames.append(torch.from_numpy(chosen))
        points.append(_points(one.room.config, first, length))
        truth.append(torch.from_numpy(cube.values[:, first : first + length] / np.float32(unit)))
        parts = np.ascontiguousarray(cube.values).view(np.float32)
        span.append(float(parts.max() - parts.min()) / unit)
    return SignalBatch(
        image=torch.stack(images), motion=torch.stack(motions), frames=torch.stack(frames),
        points=torch.stack(points), truth=torch.stack(truth), span=torch.tensor(span),
    )  # fmt: skip


def _patch(cube: RadarCube, rng: np.random.Generator) -> tuple[int, int]:
    """First range and length of the patch; half of the patches lie where the first frame has motion."""
    _, num_ranges, num_loops, num_antennas = cube.values.shape
    length = min(num_ranges, max(1, POINTS // (FRAMES * num_loops * num_antennas)))
    middle = int(rng.integers(num_ranges))
    moving = np.flatnonzero((active_mask(cube.values) & moving_doppler(cube))[0].any(axis=-1))
    if rng.random() < 0.5 and len(moving):
        middle = int(moving[rng.integers(len(moving))])
    return int(np.clip(middle - length // 2, 0, num_ranges - length)), length


def _points(config: RadarConfig, first: int, length: int) -> Tensor:
    """Coordinates of some ranges, all Doppler bins and all antennas, (point, 3)."""
    sizes = (config.num_range_bins, config.num_loops, config.num_antennas)
    r, d, a = (normalised(np.arange(float(num)), num) for num in sizes)
    return torch.cartesian_prod(r[first : first + length], d, a)
