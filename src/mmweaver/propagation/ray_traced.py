"""The ray tracer: scene and poses to paths and ADC samples. The room is traced once, people frame by frame.

Several people: each occludes the others, their multipath and the room as a body occludes itself.

Paths over two people are of second order, see `second_order` and docs/several_people.md.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np
import torch
from scipy.interpolate import CubicSpline

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.board import Board
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PoseSequence, RadarCube, Scene
from mmweaver.motion.physiology import Physiology, PhysiologySettings
from mmweaver.propagation.adc_synthesis import AdcSynthesis, one_thread
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.body_model import DEFAULT_NUM_POINTS, ScatteringBody, body_of
from mmweaver.propagation.body_paths import BodyPaths
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.diffuse_clutter import diffuse_clutter
from mmweaver.propagation.image_method import static_points
from mmweaver.propagation.interference import interference
from mmweaver.propagation.mean_power import MeanPower
from mmweaver.propagation.occlusion import Visibility, people_shadow
from mmweaver.propagation.paths import FrameClock, Interaction, Paths, ScenePaths, StaticPaths
from mmweaver.propagation.receiver import (
    LEAKAGE_PATH_LENGTH_M,
    BackgroundRecording,
    Impairments,
    Receiver,
    check_recording,
    leakage,
)
from mmweaver.propagation.second_order import BodyBodyPaths
from mmweaver.propagation.skin_scattering import SkinEcho
from mmweaver.propagation.static_paths import Propagation, RayTracedRoom
from mmweaver.propagation.things import ThingPaths, reflector_paths
from mmweaver.propagation.visible_body import hulls_of
from mmweaver.signal.cube import static_samples


class PeoplePaths:
    """Paths of all people in one room, frame by frame; an empty room without people.

    A static path that two of them occlude is removed once.
    """

    def __init__(
        self,
        room: RayTracedRoom,
        bodies: list[ScatteringBody],
        clock: FrameClock,
        joints_m: list[np.ndarray],
        trunks_m: list[np.ndarray] | None = None,
        starts_m: list[np.ndarray] | None = None,
    ):
        """Poses all people, and determines which paths are clear.

        Args:
            room: The room.
            bodies: Skin points of each person; may be empty.
            clock: Clock of the radar's frame.
            joints_m: Joints (frame, node, 22, 3) in metres of each person, at the clock's nodes.
            trunks_m: Outward displacement of chest and belly (frame, node, 2) in metres of each person; by default
                none.
            starts_m: Joints (frame + 1, 22, 3) in metres of each person at the start of each frame and after the last,
                where they occlude the room; by default as in the middle of each frame.
        """
        self.starts_m = [own[:, own.shape[1] // 2] for own in joints_m] if starts_m is None else starts_m
        self.room, self.num_segments = room, len(clock.segments)
        self.hulls = hulls_of(bodies, joints_m) if bodies else []
        self.each = [
            BodyPaths(room, body, clock, own, trunk, self.hulls)
            for body, own, trunk in zip(bodies, joints_m, trunks_m or [None] * len(bodies), strict=True)
        ]
        seconds = [one.second for one in self.each if one.second is not None]
        self.between = [BodyBodyPaths(*pair) for pair in combinations(seconds, 2)]

    def scene(self, num_frames: int) -> ScenePaths:
        """All paths of the room and of the people.

        Args:
            num_frames: Number of frames, from the first.
        """
        segments = [paths for frame in range(num_frames) for paths in self.paths(frame)]
        return ScenePaths(static=self.room.paths, moving=Paths.padded(segments), occluded=self.occluded(num_frames))

    def paths(self, frame: int) -> list[Paths]:
        """All paths over people in one frame, one record (path,) per time segment."""
        each = [one.paths(frame) for one in self.each]
        for between in self.between:
            paths = between.paths(slice(frame, frame + 1))
            each.append([paths[index] for index in range(self.num_segments)])
        return [Paths.cat(parts) for parts in zip(*each, strict=True)] if each else [Paths.none()] * self.num_segments

    def occluded(self, num_frames: int) -> torch.Tensor:
        """Share of each static path's amplitude that people take, as `ScenePaths.occluded`."""
        if not self.starts_m:
            return torch.zeros(num_frames, len(self.room.paths))
        return people_shadow(self.room.paths, self.starts_m, self.room.config.wavelength_m)


CHUNK_FRAMES = 20  # frames per chunk, which bounds memory

_SENTENCES = (
    "amplitudes follow the radar equation with a transmit power, antenna gain and noise figure from memory of the"
    " makers' documents; they are not calibrated against a recording",
    "the body is made of capsules with a wrinkled skin with a specular lobe towards the radar (reflectivity 0.14, slope"
    " 0.10); clothes are in that figure and not modelled",
    "who keeps still sways, trembles, breathes and has a heartbeat by typical amounts",
    "nothing passes through furniture, and waves bend around people alone, not around edges of the room",
)
ASSUMPTIONS = tuple(map(UsualAssumption, _SENTENCES))
SEVERAL_PEOPLE = (
    "people occlude each other; multipath between people is there with paths of second order alone"
    " (see docs/several_people.md)"
)


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """Recorded samples, and the assumptions behind them."""

    adc: AdcCube
    assumptions: tuple[str, ...]


class Simulator:
    """One radar in one room. The room is traced on construction; `run` may then be called for many motions.

    Micro-phases belong to the room and to each person; the seed samples the receiver's noise.
    """

    def __init__(
        self,
        scene: Scene,
        config: RadarConfig,
        impairments: Impairments | None = None,
        *,
        micro_seed: int = 0,
        background: RadarCube | None = None,
        board: Board | None = None,
        propagation: Propagation | None = None,
        room: RayTracedRoom | None = None,
    ):
        """Traces the room.

        Args:
            scene: Room and position of the radar.
            config: The radar.
            impairments: Receiver impairments of an ideal board; by default all.
            micro_seed: Seed of the phases of the room's surfaces.
            background: Recording by this radar without people, whose static clutter and noise are used; by default both
                are simulated.
            board: Board whose errors apply to all signals; by default those of `impairments` alone.
            propagation: Which paths are traced; by default `Propagation()`.
            room: The scene as traced for another board with the same antenna positions, to save tracing it again.

        Raises:
            InputError: If the background is from another radar.
        """
        self.config, self.radar_pose = config, scene.radar_pose
        self.impairments = impairments or Impairments()
        self.board = None if board is None or board.is_ideal else BoardEffects(board, config)
        built = config if self.board is None else self.board.radar
        self.synthesis = AdcSynthesis(built, board=self.board)
        self.clock = self.synthesis.clock
        self.room = (room or RayTracedRoom(scene, built, micro_seed, propagation)).for_radar(built)
        if self.room.propagation.clutter:
            self.room.paths = StaticPaths.cat([self.room.paths, diffuse_clutter(built, micro_seed, scene)])
        if scene.reflectors:
            reflectors = reflector_paths(scene.reflectors, scene.radar_pose, built)
            self.room.paths = StaticPaths.cat([self.room.paths, reflectors])
        self.things, self.interferers = ThingPaths(scene, built), scene.interferers
        if self.board is not None:
            self.room.paths = self.board.recorded_static(self.room.paths)
        self.background: BackgroundRecording | None = None
        with one_thread():
            if background is not None:
                self.background = self._use(background)
                samples = static_samples(self.background.static.numpy(), config)
                self._static = torch.from_numpy(samples)
            else:
                self._static = self.synthesis.static(self.room.paths)
                self._static += self._leakage()
            self._static_rate = self.synthesis.static_rate(self.room.paths)
            if self.board is not None:  # derivative of static samples by the carrier's relative error
                self._drift_rate = self._static_rate * (config.centre_frequency_hz / config.chirp_slope_hz_per_s)
                if background is None:
                    self._drift_rate = self._drift_rate + self.synthesis.leakage(*self.board.leakage_rate)

    def _receiver(self, seed: int) -> Receiver:
        """The radar's receiver, with the noise of the background recording if there is one."""
        receiver = Receiver(self.room.config, self.impairments, self.radar_pose.noise_seed(seed), self.board)
        if self.background is None:
            return receiver
        return receiver.adopt_noise(self.background.sample_noise_mw, self.background.count_sqrt_mw)

    def _leakage(self) -> torch.Tensor:
        """Samples (tx, rx, sample) of the board's leakage, or of a typical one."""
        if self.board is not None and len(self.board.board.leakage_range_m):
            return self.synthesis.leakage(*self.board.leakage)
        return self.synthesis.static(leakage_path(self.config, self.impairments))

    def _use(self, recording: RadarCube) -> BackgroundRecording:
        """Conditions the amplitudes of the room's static paths on a recording."""
        check_recording(recording, self.config)
        radar, paths = MeanPower(self.room.config), self.room.paths
        expected = radar.maps(static_points(paths, radar.response)).range_azimuth
        background = BackgroundRecording.of(recording, expected, radar)
        self.room.paths = background.conditioned(paths, CubeRenderer(self.room.config, self.board))
        return background

    @property
    def room_adc(self) -> np.ndarray:
        """Samples of the empty room with leakage, complex64 (tx, rx, sample), in sqrt(mW)."""
        return self._static.numpy()

    def run(self, pose: PoseSequence | Sequence[PoseSequence], **options: Any) -> Simulation:
        """ADC samples of the posed people, all frames in memory at once.

        Args:
            pose: One person, several, or an empty tuple for the empty room.
            **options: As those of `chunks`.

        Returns:
            Samples (frame, loop, tx, rx, sample), and the assumptions behind them.
        """
        chunks = self.chunks(pose, **options)
        samples = np.concatenate([chunk.samples for chunk in chunks])
        scale = 1.0 if self.background is None else self.background.unit
        return Simulation(adc=AdcCube(samples=samples, config=self.config, scale=scale), assumptions=ASSUMPTIONS)

    def chunks(
        self,
        pose: PoseSequence | Sequence[PoseSequence],
        *,
        num_frames: int,
        seed: int,
        first_frame: int = 0,
        num_points: int = DEFAULT_NUM_POINTS,
        echo: SkinEcho | None = None,
        motions: PhysiologySettings | None = None,
    ) -> Iterator[AdcCube]:
        """ADC samples of the posed people, at most CHUNK_FRAMES frames at a time.

        Samples do not depend on the chunking.

        Args:
            pose: One person, several, or an empty tuple for the empty room.
            num_frames: Number of frames.
            seed: Seed of the receiver's noise and of micro-motion.
            first_frame: Number of the first frame, in the time of the poses; noise and micro-motion continue from
                there.
            num_points: Skin points per body.
            echo: How skin scatters; by default `SkinEcho()`.
            motions: Sway, tremor and breathing, by default typical amounts; STILL moves the joints alone.

        Yields:
            Samples (frame, loop, tx, rx, sample) of consecutive frames.

        Raises:
            InputError: If a pose does not cover the frames or contains values that are not finite.
        """
        poses = (pose,) if isinstance(pose, PoseSequence) else tuple(pose)
        for one in poses:
            self._check(one, num_frames, first_frame)
        bodies = [body_of(one, num_points, echo) for one in poses]
        receiver = self._receiver(seed)
        unit = 1.0 if self.background is None else self.background.unit
        living = [Physiology.of(one, seed, motions) for one in poses]
        for first in range(first_frame, first_frame + num_frames, CHUNK_FRAMES):
            frames = np.arange(first, min(first + CHUNK_FRAMES, first_frame + num_frames))
            paths = self._people(poses, bodies, living, frames).scene(len(frames))
            paths = self.things.added(paths, frames, self.clock, self.room)
            samples = self.samples(paths, frames, receiver).numpy()
            samples = samples if unit == 1.0 else samples / np.float32(unit)
            yield AdcCube(samples=samples, config=self.config, scale=unit)

    def samples(self, paths: ScenePaths, frames: np.ndarray, receiver: Receiver) -> torch.Tensor:
        """Renders paths and applies the receiver.

        Args:
            paths: Paths of the frames.
            frames: Frame numbers (frame,), which noise and drift depend on.
            receiver: Noise and converter.

        Returns:
            Samples (frame, loop, tx, rx, sample), complex64, in sqrt(mW).
        """
        with one_thread():
            static, moving = self._static.expand(len(frames), *self._static.shape), paths.moving
            if self.board is not None:
                static = static + self._drifted(frames, receiver.seed)
                moving = self.board.recorded_moving(moving, frames, receiver.seed)
            samples = self.synthesis.moving(moving)
            self.synthesis.subtract_occluded(samples, paths)
            if self.interferers:
                own = interference(self.interferers, self.radar_pose, self.config, frames, receiver.seed)
                samples += torch.from_numpy(own)
            return receiver.receive(samples, static, self._static_rate, frames.tolist())

    def _drifted(self, frames: np.ndarray, seed: int) -> torch.Tensor:
        """Change of the static samples by the carrier's drift, (frame, tx, rx, sample)."""
        assert self.board is not None
        return torch.from_numpy(self.board.drift(frames, seed)).float()[:, None, None, None] * self._drift_rate

    def paths(self, poses: tuple[PoseSequence, ...], frame: int, seed: int) -> ScenePaths:
        """Propagation paths of one frame of a signal.

        Args:
            poses: Motion of each person; may be empty.
            frame: Number of the frame.
            seed: Seed of the signal.
        """
        bodies = [body_of(one) for one in poses]
        living = [Physiology.of(one, seed) for one in poses]
        return self._people(poses, bodies, living, np.array([frame])).scene(1)

    def _people(
        self,
        poses: tuple[PoseSequence, ...],
        bodies: list[ScatteringBody],
        living: list[Physiology],
        frames: np.ndarray,
    ) -> PeoplePaths:
        joints_m, trunks_m, starts_m = [], [], []
        start_s = np.append(frames, frames[-1] + 1) * self.config.frame_period_s + self.clock.node_s[0]
        for pose, own in zip(poses, living, strict=True):
            level_m = self.radar_pose.in_level_frame(self._joints_at_nodes(pose, frames))
            joints, trunk = add_physiology(own, level_m, frames, self.clock, pose.height_m)
            joints_m.append(self.radar_pose.seen(joints))
            trunks_m.append(trunk)
            starts_m.append(_joints_at(pose, start_s))
        return PeoplePaths(self.room, bodies, self.clock, joints_m, trunks_m, starts_m)

    def trace(self, pose: PoseSequence, *, num_frames: int, seed: int) -> tuple[np.ndarray, Visibility]:
        """Casts the rays of a motion, for `Resynthesis`.

        Args:
            pose: Motion of one person.
            num_frames: Number of frames.
            seed: Seed of micro-motion.

        Returns:
            Joints at the clock's nodes (frame, node, 22, 3) in metres, float32, and the visibility.

        Raises:
            InputError: As `chunks`.
        """
        self._check(pose, num_frames)
        frames = np.arange(num_frames)
        joints_m = self._joints_at_nodes(pose, frames).astype(np.float32)
        own = Physiology.of(pose, seed)
        moved, trunk = add_physiology(own, joints_m.astype(float), frames, self.clock, pose.height_m)
        return joints_m, BodyPaths(self.room, body_of(pose), self.clock, moved, trunk).visibility()

    def _joints_at_nodes(self, pose: PoseSequence, frames: np.ndarray) -> np.ndarray:
        """Joints (frame, node, 22, 3), interpolated in slow time.

        A frame that begins with the last pose continues at its velocity; holding the pose would freeze the person.
        """
        return _joints_at(pose, frames[:, None] * self.config.frame_period_s + self.clock.node_s[None, :])

    def _check(self, pose: PoseSequence, num_frames: int, first_frame: int = 0) -> None:
        begin_s = first_frame * self.config.frame_period_s
        needed_s = (first_frame + num_frames - 1) * self.config.frame_period_s
        if pose.time_s[-1] < needed_s - 1e-9 or pose.time_s[0] > begin_s + 1e-9:
            raise InputError(
                f"the motion covers {pose.time_s[0]:.2f} to {pose.time_s[-1]:.2f} s, but {num_frames} frames need"
                f" {begin_s:g} to {needed_s:.2f} s; give a longer motion or fewer frames"
            )
        if not np.isfinite(pose.joints_m).all():
            raise InputError("the motion has joints that are not numbers; mend the pose file")


def _joints_at(pose: PoseSequence, time_s: np.ndarray) -> np.ndarray:
    """Joints (..., 22, 3) at times (...); after the motion's end they continue at its last velocity."""
    spline, last_s = CubicSpline(pose.time_s, pose.joints_m, axis=0), pose.time_s[-1]
    joints = spline(np.clip(time_s, pose.time_s[0], last_s))
    beyond_s = np.maximum(time_s - last_s, 0.0)
    return joints + beyond_s[..., None, None] * spline(last_s, 1) if beyond_s.any() else joints


def add_physiology(
    motion: Physiology, joints_m: np.ndarray, frames: np.ndarray, clock: FrameClock, height_m: float
) -> tuple[np.ndarray, np.ndarray]:
    """Adds a person's sway, tremor, breathing and heartbeat.

    Args:
        motion: Physiology of the person.
        joints_m: Joints (frame, node, 22, 3) in metres at the nodes of frames.
        frames: Frame numbers (frame,).
        clock: Clock of the radar's frame.
        height_m: Body height in metres.

    Returns:
        Joints that sway and tremble, and the outward displacement of chest and belly (frame, node, 2) in metres.
    """
    time_s = (frames[:, None] * clock.config.frame_period_s + clock.node_s[None, :]).ravel()
    flat = joints_m.reshape(-1, *joints_m.shape[2:])
    moved, trunk_m = motion.moved(flat, time_s, height_m), motion.trunk_m(flat, time_s, height_m)
    return moved.reshape(joints_m.shape), trunk_m.reshape(*joints_m.shape[:2], 2)


def leakage_path(config: RadarConfig, impairments: Impairments) -> StaticPaths:
    """The direct path (1,) from transmitters to receivers, which cannot be occluded.

    Args:
        config: The radar.
        impairments: The leakage level.
    """
    length_m = np.full((1, config.num_tx, config.num_rx), LEAKAGE_PATH_LENGTH_M)
    amplitude, nowhere = np.array([leakage(config, impairments)]), np.zeros((1, 3))
    return StaticPaths.of(amplitude, length_m, nowhere, nowhere, Interaction.SPECULAR)
