"""Methods from a scene and the people moving in it to the radar signal, by name."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar, runtime_checkable

import numpy as np

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.board import Board
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PoseSequence, RadarCube, Scene
from mmweaver.core.registry import Registry
from mmweaver.core.stages import Stages
from mmweaver.motion.physiology import Physiology
from mmweaver.propagation.board_effects import built_radar
from mmweaver.propagation.diffuse_clutter import seed_of_room
from mmweaver.propagation.paths import ScenePaths
from mmweaver.propagation.ray_traced import ASSUMPTIONS, SEVERAL_PEOPLE, Simulator
from mmweaver.propagation.static_paths import ALL_PATHS, Propagation, RayTracedRoom
from mmweaver.signal.cube import radar_cube

if TYPE_CHECKING:
    from mmweaver.models.frame_motion import FrameMotion
    from mmweaver.models.hypernetwork_rooms import SignalRoom
    from mmweaver.models.neural_path_solver import LearnedRoom
    from mmweaver.models.scene_tensors import GivenRoom
    from mmweaver.propagation.receiver import BackgroundRecording


# entries of meta.json
LEARNED_NOTE = UsualAssumption(
    "echoes of first order were written by a network trained on simulated rooms, others by physics; phases of surfaces"
    " and skin are sampled"
)
HYPERNETWORK_NOTES = {
    "signal": "the signal was written by a hypernetwork as the paper has it: no board, no noise, no other order",
    "power": "echoes of first order were written by a hypernetwork as fields of power, no others; phases are sampled",
}
ELSEWHERE = (
    "the network was trained with radars at the camera; elsewhere it was measured to be about as near as physics"
    " (docs/several_radars.md)"
)
FIRST_ORDER_ALONE = "one bounce off rough surfaces and off the body: no paths over both"
RECORDED = "static clutter is that of the background recording"


@dataclass(frozen=True, kw_only=True)
class Signal:
    """Result of a method: the cube, ADC samples if requested, and assumptions.

    `method` is the name for meta.json where it differs from the one the method was chosen by.
    """

    cube: RadarCube
    adc: AdcCube | None
    assumptions: tuple[str, ...]
    method: str | None = None


@runtime_checkable
class Method(Protocol):
    """From a scene and the people moving in it to the radar signal.

    Args:
        scene: The room in the radar's coordinates.
        poses: Motion of each person, in the same coordinates.
        config: The radar.
        num_frames: Number of frames.
        seed: Seed of everything that is sampled.
        keep_adc: Whether ADC samples are returned.
        stages: Timers of the stages.
        background: Recording of the empty room by the same radar in the same place, whose static clutter replaces that
            of the scene.
        board: Board whose errors the signal has; passed only if there are any. A method without this argument makes
            signals of an ideal board.
        first_frame: Number of the first frame, in the time of the poses, which may begin earlier; passed only for a
            part of a longer signal (`Weaver.stream`). Noise must differ between parts, phases must not. A method
            without this argument makes no streams.
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
        background: RadarCube | None = None,
        board: Board | None = None,
        first_frame: int = 0,
    ) -> Signal: ...


class Physics:
    """Ray-traced ADC samples, processed as the radar does. The room is prepared once and kept for the next call."""

    def __init__(self, propagation: Propagation = ALL_PATHS) -> None:
        """Keeps the settings; rooms are prepared on demand.

        Args:
            propagation: Which paths are traced.
        """
        self.propagation = propagation
        self._prepared = _Latest(self._prepare)
        # rays are the same for every board with the same antenna positions, and boards differ by seed
        self._traced = _Latest(
            lambda scene, config, background, board: RayTracedRoom(scene, config, 0, self.propagation)
        )

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
        background: RadarCube | None = None,
        board: Board | None = None,
        first_frame: int = 0,
    ) -> Signal:
        """Makes the signal, see `Method`."""
        with stages("prepare the room"):
            simulator = self._prepared.get(scene, config, background, board)
        grid = CubeGrid.of(config, num_frames, first_frame)
        values = np.empty(grid.shape, np.complex64)
        samples = np.empty(_adc_shape(config, num_frames if keep_adc else 0), np.complex64)
        scale, done = math.nan, 0
        with stages("simulate"):
            for chunk in simulator.chunks(poses, num_frames=num_frames, seed=seed, first_frame=first_frame):
                part = slice(done, done + len(chunk.samples))
                values[part] = radar_cube(chunk).values
                if keep_adc:
                    samples[part] = chunk.samples
                scale, done = chunk.scale, part.stop
        several = (SEVERAL_PEOPLE,) if len(poses) > 1 else ()
        return Signal(
            cube=RadarCube(values=values, grid=grid, config=config, scale=scale),
            adc=AdcCube(samples=samples, config=config, scale=scale) if keep_adc else None,
            assumptions=(
                *ASSUMPTIONS,
                *_order_notes(self.propagation),
                *several,
                *_background_notes(simulator.background),
            ),
        )

    def paths(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        frame: int,
        seed: int,
        background: RadarCube | None = None,
        board: Board | None = None,
    ) -> ScenePaths:
        """The propagation paths of one frame, for a signal that this method made; arguments as in `Method`.

        Args:
            scene: The room.
            poses: Motion of each person.
            config: The radar.
            frame: Number of the frame.
            seed: Seed of the signal.
            background: Background recording of the signal.
            board: Board of the signal.
        """
        return self._prepared.get(scene, config, background, board).paths(poses, frame, seed)

    def _prepare(
        self, scene: Scene, config: RadarConfig, background: RadarCube | None, board: Board | None
    ) -> Simulator:
        room = self._traced.get(scene, _board_antennas(board, config), None, None)
        return Simulator(
            scene,
            config,
            micro_seed=seed_of_room(scene),
            background=background,
            board=board,
            propagation=self.propagation,
            room=room,
        )


def _adc_shape(config: RadarConfig, num_frames: int) -> tuple[int, int, int, int, int]:
    return num_frames, config.num_loops, config.num_slots, config.num_rx, config.num_samples


class Learned:
    """Renders the network's paths. The room is encoded once and kept for the next call."""

    def __init__(self, weights: Path | None = None, propagation: Propagation = ALL_PATHS) -> None:
        """Keeps the settings; the network is loaded on demand.

        Args:
            weights: File of `mmweaver train`; by default the weights that come with mmweaver.
            propagation: Which paths are traced in addition to the network's.
        """
        self.weights, self.propagation = weights, propagation
        self._encoded = _Latest(self._encode)
        # what the network is given of a room is the same for every board with the same places of antennas
        self._given = _Latest(lambda scene, config, background, board: _given_room(scene, config, self.propagation))

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
        background: RadarCube | None = None,
        board: Board | None = None,
        first_frame: int = 0,
    ) -> Signal:
        """Makes the signal, see `Method`.

        Raises:
            InputError: If the weights are not a network of mmweaver.
        """

        with stages("encode the room"):
            room = self._encoded.get(scene, config, background, board)
        with stages("weave the signal"):
            motions = _frame_motions(scene, poses, config, num_frames, first_frame, seed)
            cube, adc = room.signal(
                motions,
                seed=scene.radar_pose.noise_seed(seed),
                keep_adc=keep_adc,
                first_frame=first_frame,
                num_frames=num_frames,
            )
        several = (SEVERAL_PEOPLE,) if len(poses) > 1 else ()
        moved = () if scene.radar_pose.is_at_camera else (ELSEWHERE,)
        order = _order_notes(self.propagation)
        note = LEARNED_NOTE if self._target is None else HYPERNETWORK_NOTES[self._target]
        assumptions = (note, *order, *moved, *several, *_background_notes(room.background))
        name = "weaver" if self._target is None else f"hypernetwork, target {self._target}"
        return Signal(cube=cube, adc=adc, assumptions=assumptions, method=name)

    def paths(
        self,
        scene: Scene,
        poses: tuple[PoseSequence, ...],
        config: RadarConfig,
        *,
        frame: int,
        seed: int,
        background: RadarCube | None = None,
        board: Board | None = None,
    ) -> ScenePaths:
        """The propagation paths of one frame, see `Physics.paths`."""
        from mmweaver.models.neural_path_solver import LearnedRoom

        room = self._encoded.get(scene, config, background, board)
        if not isinstance(room, LearnedRoom):
            raise InputError("weights of --target signal give no propagation paths; take those of a scatterer network")
        return room.paths(_frame_motions(scene, poses, config, 1, frame, seed))

    def _encode(
        self, scene: Scene, config: RadarConfig, background: RadarCube | None, board: Board | None
    ) -> "LearnedRoom | SignalRoom":
        if self._target == "signal":
            from mmweaver.models.hypernetwork_rooms import SignalRoom

            if background is not None:
                raise InputError("a hypernetwork of target signal writes the room, too; leave the background out")
            return SignalRoom(self._network, scene, config)
        given = self._given.get(scene, _board_antennas(board, config), None, None)
        if self._target == "power":
            from mmweaver.models.hypernetwork_rooms import FieldRoom as Room
        else:
            from mmweaver.models.neural_path_solver import LearnedRoom as Room
        return Room(self._network, given, config, background=background, board=board)

    @cached_property
    def _target(self) -> str | None:
        """Target of the weights of a hypernetwork; None for the network that comes with mmweaver."""
        from mmweaver.models.weights import read_card

        return None if self.weights is None else read_card(self.weights).target

    @cached_property
    def _network(self) -> Any:
        from mmweaver.models.weights import load_weights, shipped_weights

        if self._target is None:
            return load_weights(self.weights or shipped_weights())[0]
        from mmweaver.models.hypernetwork_rooms import load_hypernetwork

        assert self.weights is not None
        return load_hypernetwork(self.weights)[0]


def _given_room(scene: Scene, config: RadarConfig, propagation: Propagation) -> "GivenRoom":
    from mmweaver.models.scene_tensors import GivenRoom

    return GivenRoom.of(scene, config, propagation=propagation)


def _frame_motions(
    scene: Scene, poses: tuple[PoseSequence, ...], config: RadarConfig, num_frames: int, first_frame: int, seed: int
) -> "list[FrameMotion]":
    """The motion of each person at the radar's frames, with the physiology of the signal's seed."""
    from mmweaver.models.frame_motion import FrameMotion

    at = scene.radar_pose
    return [FrameMotion.of(pose, config, num_frames, first_frame, Physiology.of(pose, seed), at) for pose in poses]


def _board_antennas(board: Board | None, config: RadarConfig) -> RadarConfig:
    """The radar with the antenna positions of a board, on which rays depend."""
    return config if board is None else replace(built_radar(board, config), noise_figure_db=config.noise_figure_db)


RoomT = TypeVar("RoomT")


class _Latest(Generic[RoomT]):
    """The room prepared last, kept for as long as scene, radar, background and board stay the same."""

    def __init__(self, prepare: Callable[[Scene, RadarConfig, RadarCube | None, Board | None], RoomT]):
        self._prepare = prepare
        # compared by identity, so scene and background are kept alive; one tuple, since threads may share a method
        self._kept: tuple[Scene, RadarCube | None, tuple[RadarConfig, str | None], RoomT] | None = None

    def get(self, scene: Scene, config: RadarConfig, background: RadarCube | None, board: Board | None) -> RoomT:
        key = config, None if board is None else board.digest
        kept = self._kept
        if kept is None or kept[0] is not scene or kept[1] is not background or kept[2] != key:
            kept = scene, background, key, self._prepare(scene, config, background, board)
            self._kept = kept
        return kept[3]


def _order_notes(propagation: Propagation) -> tuple[str, ...]:
    return (FIRST_ORDER_ALONE,) if propagation.bounces == 1 else ()


def _background_notes(background: "BackgroundRecording | None") -> tuple[str, ...]:
    return () if background is None else (RECORDED, *background.assumptions)


DEFAULT_METHOD = "auto"  # the network
METHODS: Registry[Callable[[], Method]] = Registry(
    "method",
    [(DEFAULT_METHOD, Learned), ("weaver", Learned), ("physics", Physics)],
    entry_points="mmweaver.models.methods",
)
