"""Prepared rooms and looked-at motions -> ADC samples, without a ray caster: `Simulator` again, on any device.

Simulator.look(pose) -> joints, Visibility --.
Room -> prepared.room_arrays ----------------+--> Replay.samples
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream
from mmweaver.simulation.body import Body
from mmweaver.simulation.echoes import BodyEchoes
from mmweaver.simulation.prepared import redrawn
from mmweaver.simulation.receiver import Impairments, Receiver
from mmweaver.simulation.room import RestingRoom
from mmweaver.simulation.simulator import leakage_adc, lively
from mmweaver.simulation.small_motions import Restlessness, SmallMotions
from mmweaver.simulation.synthesis import FrameClock
from mmweaver.simulation.torch_synthesis import TorchSynthesis
from mmweaver.simulation.visibility import Visibility

ROOM_TWINS = 4  # sets of phases that a room draws from: each costs 30 ms and is kept


@dataclass(frozen=True, kw_only=True)
class Look:
    """A motion as it was looked at once: joints at the clock's nodes (frame, node, 22, 3), and what rays found out."""

    joints_m: np.ndarray
    visibility: Visibility
    subject: int
    height_m: float
    seed: int  # of the small motions and of the noise


class Replay:
    """One prepared room for one radar. `samples` may be asked for any of its looks, any frames, and other phases."""

    def __init__(self, room: RestingRoom, device: str | torch.device = "cpu", impairments: Impairments | None = None):
        self.room, self.config = room, room.config
        self.impairments = impairments or Impairments()
        self.synthesis = _synthesis(self.config, str(device))
        self._twins: dict[int, tuple[RestingRoom, Tensor, Tensor]] = {}

    def samples(self, look: Look, frames: np.ndarray, *, twin: int = 0) -> Tensor:
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

    def person(self, look: Look, frames: np.ndarray) -> BodyEchoes:
        """The person's echoes, and what the person hides, in frames of these numbers."""
        return self._person(self.room, _body(look.subject, look.height_m), look, frames)

    def _person(self, room: RestingRoom, body: Body, look: Look, frames: np.ndarray) -> BodyEchoes:
        unrest = Restlessness(look.subject, look.seed, SmallMotions())
        joints_m, chest_m = lively(
            unrest, look.joints_m[frames].astype(float), frames, self.synthesis.clock, look.height_m
        )
        return BodyEchoes(room, body, joints_m, chest_m, known=look.visibility.frames(frames))

    def _room(self, twin: int) -> tuple[RestingRoom, Tensor, Tensor]:
        key = 1 + twin % ROOM_TWINS if twin else 0
        if key not in self._twins:
            room = redrawn(self.room, key) if key else self.room
            device = self.synthesis.device
            resting = torch.from_numpy(room.adc + leakage_adc(self.config, self.impairments)).to(device)
            self._twins[key] = room, resting, torch.from_numpy(room.adc_rate).to(device)
        return self._twins[key]


@lru_cache(maxsize=4)
def _synthesis(config: RadarConfig, device: str) -> TorchSynthesis:
    return TorchSynthesis(FrameClock(config), device)


@lru_cache(maxsize=32)
def _body(subject: int, height_m: float) -> Body:
    return Body(subject, height_m)


def _with_phases(body: Body, rng: np.random.Generator) -> Body:
    from copy import copy

    other = copy(body)
    other.micro_phase = np.exp(2j * np.pi * rng.random(len(body.micro_phase)))
    return other
