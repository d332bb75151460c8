"""The ways from a scene and the people moving in it to the radar signal, by name."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PoseSequence, RadarCube, Scene
from mmweaver.core.registry import Registry
from mmweaver.core.stages import Stages
from mmweaver.dsp.cube import adc_from_cube, radar_cube
from mmweaver.paths.ray_traced import ASSUMPTIONS, SEVERAL_PEOPLE, Simulator

if TYPE_CHECKING:
    from mmweaver.models.learned_paths import LearnedRoom


LONGEST_FRAME_S = 0.04  # of chirps: of 28 ms the network is as good as physics, of 62 ms a little worse
# what meta.json says
LEARNED_NOTE = UsualAssumption(
    "the signal was written by a network trained on simulated rooms; phases of surfaces and skin are drawn"
)
RECORDED = (
    "what rests is that of the recording of the empty room; echoes of people were written by a network trained on"
    " simulated rooms, and the phases of their skin are drawn"
)
LEAST_ENERGY = "ADC samples are those of least energy that give the network's cube"
CONSTANT = "velocities are constant within a frame, whose chirps last long: limbs smear too little over Doppler"
SUPERIMPOSED = "several people are superimposed: they do not hide each other"
BECAUSE_OF_ADC = "physics made the signal, not the network, for raw ADC samples are asked for; a network has none"
BECAUSE_OF_LENGTH = (
    "physics made the signal, not the network, to which people's velocities are constant within a frame's chirps, and"
    " these last long"
)
BECAUSE_OF_PEOPLE = "physics made the signal, not the network, which does not know how people hide each other"
NO_RECORDING = (
    "physics and raw ADC samples take nothing from a recording of the empty room, the network does: leave out the"
    " recording, or physics and the samples"
)


@dataclass(frozen=True, kw_only=True)
class Signal:
    """What a method gives: the cube, the ADC samples where it has any, and what it assumed.

    `method` is the name of the one that made it, where a method leaves the work to others.
    """

    cube: RadarCube
    adc: AdcCube | None
    assumptions: tuple[str, ...]
    method: str | None = None


@runtime_checkable
class Method(Protocol):
    """A way from a scene and the people moving in it to the signal.

    ADC samples are given where the method has them and `keep_adc` asks for them.
    """

    def __call__(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        num_frames: int,
        seed: int,
        keep_adc: bool,
        stages: Stages,
    ) -> Signal: ...


class Physics:
    """Ray-traced ADC samples, then the radar's own processing. The room is prepared once and kept for the next call."""

    def __init__(self) -> None:
        self._ready: tuple[Scene, RadarConfig, Simulator] | None = None

    def __call__(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        num_frames: int,
        seed: int,
        keep_adc: bool,
        stages: Stages,
    ) -> Signal:
        if scene.empty_recording is not None:
            raise InputError(NO_RECORDING)
        with stages("prepare the room"):
            simulator = self._simulator(scene, config)
        grid = CubeGrid.of(config, num_frames)
        values = np.empty(grid.shape, np.complex64)
        samples = np.empty(_adc_shape(config, num_frames if keep_adc else 0), np.complex64)
        scale, done = math.nan, 0
        with stages("simulate"):
            for chunk in simulator.chunks(poses, num_frames=num_frames, seed=seed):
                part = slice(done, done + len(chunk.samples))
                values[part] = radar_cube(chunk).values
                if keep_adc:
                    samples[part] = chunk.samples
                scale, done = chunk.scale, part.stop
        return Signal(
            cube=RadarCube(values=values, grid=grid, config=config, scale=scale),
            adc=AdcCube(samples=samples, config=config, scale=scale) if keep_adc else None,
            assumptions=ASSUMPTIONS if len(poses) < 2 else (*ASSUMPTIONS, SEVERAL_PEOPLE),
        )

    def _simulator(self, scene: Scene, config: RadarConfig) -> Simulator:
        if self._ready is None or self._ready[0] is not scene or self._ready[1] != config:
            self._ready = (scene, config, Simulator(scene, config))
        return self._ready[2]


def _adc_shape(config: RadarConfig, num_frames: int) -> tuple[int, int, int, int, int]:
    return num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples


class Learned:
    """The network: a learned field, drawn and rendered. The room is encoded once and kept for the next call.

    `weights` is a file that `mmweaver train` wrote; without one, those that come with mmweaver. Raises InputError for
    files that are no such weights.
    """

    def __init__(self, weights: Path | None = None) -> None:
        self.weights = weights
        self._ready: tuple[Scene, RadarConfig, LearnedRoom] | None = None

    def __call__(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        num_frames: int,
        seed: int,
        keep_adc: bool,
        stages: Stages,
    ) -> Signal:
        from mmweaver.models.learned_paths import FrameMotion

        with stages("encode the room"):
            room = self._room(scene, config)
        with stages("weave the signal"):
            motions = [FrameMotion.of(pose, config, num_frames) for pose in poses]
            cube = room.cube(motions, seed=seed)
            adc = adc_from_cube(cube) if keep_adc else None
        told = {
            LEARNED_NOTE: room.empty is None, RECORDED: room.empty is not None, LEAST_ENERGY: keep_adc,
            SUPERIMPOSED: len(poses) > 1, CONSTANT: config.active_time_s > LONGEST_FRAME_S,
        }  # fmt: skip
        of_recording = () if room.empty is None else room.empty.assumptions
        sentences = (*(sentence for sentence, is_true in told.items() if is_true), *of_recording)
        return Signal(cube=cube, adc=adc, assumptions=sentences)

    def _room(self, scene: Scene, config: RadarConfig) -> "LearnedRoom":
        from mmweaver.models.learned_paths import LearnedRoom
        from mmweaver.models.weights import load_weights, shipped_weights

        if self._ready is None or self._ready[0] is not scene or self._ready[1] != config:
            network, _ = load_weights(self.weights or shipped_weights())
            self._ready = (scene, config, LearnedRoom(network, scene, config, empty=scene.empty_recording))
        return self._ready[2]


class Auto:
    """The network, and physics for what the network knows too little of: raw ADC samples, several people, long frames.

    With a recording of the empty room, of which physics has no use, the network makes all but ADC samples.
    """

    def __init__(self) -> None:
        self._woven, self._physics = Learned(), Physics()

    def __call__(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        num_frames: int,
        seed: int,
        keep_adc: bool,
        stages: Stages,
    ) -> Signal:
        reason = BECAUSE_OF_ADC if keep_adc else None
        if reason is None and scene.empty_recording is None:
            is_long = config.active_time_s > LONGEST_FRAME_S
            reason = BECAUSE_OF_PEOPLE if len(poses) > 1 else BECAUSE_OF_LENGTH if is_long else None
        method = self._woven if reason is None else self._physics
        signal = method(scene, poses, config, num_frames=num_frames, seed=seed, keep_adc=keep_adc, stages=stages)
        if reason is None:
            return replace(signal, method="weaver")
        return replace(signal, method="physics", assumptions=(*signal.assumptions, reason))


DEFAULT_METHOD = "auto"
METHODS: Registry[Callable[[], Method]] = Registry(
    "method",
    [(DEFAULT_METHOD, Auto), ("weaver", Learned), ("physics", Physics)],
    entry_points="mmweaver.methods",
)
