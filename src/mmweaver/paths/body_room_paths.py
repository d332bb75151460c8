"""Second-order paths of a person: body and rough surfaces of the room in either order, body-radar-body.

Radar -> part of the body -> patch of the room -> radar and back, power gain^2 sigma_b sigma_q / (4 pi (d_b d_bq d_q)^2)
of one order; both are coherent. A part stands for its skin points, with their bistatic cross section. Of some
thousand pairs so many are kept at random, the strong ones always, that the mean power stays.
Reference: docs/radar_primer.md, section 5.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import torch

from mmweaver.core.seeding import stream
from mmweaver.geometry.body_capsules import CAPSULES, Capsule, part_of
from mmweaver.paths.antenna import pattern
from mmweaver.paths.paths import ApparentPoint, Interaction, Paths
from mmweaver.paths.room_patches import roulette

if TYPE_CHECKING:
    from mmweaver.paths.visible_body import VisibleBody

NEAREST_M = 0.15  # from a body part to a patch: nearer ones touch it, where the radar equation does not hold
ROOM_MARGIN_M = 0.06
FAINTEST_OF_DIRECT = 1e-6  # power of a frame's pairs, or of body-radar-body, that is left out
# A radar as what a body's echo meets: an evaluation board of 7 cm by 7 cm, half of whose power comes back, diffusely.
BOARD_AREA_M2, BOARD_REFLECTIVITY = 0.07**2, 0.5


def part_of_capsule() -> np.ndarray:
    """Index of the body part, trunk parts first and limbs by side, of each capsule."""
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
    """How many paths of second order stand for all. Mean powers do not depend on it."""

    most_pairs: int = 48  # of body part and patch in a frame
    most_patches: int = 200  # of which those are chosen
    every: int = 1  # frames are amplitudes computed, and kept in between


@dataclass(frozen=True, kw_only=True)
class _Pairs:
    """The chosen pairs of one frame."""

    part: np.ndarray  # (pair,)
    patch: np.ndarray  # (pair,)
    amplitude: np.ndarray  # (pair,) complex


class BodyRoomPaths:
    """Second-order paths of one person, frame by frame."""

    def __init__(self, seen: "VisibleBody", sampling: PairSampling | None = None):
        self.of, self.room, self.sampling = seen, seen.traced, sampling or PairSampling()
        self.patches = self.room.patches_all_round
        _, group = np.unique(part_of_capsule()[self.of.body.part], return_inverse=True)
        one_hot = np.eye(group.max() + 1)[:, group]
        # a part is where its visible skin is, or all of its skin where none is visible; (frame, part, point)
        shown = one_hot * (seen.visible[:, None] + 1e-6)
        self._members = shown / shown.sum(axis=2, keepdims=True)
        self._of_part = one_hot
        self.phase = self.of.body.micro_phase[one_hot.argmax(axis=1)]
        rng = stream(self.room.micro_seed, "room", "second bounces")
        self._patch_luck = rng.random(len(self.patches))
        self._pair_luck = rng.random((len(one_hot), len(self.patches)))
        self._patch_gain = pattern(unit(self.patches.place_m), self.room.config)
        self._patch_m = np.linalg.norm(self.patches.place_m, axis=1)
        power, frames, every = seen.direct_power, range(seen.num_frames), self.sampling.every
        pairs = {frame: self._pairs(frame, power[frame]) for frame in frames[::every]}
        twice = {frame: self._body_radar_body(frame, power[frame]) for frame in frames[::every]}
        self.pairs = [pairs[frame - frame % every] for frame in frames]
        self.twice = [twice[frame - frame % every] for frame in frames]

    def paths(self, frames: slice) -> Paths:
        """Paths (frame * segment, path) of frames between two at which amplitudes are computed."""
        return Paths.cat([self.over_room(frames), self.over_radar(frames)], dim=1)

    def over_room(self, frames: slice) -> Paths:
        """Those over patches of the room, in either order."""
        pairs = self.pairs[frames.start]
        body = self.parts(frames)[:, pairs.part]
        return self._record(pairs.amplitude, body, self._over(body, pairs.patch), Interaction.BODY_ROOM)

    def over_radar(self, frames: slice) -> Paths:
        """Body, radar, and body again."""
        twice = self.twice[frames.start]
        there = np.flatnonzero(twice)
        ends = 2 * self.parts(frames)[:, there]
        return self._record(twice[there], ends, ends, Interaction.BODY_RADAR_BODY)

    def parts(self, frames: slice) -> np.ndarray:
        """Motion (frame * segment, part, 3, 3) of the parts: the mean of their skin points."""
        motion = self.of.posed.motion[frames]
        parts = self._members[frames, None] @ motion.reshape(*motion.shape[:3], 9)
        return parts.reshape(-1, parts.shape[2], 3, 3)

    def middles_m(self, frame: int) -> np.ndarray:
        """Places (part, 3) of the parts at the middle of a frame."""
        return self._members[frame] @ self.of.posed.place_m[frame]

    def _over(self, body: np.ndarray, patch: np.ndarray) -> np.ndarray:
        """Apparent motion of the end that leads over a patch: its direction, and as far as the body.

        `body` and the result (segment, pair, 3, 3).
        """
        place = self.patches.place_m[patch]
        position, velocity, acceleration = (body[:, :, order] for order in range(3))
        leg = position - place
        leg_m = np.linalg.norm(leg, axis=-1)
        along = leg / leg_m[..., None]
        rate = (along * velocity).sum(axis=-1)
        across2 = (velocity**2).sum(axis=-1) - rate**2
        towards_m = (along * acceleration).sum(axis=-1) + across2 / leg_m
        radial = np.stack([self._patch_m[patch] + leg_m, rate, towards_m], axis=-1)
        return radial[..., None] * unit(place)[:, None]

    def _record(self, amplitude: np.ndarray, departure: np.ndarray, arrival: np.ndarray, kind: Interaction) -> Paths:
        """Paths (segment, path) of amplitudes (path,) and ends (segment, path, 3, 3)."""
        shape = departure.shape[:2]
        return Paths(
            amplitude=torch.from_numpy(amplitude.astype(np.complex64)).expand(shape),
            departure=ApparentPoint.of(departure),
            arrival=ApparentPoint.of(arrival),
            is_reciprocal=torch.full(shape, kind is Interaction.BODY_ROOM),
            interaction=torch.full(shape, int(kind), dtype=torch.uint8),
        )

    def _pairs(self, frame: int, direct_power: float) -> _Pairs:
        """Those of one frame, chosen."""
        of = self.of
        parts_m = self.middles_m(frame)
        middle_m = of.posed.place_m[frame].mean(axis=0)
        gap_m = np.maximum(np.linalg.norm(self.patches.place_m - middle_m, axis=1), 2 * NEAREST_M)
        level = self.patches.cross_section_m2 * (self._patch_gain / (self._patch_m * gap_m)) ** 2
        near, standing_for = roulette(level, self._patch_luck, self.sampling.most_patches)
        some = self.patches[near]
        clear = self.room.is_clear(np.broadcast_to(middle_m, some.place_m.shape), some.place_m, ROOM_MARGIN_M)
        near, some, standing_for = near[clear], some[clear], standing_for[clear]
        leg = some.place_m - parts_m[:, None]  # (part, patch, 3)
        leg_m = np.maximum(np.linalg.norm(leg, axis=2), NEAREST_M)
        sigma = self.bistatic(frame, some.place_m)  # (part, patch)
        power = of.gain**2 * (of.pattern(unit(parts_m))[:, None] * self._patch_gain[near]) ** 2 * sigma
        power = power * some.into(-leg / leg_m[..., None]) / (4 * np.pi)
        power *= standing_for / (np.linalg.norm(parts_m, axis=1)[:, None] * leg_m * self._patch_m[near]) ** 2
        total = power.sum()
        if total < FAINTEST_OF_DIRECT * direct_power:
            none = np.zeros(0, int)
            return _Pairs(part=none, patch=none, amplitude=np.zeros(0, complex))
        pair, standing_for = roulette(power.ravel(), self._pair_luck[:, near].ravel(), self.sampling.most_pairs)
        part, patch = np.unravel_index(pair, power.shape)
        size = np.sqrt(power.ravel()[pair] * standing_for)
        return _Pairs(part=part, patch=near[patch], amplitude=size * self.phase[part] * self.patches.phase[near[patch]])

    def bistatic(self, frame: int, place_m: np.ndarray) -> np.ndarray:
        """Cross sections (part, place) of the body's parts from the radar's direction into those of places (place, 3).

        Of all skin: with lobes of 6 degrees a few dozen points leave most directions without one that shines there.
        """
        of = self.of
        seen = np.flatnonzero(of.visible[frame])
        area_m2 = of.body.area_m2 * of.body.brightness[seen]
        skin_m, cos_in = of.posed.place_m[frame, seen], of.cos[frame, seen][:, None]
        offset_m2 = (skin_m**2).sum(axis=1)[:, None] + (place_m**2).sum(axis=1) - 2 * skin_m @ place_m.T
        leg_m = np.sqrt(np.maximum(offset_m2, 1e-12))  # (point, place)

        def cos_to(direction: np.ndarray) -> np.ndarray:
            """Cosine (point, place) between a direction (point, 3) and the leg to each place."""
            return (direction @ place_m.T - (direction * skin_m).sum(axis=1)[:, None]) / leg_m

        cos_out = cos_to(of.posed.normal[frame, seen])
        # |towards + out|^2 = 2 + 2 towards . out
        half = np.sqrt(np.maximum(2 + 2 * cos_to(of.towards[frame, seen]), 1e-9))
        each = of.body.echo.over(cos_in, cos_out, (cos_in + cos_out) / half)
        return (self._of_part[:, seen] * area_m2) @ each

    def _body_radar_body(self, frame: int, direct_power: float) -> np.ndarray:
        """Amplitudes (part,) of echoes that the radar's own board throws back to the body; 0 where too faint."""
        of, body = self.of, self.of.body
        # skin as near as it is: within arm's reach the parts' middles would be half as strong
        sigma = body.echo.back(of.cos[frame]) * body.area_m2 * body.brightness * of.visible[frame]
        each = self._of_part @ (sigma / of.distance_m[frame] ** 4)
        towards = unit(self.middles_m(frame))
        board = 4 * BOARD_REFLECTIVITY * BOARD_AREA_M2 * np.maximum(towards[:, 1], 0.0) ** 2
        level = of.gain * of.pattern(towards) ** 2
        amplitude = level * np.sqrt(each * each.sum() * board) / (4 * np.pi) * self.phase**2
        return np.where(np.abs(amplitude) ** 2 > FAINTEST_OF_DIRECT * direct_power, amplitude, 0.0)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) of length 1."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-9)
