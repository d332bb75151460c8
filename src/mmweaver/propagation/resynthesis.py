"""ADC samples of prepared rooms and traced motions: the `Simulator` without a ray caster, on any device.

Simulator.trace(pose) -> joints, Visibility -----.
Room -> static_paths_store.room_arrays ----------+--> Resynthesis.samples
"""

from copy import copy
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.motion.physiology import Physiology
from mmweaver.propagation.adc_synthesis import AdcSynthesis
from mmweaver.propagation.body_model import ScatteringBody
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.occlusion import Visibility, people_shadow
from mmweaver.propagation.paths import Paths, ScenePaths
from mmweaver.propagation.ray_traced import add_physiology, leakage_path
from mmweaver.propagation.receiver import Impairments, Receiver
from mmweaver.propagation.static_paths import PreparedRoom
from mmweaver.propagation.static_paths_store import resampled_phases

ROOM_REALIZATIONS = 4  # sets of phases per room; each takes 30 ms and is cached


@dataclass(frozen=True, kw_only=True)
class TracedMotion:
    """A motion whose rays have been cast: joints at the clock's nodes (frame, node, 22, 3), and their visibility."""

    joints_m: np.ndarray
    visibility: Visibility
    subject: int
    height_m: float
    seed: int  # of the micro-motion and of the noise


class Resynthesis:
    """One prepared room and one radar: samples of any traced motion, any frames, and any realization of phases."""

    def __init__(self, room: PreparedRoom, device: str | torch.device = "cpu", impairments: Impairments | None = None):
        """Prepares the synthesis.

        Args:
            room: The room with its static paths.
            device: Where samples are computed.
            impairments: Receiver impairments; by default all.
        """
        self.room, self.config = room, room.config
        self.impairments = impairments or Impairments()
        self.synthesis = _synthesis(self.config, str(device))
        self._realizations: dict[int, tuple[PreparedRoom, Tensor, Tensor]] = {}

    def samples(self, motion: TracedMotion, frames: np.ndarray, *, realization: int = 0) -> Tensor:
        """ADC samples of a motion.

        Args:
            motion: Motion traced in this room.
            frames: Frame numbers (frame,).
            realization: 0 reproduces the simulator's samples to single precision; any other number has other
                micro-phases of room and skin and other noise.

        Returns:
            Samples (frame, loop, tx, rx, sample), complex64, in sqrt(mW).
        """
        room, static, rate = self._room(realization)
        body = _body(motion.subject, motion.height_m)
        if realization:
            body = _rephased(body, stream(motion.subject, "body", "other phases", realization))
        person = self._person(room, body, motion, frames)
        moving = Paths.padded([paths for index in range(len(frames)) for paths in person.paths(index)])
        occluded = people_shadow(room.paths, [self._starts_m(motion, frames)], self.config.wavelength_m)
        paths = ScenePaths(static=room.paths, moving=moving, occluded=occluded)
        moving = self.synthesis.moving(paths.moving)
        self.synthesis.subtract_occluded(moving, paths)
        seed = motion.seed if realization == 0 else int(stream(motion.seed, "twin", realization).integers(2**31))
        on_device = bool(realization) and self.synthesis.device.type != "cpu"
        receiver = Receiver(self.config, self.impairments, seed)
        return receiver.receive(
            moving,
            static.expand(len(frames), *static.shape),
            rate,
            frames.tolist(),
            on_device=on_device,
        )

    def _starts_m(self, motion: TracedMotion, frames: np.ndarray) -> np.ndarray:
        """Joints at the first node of each frame, of successive frames also one frame period later (`ScenePaths`)."""
        starts_m = motion.joints_m[frames, 0]
        if (np.diff(frames) != 1).any():
            return starts_m
        after, nodes_s = int(frames[-1]) + 1, self.synthesis.clock.node_s
        if after < len(motion.joints_m):
            last_m = motion.joints_m[after, 0]
        else:
            first_m, end_m = motion.joints_m[-1, 0], motion.joints_m[-1, -1]
            last_m = first_m + (end_m - first_m) * (self.config.frame_period_s / (nodes_s[-1] - nodes_s[0]))
        return np.concatenate([starts_m, last_m[None]])

    def person(self, motion: TracedMotion, frames: np.ndarray) -> BodyPaths:
        """Paths of the person, and the static paths that the person occludes.

        Args:
            motion: Motion traced in this room.
            frames: Frame numbers (frame,).
        """
        return self._person(self.room, _body(motion.subject, motion.height_m), motion, frames)

    def _person(self, room: PreparedRoom, body: ScatteringBody, motion: TracedMotion, frames: np.ndarray) -> BodyPaths:
        own = Physiology(motion.subject, motion.seed)
        joints_m, trunk_m = add_physiology(
            own, motion.joints_m[frames].astype(float), frames, self.synthesis.clock, motion.height_m
        )
        known = motion.visibility[frames]
        return BodyPaths(room, body, self.synthesis.clock, joints_m, trunk_m, known=known)

    def _room(self, realization: int) -> tuple[PreparedRoom, Tensor, Tensor]:
        key = 1 + realization % ROOM_REALIZATIONS if realization else 0
        if key not in self._realizations:
            room = resampled_phases(self.room, key) if key else self.room
            static = self.synthesis.static(room.paths)
            static += self.synthesis.static(leakage_path(self.config, self.impairments))
            self._realizations[key] = room, static, self.synthesis.static_rate(room.paths)
        return self._realizations[key]


@lru_cache(maxsize=4)
def _synthesis(config: RadarConfig, device: str) -> AdcSynthesis:
    return AdcSynthesis(config, device)


@lru_cache(maxsize=32)
def _body(subject: int, height_m: float) -> ScatteringBody:
    return ScatteringBody(subject, height_m)


def _rephased(body: ScatteringBody, rng: np.random.Generator) -> ScatteringBody:
    other = copy(body)
    other.micro_phase = np.exp(2j * np.pi * rng.random(len(body.micro_phase)))
    return other
