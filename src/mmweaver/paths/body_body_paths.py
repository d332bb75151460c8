"""Second-order paths between two people: radar -> part of one -> part of the other -> radar, in either order.

Power of one order gain^2 sigma_a sigma_b / (4 pi (d_a d_ab d_b)^2) with bistatic cross sections; both are coherent. It
is the equation of `body_room_paths` with a second body for the patch. Reference: docs/radar_primer.md, section 5.
"""

from dataclasses import dataclass

import numpy as np
import torch

from mmweaver.core.seeding import stream
from mmweaver.paths.body_room_paths import FAINTEST_OF_DIRECT, NEAREST_M, ROOM_MARGIN_M, BodyRoomPaths, unit
from mmweaver.paths.paths import ApparentPoint, Interaction, Paths
from mmweaver.paths.room_patches import roulette

MOST_PAIRS = 32  # of parts in a frame


@dataclass(frozen=True, kw_only=True)
class _PartPairs:
    """The chosen pairs of one frame."""

    first: np.ndarray  # (pair,) part of the one person
    second: np.ndarray  # (pair,) of the other
    amplitude: np.ndarray  # (pair,) complex


class BodyBodyPaths:
    """Paths over two people, frame by frame."""

    def __init__(self, first: BodyRoomPaths, second: BodyRoomPaths):
        self.first, self.second = first, second
        rng = stream(first.room.micro_seed, "room", "between people")
        drawn = rng.random((len(first.phase), len(second.phase)))
        self._luck = np.triu(drawn) + np.triu(drawn, 1).T  # whoever is named first
        frames, every = range(first.of.num_frames), first.sampling.every
        pairs = {frame: self._pairs(frame) for frame in frames[::every]}
        self.pairs = [pairs[frame - frame % every] for frame in frames]

    def paths(self, frames: slice) -> Paths:
        """Paths (frame * segment, path) of frames between two at which amplitudes are computed."""
        pairs = self.pairs[frames.start]
        a = self.first.parts(frames)[:, pairs.first]
        b = self.second.parts(frames)[:, pairs.second]
        shape = a.shape[:2]
        return Paths(
            amplitude=torch.from_numpy(pairs.amplitude.astype(np.complex64)).expand(shape),
            departure=ApparentPoint.of(a),
            arrival=ApparentPoint.of(_radial(b, b - a)[..., None] * unit(b[:, :, 0])[..., None, :]),
            is_reciprocal=torch.ones(shape, dtype=torch.bool),
            interaction=torch.full(shape, int(Interaction.BODY_BODY), dtype=torch.uint8),
        )

    def _pairs(self, frame: int) -> _PartPairs:
        own, others = self.first, self.second
        one, other = own.of, others.of
        a_m, b_m = own.middles_m(frame), others.middles_m(frame)
        leg_m = np.maximum(np.linalg.norm(a_m[:, None] - b_m, axis=2), NEAREST_M)
        sigma = own.bistatic(frame, b_m) * others.bistatic(frame, a_m).T
        level = one.gain * np.outer(one.pattern(unit(a_m)), other.pattern(unit(b_m)))
        distance_m = np.outer(np.linalg.norm(a_m, axis=1), np.linalg.norm(b_m, axis=1)) * leg_m
        power = level**2 * sigma / (4 * np.pi * distance_m**2)
        power *= own.room.is_clear(a_m[:, None], b_m[None], ROOM_MARGIN_M)
        if power.sum() < FAINTEST_OF_DIRECT * (one.direct_power[frame] + other.direct_power[frame]):
            power = np.zeros_like(power)
        pair, standing_for = roulette(power.ravel(), self._luck.ravel(), MOST_PAIRS)
        first, second = np.unravel_index(pair, power.shape)
        size = np.sqrt(power.ravel()[pair] * standing_for)
        return _PartPairs(first=first, second=second, amplitude=size * own.phase[first] * others.phase[second])


def _radial(part: np.ndarray, leg: np.ndarray) -> np.ndarray:
    """Length, rate and acceleration (..., pair, 3) of the way from one person over the other's part to the radar.

    `part` (..., pair, 3, 3) is the other's motion, `leg` that relative to the one's.
    """
    total = np.zeros(part.shape[:-1])
    for way in (part, leg):
        position, velocity, acceleration = (way[..., order, :] for order in range(3))
        length_m = np.maximum(np.linalg.norm(position, axis=-1), 1e-6)
        along = position / length_m[..., None]
        rate = (along * velocity).sum(axis=-1)
        across2 = (velocity**2).sum(axis=-1) - rate**2
        total += np.stack([length_m, rate, (along * acceleration).sum(axis=-1) + across2 / length_m], axis=-1)
    return total
