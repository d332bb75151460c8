"""Prepared rooms and looked-at motions -> ADC samples, without a ray caster: `Simulator` again, on any device.

Simulator.look(pose) -> joints, Visibility --.
Room -> prepared.room_arrays ----------------+--> Resynthesis.samples
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.motion.micro_motion import MicroMotion, MicroMotionSettings
from mmweaver.paths.adc_synthesis import FrameClock
from mmweaver.paths.adc_synthesis_torch import TorchSynthesis
from mmweaver.paths.body_model import ScatteringBody
from mmweaver.paths.body_paths import BodyEchoes
from mmweaver.paths.ray_traced import leakage_adc, with_micro_motion
from mmweaver.paths.receiver import Impairments, Receiver
from mmweaver.paths.static_paths import PreparedRoom
from mmweaver.paths.static_paths_store import with_new_phases
from mmweaver.paths.visibility import Visibility

ROOM_REALIZATIONS = 4  # sets of phases that a room draws from: each costs 30 ms and is kept


@dataclass(frozen=True, kw_only=True)
class TracedMotion:
    """A motion as it was looked at once: joints at the clock's nodes (frame, node, 22, 3), and what rays found out."""

    joints_m: np.ndarray
    visibility: Visibility
    subject: int
    height_m: float
    seed: int  # of the small motions and of the noise


class Resynthesis:
    """One prepared room for one radar. `samples` may be asked for any of its looks, any frames, and other phases."""

    def __init__(self, room: PreparedRoom, device: str | torch.device = "cpu", impairments: Impairments | None = None):
        self.room, self.config = room, room.config
        self.impairments = impairments or Impairments()
        self.synthesis = _synthesis(self.config, str(device))
        self._twins: dict[int, tuple[PreparedRoom, Tensor, Tensor]] = {}

    def samples(self, look: TracedMotion, frames: np.ndarray, *, twin: int = 0) -> Tensor:
        """ADC samples (frame, loop, tx, rx, sample) of frames of these numbers.

        Twin 0 is what the simulator gave when it looked, to single precision. Any other has other micro-phases of room
        and skin and other noise.
        """
        room, resting, rate = self._room(twin)
        body = _body(look.subject, look.height_m)
        if twin:
            body = _with_phases(body, stream(look.subject, "body", "other phases", twin))
        person = self._person(room, body, look, frames)
        still = resting - self.synthesis.resting([person.shadowed(index) for index in range(len(frames))])
        moving = self.synthesis.moving([person.rows(index) for index in range(len(frames))])
        seed = look.seed if twin == 0 else int(stream(look.seed, "twin", twin).integers(2**31))
        on_device = bool(twin) and self.synthesis.device.type != "cpu"
        receiver = Receiver(self.config, self.impairments, seed)
        return self.synthesis.received(moving, still, rate, receiver, frames, drawn_here=on_device)

    def person(self, look: TracedMotion, frames: np.ndarray) -> BodyEchoes:
        """The person's echoes, and what the person hides, in frames of these numbers."""
        return self._person(self.room, _body(look.subject, look.height_m), look, frames)

    def _person(self, room: PreparedRoom, body: ScatteringBody, look: TracedMotion, frames: np.ndarray) -> BodyEchoes:
        unrest = MicroMotion(look.subject, look.seed, MicroMotionSettings())
        joints_m, chest_m = with_micro_motion(
            unrest, look.joints_m[frames].astype(float), frames, self.synthesis.clock, look.height_m
        )
        return BodyEchoes(room, body, joints_m, chest_m, known=look.visibility.frames(frames))

    def _room(self, twin: int) -> tuple[PreparedRoom, Tensor, Tensor]:
        key = 1 + twin % ROOM_REALIZATIONS if twin else 0
        if key not in self._twins:
            room = with_new_phases(self.room, key) if key else self.room
            device = self.synthesis.device
            resting = torch.from_numpy(room.adc + leakage_adc(self.config, self.impairments)).to(device)
            self._twins[key] = room, resting, torch.from_numpy(room.adc_rate).to(device)
        return self._twins[key]


@lru_cache(maxsize=4)
def _synthesis(config: RadarConfig, device: str) -> TorchSynthesis:
    return TorchSynthesis(FrameClock(config), device)


@lru_cache(maxsize=32)
def _body(subject: int, height_m: float) -> ScatteringBody:
    return ScatteringBody(subject, height_m)


def _with_phases(body: ScatteringBody, rng: np.random.Generator) -> ScatteringBody:
    from copy import copy

    other = copy(body)
    other.micro_phase = np.exp(2j * np.pi * rng.random(len(body.micro_phase)))
    return other
