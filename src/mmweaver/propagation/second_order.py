"""Second-order paths of people: body and rough surfaces of the room, body-radar-body, and two bodies.

The path radar - body part - patch of the room - radar has a power gain^2 sigma_b sigma_q / (4 pi (d_b d_bq d_q)^2)
in either direction of travel; both are coherent. Between two people a part of the other body replaces the patch. A part
represents its skin points with their bistatic cross section. Some thousand pairs are thinned by Russian roulette, which
keeps the mean power. Reference: docs/radar_primer.md, section 5.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from mmweaver.core.body_capsules import CAPSULES, Capsule, part_of
from mmweaver.core.rotations import unit
from mmweaver.core.seeding import stream
from mmweaver.propagation.antenna import pattern
from mmweaver.propagation.paths import Interaction, Paths
from mmweaver.propagation.room_patches import roulette, sampled_pairs

if TYPE_CHECKING:
    from mmweaver.propagation.visible_body import VisibleBody

MIN_RANGE_M = 0.15  # minimum distance from a body part to a patch: the radar equation does not hold on contact
ROOM_MARGIN_M = 0.06
MAX_BODY_PAIRS = 32  # of parts of two people, per frame
MIN_DIRECT_SHARE = 1e-6  # pairs of a frame, or body-radar-body, below this share of the direct power are omitted
# The radar as a scatterer: an evaluation board of 7 cm by 7 cm that returns half of the power diffusely.
BOARD_AREA_M2, BOARD_REFLECTIVITY = 0.07**2, 0.5


def body_part_of_capsule() -> np.ndarray:
    """Index (capsule,) of the body part of each capsule; limbs are separate by side."""
    names = [_part_name(capsule) for capsule in CAPSULES]
    known = sorted(set(names))
    return np.array([known.index(name) for name in names])


def _part_name(capsule: Capsule) -> str:
    kind = part_of(capsule.end)
    if kind in ("elbow", "wrist", "knee", "ankle", "foot"):
        return capsule.end.replace("foot", "ankle")
    return "lower trunk" if capsule.start in ("pelvis", "spine1") or kind == "hip" else "upper trunk"


@dataclass(frozen=True, kw_only=True)
class PairSampling:
    """How many second-order paths represent all. Mean powers do not depend on it."""

    most_pairs: int = 48  # of body part and patch, per frame
    most_patches: int = 200  # from which those pairs are selected
    every: int = 1  # amplitudes are computed every so many frames, and kept in between


@dataclass(frozen=True, kw_only=True)
class Pairs:
    """The selected pairs of one frame."""

    first: np.ndarray  # (pair,) part of the body
    second: np.ndarray  # (pair,) patch of the room, or part of the other body
    amplitude: np.ndarray  # (pair,) complex


class BodyRoomPaths:
    """Second-order paths of one person, frame by frame."""

    def __init__(self, seen: "VisibleBody", sampling: PairSampling | None = None):
        """Selects pairs and computes their amplitudes.

        Args:
            seen: The person as seen by the radar.
            sampling: How many pairs are kept; by default `PairSampling()`.
        """
        self.seen, self.room, self.sampling = seen, seen.traced, sampling or PairSampling()
        self.patches = self.room.patches_all_round
        _, group = np.unique(body_part_of_capsule()[seen.body.part], return_inverse=True)
        self._one_hot = np.eye(group.max() + 1)[:, group]
        # a part is at the mean of its visible skin, or of all its skin where none is visible; (frame, part, point)
        shown = self._one_hot * (seen.visible[:, None] + 1e-6)
        self._members = shown / shown.sum(axis=2, keepdims=True)
        self.phase = seen.body.micro_phase[self._one_hot.argmax(axis=1)]
        rng = stream(self.room.micro_seed, "room", "second bounces")
        self._patch_luck = rng.random(len(self.patches))
        self._pair_luck = rng.random((len(self._one_hot), len(self.patches)))
        self._patch_gain = pattern(unit(self.patches.place_m), self.room.config)
        self._patch_m = np.linalg.norm(self.patches.place_m, axis=1)
        power, every = seen.direct_power, self.sampling.every
        self.pairs = [self._pairs(frame, power[frame]) for frame in range(0, seen.num_frames, every)]
        self.echoes = [self._radar_echoes(frame, power[frame]) for frame in range(0, seen.num_frames, every)]

    def paths(self, frames: slice) -> Paths:
        """All second-order paths of the person.

        Args:
            frames: Frames within one period of `PairSampling.every`.

        Returns:
            Paths (frame * segment, path).
        """
        return Paths.cat([self.room_paths(frames), self.radar_paths(frames)], dim=1)

    def room_paths(self, frames: slice) -> Paths:
        """Paths over patches of the room, in both directions of travel, (frame * segment, path)."""
        pairs = self.pairs[frames.start // self.sampling.every]
        body, place_m = self.parts(frames)[:, pairs.first], self.patches.place_m[pairs.second]
        leg = body.copy()
        leg[:, :, 0] -= place_m
        radial = radial_motion(leg)
        radial[..., 0] += self._patch_m[pairs.second]
        arrival = radial[..., None] * unit(place_m)[:, None]
        return Paths.of(pairs.amplitude, body, arrival, Interaction.BODY_ROOM, is_reciprocal=True)

    def radar_paths(self, frames: slice) -> Paths:
        """Paths body - radar - body, (frame * segment, path)."""
        amplitude = self.echoes[frames.start // self.sampling.every]
        there = np.flatnonzero(amplitude)
        ends = 2 * self.parts(frames)[:, there]
        return Paths.of(amplitude[there], ends, ends, Interaction.BODY_RADAR_BODY)

    def parts(self, frames: slice) -> np.ndarray:
        """Motion (frame * segment, part, 3, 3) of the body parts: the mean over their skin points."""
        motion = self.seen.posed.motion[frames]
        parts = self._members[frames, None] @ motion.reshape(*motion.shape[:3], 9)
        return parts.reshape(-1, parts.shape[2], 3, 3)

    def middles_m(self, frame: int) -> np.ndarray:
        """Positions (part, 3) of the body parts at the middle of a frame."""
        return self._members[frame] @ self.seen.posed.place_m[frame]

    def _pairs(self, frame: int, direct_power: float) -> Pairs:
        """The selected pairs of one frame."""
        seen, parts_m = self.seen, self.middles_m(frame)
        middle_m = seen.posed.place_m[frame].mean(axis=0)
        gap_m = np.maximum(np.linalg.norm(self.patches.place_m - middle_m, axis=1), 2 * MIN_RANGE_M)
        level = self.patches.cross_section_m2 * (self._patch_gain / (self._patch_m * gap_m)) ** 2
        near, standing_for = roulette(level, self._patch_luck, self.sampling.most_patches)
        some = self.patches[near]
        clear = self.room.is_clear(np.broadcast_to(middle_m, some.place_m.shape), some.place_m, ROOM_MARGIN_M)
        near, some, standing_for = near[clear], some[clear], standing_for[clear]
        leg = some.place_m - parts_m[:, None]  # (part, patch, 3)
        leg_m = np.maximum(np.linalg.norm(leg, axis=2), MIN_RANGE_M)
        sigma = self.bistatic(frame, some.place_m)  # (part, patch)
        power = seen.gain**2 * (seen.pattern(unit(parts_m))[:, None] * self._patch_gain[near]) ** 2 * sigma
        power = power * some.cross_sections(-leg / leg_m[..., None]) / (4 * np.pi)
        power *= standing_for / (np.linalg.norm(parts_m, axis=1)[:, None] * leg_m * self._patch_m[near]) ** 2
        power *= power.sum() >= MIN_DIRECT_SHARE * direct_power
        part, patch, size = sampled_pairs(power, self._pair_luck[:, near], self.sampling.most_pairs)
        amplitude = size * self.phase[part] * self.patches.phase[near[patch]]
        return Pairs(first=part, second=near[patch], amplitude=amplitude)

    def bistatic(self, frame: int, place_m: np.ndarray) -> np.ndarray:
        """Bistatic cross sections of the body parts between the radar and places.

        All skin points are summed: with lobes of 6 degrees a few dozen points would leave most directions without an
        echo.

        Args:
            frame: Index of the frame.
            place_m: Places (place, 3) in metres.

        Returns:
            Cross sections (part, place) in m2.
        """
        seen = self.seen
        shown = np.flatnonzero(seen.visible[frame])
        area_m2 = seen.body.area_m2 * seen.body.brightness[shown]
        skin_m, cos_in = seen.posed.place_m[frame, shown], seen.cos[frame, shown][:, None]
        offset_m2 = (skin_m**2).sum(axis=1)[:, None] + (place_m**2).sum(axis=1) - 2 * skin_m @ place_m.T
        leg_m = np.sqrt(np.maximum(offset_m2, 1e-12))  # (point, place)

        def leg_cos(direction: np.ndarray) -> np.ndarray:
            """Cosine (point, place) between a direction (point, 3) and the leg to each place."""
            return (direction @ place_m.T - (direction * skin_m).sum(axis=1)[:, None]) / leg_m

        cos_out = leg_cos(seen.posed.normal[frame, shown])
        # |towards + out|^2 = 2 + 2 towards . out
        half = np.sqrt(np.maximum(2 + 2 * leg_cos(seen.towards[frame, shown]), 1e-9))
        each = seen.body.echo.bistatic(cos_in, cos_out, (cos_in + cos_out) / half)
        return (self._one_hot[:, shown] * area_m2) @ each

    def _radar_echoes(self, frame: int, direct_power: float) -> np.ndarray:
        """Amplitudes (part,) of echoes that the radar's own board returns to the body; 0 where negligible."""
        seen, body = self.seen, self.seen.body
        # with the distance of each skin point: within arm's reach those of the parts' centres halve the echo
        sigma = body.echo.monostatic(seen.cos[frame]) * body.area_m2 * body.brightness * seen.visible[frame]
        each = self._one_hot @ (sigma / seen.distance_m[frame] ** 4)
        towards = unit(self.middles_m(frame))
        board = 4 * BOARD_REFLECTIVITY * BOARD_AREA_M2 * np.maximum(towards[:, 1], 0.0) ** 2
        level = seen.gain * seen.pattern(towards) ** 2
        amplitude = level * np.sqrt(each * each.sum() * board) / (4 * np.pi) * self.phase**2
        return np.where(np.abs(amplitude) ** 2 > MIN_DIRECT_SHARE * direct_power, amplitude, 0.0)


class BodyBodyPaths:
    """Paths over two people, frame by frame."""

    def __init__(self, first: BodyRoomPaths, second: BodyRoomPaths):
        """Selects pairs of body parts.

        Args:
            first: Second-order paths of one person.
            second: Those of the other, with the same room and frames.
        """
        self.first, self.second = first, second
        rng = stream(first.room.micro_seed, "room", "between people")
        luck = rng.random((len(first.phase), len(second.phase)))
        self._luck = np.triu(luck) + np.triu(luck, 1).T  # symmetric, independent of the order of the people
        self.pairs = [self._pairs(frame) for frame in range(0, first.seen.num_frames, first.sampling.every)]

    def paths(self, frames: slice) -> Paths:
        """Paths over both people.

        Args:
            frames: Frames within one period of `PairSampling.every`.

        Returns:
            Paths (frame * segment, path), reciprocal.
        """
        pairs = self.pairs[frames.start // self.first.sampling.every]
        a, b = self.first.parts(frames)[:, pairs.first], self.second.parts(frames)[:, pairs.second]
        # apparent arrival: the leg between both bodies and on to the radar
        arrival = (radial_motion(b) + radial_motion(b - a))[..., None] * unit(b[:, :, 0])[..., None, :]
        return Paths.of(pairs.amplitude, a, arrival, Interaction.BODY_BODY, is_reciprocal=True)

    def _pairs(self, frame: int) -> Pairs:
        one, other = self.first, self.second
        a_m, b_m = one.middles_m(frame), other.middles_m(frame)
        leg_m = np.maximum(np.linalg.norm(a_m[:, None] - b_m, axis=2), MIN_RANGE_M)
        sigma = one.bistatic(frame, b_m) * other.bistatic(frame, a_m).T
        level = one.seen.gain * np.outer(one.seen.pattern(unit(a_m)), other.seen.pattern(unit(b_m)))
        distance_m = np.outer(np.linalg.norm(a_m, axis=1), np.linalg.norm(b_m, axis=1)) * leg_m
        power = level**2 * sigma / (4 * np.pi * distance_m**2)
        power *= one.room.is_clear(a_m[:, None], b_m[None], ROOM_MARGIN_M)
        direct_power = one.seen.direct_power[frame] + other.seen.direct_power[frame]
        power *= power.sum() >= MIN_DIRECT_SHARE * direct_power
        first, second, size = sampled_pairs(power, self._luck, MAX_BODY_PAIRS)
        return Pairs(first=first, second=second, amplitude=size * one.phase[first] * other.phase[second])


def radial_motion(motion: np.ndarray) -> np.ndarray:
    """Length of moving vectors, and its first two derivatives.

    Args:
        motion: Position, velocity and acceleration (..., 3, 3), along the last but one axis.

    Returns:
        Length, rate and acceleration (..., 3).
    """
    position, velocity, acceleration = (motion[..., order, :] for order in range(3))
    length_m = np.maximum(np.linalg.norm(position, axis=-1), 1e-6)
    along = position / length_m[..., None]
    rate = (along * velocity).sum(axis=-1)
    across2 = (velocity**2).sum(axis=-1) - rate**2
    return np.stack([length_m, rate, (along * acceleration).sum(axis=-1) + across2 / length_m], axis=-1)
