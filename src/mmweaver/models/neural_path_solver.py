"""The network as a path solver: from room and motion to paths and their signal. Implements `method="weaver"`.

Second-order paths in addition to those of the network: over people and rough surfaces, and over two people.

The network has learned first-order paths. These follow by physics from joints and room, as in `propagation`, with
fewer skin points, which the room and other people may occlude, but not the body itself.
Reference: docs/decisions/network-by-default.md.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import combinations
from typing import Any

import numpy as np
import torch
from scipy import fft
from torch import Tensor

from mmweaver.compression.scatterers.layers import cell_noise
from mmweaver.core.board import Board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES, joint
from mmweaver.models.body_anchors import MIRRORED, NUM_ANCHORS, NUM_GHOSTS, anchor_places, facing
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.scene_tensors import GivenRoom, SceneTensors
from mmweaver.propagation.adc_synthesis import AdcSynthesis, one_thread
from mmweaver.propagation.board_effects import BoardEffects
from mmweaver.propagation.body_model import BELLY, CHEST, CHEST_BACK, ScatteringBody
from mmweaver.propagation.cube_rendering import CubeRenderer
from mmweaver.propagation.image_method import static_points
from mmweaver.propagation.interference import interference
from mmweaver.propagation.mean_power import MeanEchoes, MeanPower
from mmweaver.propagation.occlusion import occluded, people_shadow
from mmweaver.propagation.paths import FrameClock, Paths, ScenePaths, StaticPaths
from mmweaver.propagation.receiver import BackgroundRecording, check_recording, quantise
from mmweaver.propagation.second_order import ROOM_MARGIN_M, BodyBodyPaths, BodyRoomPaths, PairSampling
from mmweaver.propagation.speckle import (
    place_of,
    sample_moving,
    sample_moving_segments,
    sample_static,
    strongest_first,
)
from mmweaver.propagation.static_paths import RayTracedRoom
from mmweaver.propagation.visible_body import BodyAtFrames, VisibleBody
from mmweaver.signal.cube import adc_from_cube, cube_values, static_samples, tdm_compensation
from mmweaver.signal.windows import doppler_window_middle

SKIN_POINTS = 200
SAMPLING = PairSampling(most_pairs=16, most_patches=100, every=5)  # parts of a stream begin at multiples of 5 frames


def second_order_paths(room: RayTracedRoom, motions: Sequence[FrameMotion], clock: FrameClock) -> Paths:
    """Second-order paths of all people.

    Args:
        room: The traced room.
        motions: Motion of each person.
        clock: Clock of the radar's frame.

    Returns:
        Paths (frame * segment, path).
    """
    seen = [_seen(room, motion, [one for one in motions if one is not motion], clock) for motion in motions]
    people = [BodyRoomPaths(one, SAMPLING) for one in seen]
    between = [BodyBodyPaths(*pair) for pair in combinations(people, 2)]
    count, every = seen[0].num_frames, SAMPLING.every
    blocks = [slice(first, min(first + every, count)) for first in range(0, count, every)]
    sources = (
        [one.room_paths for one in people] + [pair.paths for pair in between] + [one.radar_paths for one in people]
    )
    each = [Paths.padded([source(block) for block in blocks]) for source in sources]
    return Paths.cat(each, dim=1)


def _seen(room: RayTracedRoom, motion: FrameMotion, others: list[FrameMotion], clock: FrameClock) -> VisibleBody:
    body = _body(motion.subject, motion.height_m, motion.girth)
    one = VisibleBody(room, body, BodyAtFrames.of(body, clock, motion.node_joints_m(clock), None, []))
    clear = room.is_clear(np.zeros(3), one.posed.place_m[:: SAMPLING.every], ROOM_MARGIN_M)
    one.visible &= np.repeat(clear, SAMPLING.every, axis=0)[: one.num_frames]
    for other in others:
        one.visible &= ~occluded(_tensor(one.posed.place_m), other.middle_joints_m).numpy()
    return one


@lru_cache(maxsize=32)
def _body(subject: int, height_m: float, girth: float) -> ScatteringBody:
    return ScatteringBody(subject, height_m, SKIN_POINTS, girth=girth)


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(values).float()


NOTICED = 4e-3  # amplitude relative to the strongest static path; occlusion of fainter ones is negligible
ADC_FRAMES_AT_ONCE = 20


class LearnedRoom:
    """A room encoded by the network for one radar; `paths`, `cube` and `signal` serve any number of motions.

    Args:
        network: Moved to `device`; phases are sampled and paths rendered on the CPU.
        room: A scene, or one prepared for this radar with the antenna positions of the board.
        config: The radar.
        room_seed: Seed of the phases of surfaces and of clutter.
        device: Where the network runs.
        background: Recording of the empty room by this radar, whose static clutter is used.
        board: Board whose errors the signal has; by default an ideal one.

    Raises:
        InputError: If the background recording is from another radar.
    """

    def __init__(
        self,
        network: ScattererNetwork,
        room: Scene | GivenRoom,
        config: RadarConfig,
        *,
        room_seed: int = 0,
        device: str = "cpu",
        background: RadarCube | None = None,
        board: Board | None = None,
    ):
        self.network, self.nominal, self.device = network.to(device), config, device
        self.board = None if board is None or board.is_ideal else BoardEffects(board, config)
        config = config if self.board is None else self.board.radar
        self.config = config
        self.given = room if isinstance(room, GivenRoom) else GivenRoom.of(room, config, seed=room_seed)
        self.radar, self.renderer = MeanPower(config), CubeRenderer(config, self.board)
        self.noise_power, self.background = self.radar.noise, None
        gain = np.repeat(config.tx_noise_gain / config.tx_noise_gain.mean(), config.num_rx)
        # (doppler, antenna), or (range, doppler, antenna)
        self._noise_factor = (np.sqrt(gain) * tdm_compensation(config)).astype(np.complex64)
        if self.board is not None and self.board.has_filter:
            share = (config.first_range_bin + np.arange(config.num_range_bins)) / config.num_samples
            at_range = self.board.noise_gain(share).astype(np.float32)
            self._noise_factor = at_range[:, None, None] * self._noise_factor
        with torch.inference_mode(), one_thread():
            self.code = self._encoded(self.given.view[None].to(device))
            static = sample_static(self.code.static[0].to("cpu"), config, room_seed)
            self.static = strongest_first(StaticPaths.cat([static, self.given.others]) if self.has_others else static)
            size = self.static.amplitude.abs()
            self._num_noticed = int((size > NOTICED * size[0]).sum())
            if self.board is not None:
                self.static = self.board.recorded_static(self.static)
            if background is not None:
                check_recording(background, self.nominal)
                expected = self.radar.maps(static_points(self.static, self.radar.response)).range_azimuth
                self.background = BackgroundRecording.of(background, expected, self.radar)
                self.static = self.background.conditioned(self.static, self.renderer)
                self.noise_power = self.background.noise_power
            response = self.renderer.static(self.static)
            self.layer = response.layer() if self.background is None else self.background.static  # (range, antenna)
            self._noticed = response[: self._num_noticed]
            if self.board is not None:
                turn = 2j * math.pi / config.wavelength_m * self.static.length_m.mean(dim=(1, 2))
                self._layer_rate = response.scaled(turn.to(torch.complex64)).layer()  # by the carrier's drift
                if background is None:
                    self.layer = self.layer + self.renderer.leakage(*self.board.leakage)
                    self._layer_rate = self._layer_rate + self.renderer.leakage(*self.board.leakage_rate)
        self._synthesis: tuple[AdcSynthesis, Tensor] | None = None

    has_others = True  # whether second-order paths and clutter, which the network has not learned, are added by physics

    def _encoded(self, view: SceneTensors) -> Any:
        return self.network.encode_room(view)

    def paths(self, motions: Sequence[FrameMotion]) -> ScenePaths:
        """Paths of the room and of all people, who occlude the room and each other.

        Args:
            motions: Motion of each person; none gives one frame of the empty room.
        """
        with torch.inference_mode(), one_thread():
            return self._paths(motions) if motions else self._empty_room_paths(1)

    def _paths(self, motions: Sequence[FrameMotion], first_frame: int = 0) -> ScenePaths:
        if not motions:
            raise ValueError("without people the number of frames is not known; see `_empty_room_paths`")
        moving = [
            self._moving(motion, [one for one in motions if one is not motion], first_frame) for motion in motions
        ]
        if self.given.traced.propagation.bounces > 1 and self.has_others:
            moving.append(second_order_paths(self.given.traced, motions, self.renderer.clock))
        starts_m = [motion.start_joints_m(self.renderer.clock) for motion in motions]
        hidden = torch.zeros(len(starts_m[0]), len(self.static))
        noticed = self.static[: self._num_noticed]
        hidden[:, : self._num_noticed] = people_shadow(noticed, starts_m, self.config.wavelength_m)
        return ScenePaths(static=self.static, moving=Paths.cat(moving, 1), occluded=hidden)

    def _empty_room_paths(self, num_frames: int) -> ScenePaths:
        rows = num_frames * len(self.renderer.clock.segments)
        hidden = torch.zeros(num_frames + 1, len(self.static))
        return ScenePaths(static=self.static, moving=Paths.padded([Paths.none()] * rows), occluded=hidden)

    def _moving(self, motion: FrameMotion, others: list[FrameMotion], first_frame: int) -> Paths:
        """Paths (frame * segment, path) of one person, without those that others occlude."""
        clock = self.renderer.clock
        joints, velocity = motion.segments(clock)
        count = joints.shape[1]
        wanted = None
        if motion.num_before:
            wanted = torch.arange(motion.num_before, len(joints), device=self.device)[None]
        each = []
        for index in range(count):  # the frames of one segment form a sequence at the frame rate of training
            at = joints[None, :, index], velocity[None, :, index]
            on_device = (part.to(self.device) for part in at)
            each.append(self.network.moving(self.code, *on_device, frames=wanted)[0].to("cpu"))
        joints = joints[motion.num_before :]
        echoes = MeanEchoes.stack(each).map(lambda tensor: tensor.transpose(0, 1))  # (frame, segment, echo)
        others_m = [other.segments(clock)[0][other.num_before :] for other in others]
        shown = [
            self._shown(one, joints[:, index], [other[:, index] for other in others_m])
            for index, one in enumerate(each)
        ]
        passed = 10 ** (-motion.cover_db / 10)
        echoes = replace(echoes, cross_section_m2=echoes.cross_section_m2 * torch.stack(shown, 1) * passed)
        if motion.trunk_m is not None and motion.trunk_mps is not None:
            share = trunk_share(joints)
            late_m, late_mps = (
                share @ torch.from_numpy(part).float().unflatten(0, (-1, count))[motion.num_before :, :, :, None]
                for part in (motion.trunk_m, motion.trunk_mps)
            )
            echoes = replace(
                echoes, range_m=echoes.range_m - late_m[..., 0], velocity_mps=echoes.velocity_mps - late_mps[..., 0]
            )
        return self._sampled(echoes, joints, motion.subject, first_frame)

    def _sampled(self, echoes: MeanEchoes, joints_m: Tensor, subject: int, first_frame: int) -> Paths:
        """Paths (frame * segment, path) of a person's echoes (frame, segment, echo), with sampled phases."""
        count = joints_m.shape[1]
        sight = aspect(joints_m.flatten(0, 1)).unflatten(0, (-1, count))
        if count == 1:
            return self._retimed(sample_moving(echoes[:, 0], sight[:, 0], self.config, subject))
        middle_s = torch.from_numpy(self.renderer.clock.middle_s)
        return sample_moving_segments(echoes, sight, middle_s, self.config, subject)

    def _shown(self, echoes: MeanEchoes, joints_m: Tensor, others_m: list[Tensor]) -> Tensor:
        """1 where no other person occludes an echo (frame, echo), 0 elsewhere; others' joints are (frame, 22, 3) each.

        A ghost is lost where its joint is occluded, since its departure or its arrival leads straight there.
        """
        ends_m = self._ends_m(echoes, joints_m)
        hidden = torch.zeros(ends_m.shape[:2], dtype=torch.bool)
        for other_m in others_m:
            hidden |= occluded(ends_m, other_m)
        return (~hidden).float()

    def _ends_m(self, echoes: MeanEchoes, joints_m: Tensor) -> Tensor:
        """Places (frame, echo, 3) to which the line of sight must be clear for an echo to exist."""
        reflected_m = joints_m[:, MIRRORED].repeat(1, NUM_GHOSTS // len(MIRRORED), 1)
        return torch.cat([place_of(echoes).float()[:, :NUM_ANCHORS], reflected_m], dim=1)

    def _retimed(self, paths: Paths) -> Paths:
        """Moves paths from the first chirp of the middle loop to the middle of all chirps."""
        clock = self.renderer.clock
        middle_loop = doppler_window_middle(self.config.num_loops)
        late_s = clock.middle_s[0] - (clock.chirp_s.min() + middle_loop * self.config.loop_period_s)

        def moved(end):
            return replace(end, position_m=end.position_m + late_s * end.velocity_mps)

        return replace(paths, departure=moved(paths.departure), arrival=moved(paths.arrival))

    def cube(self, motions: Sequence[FrameMotion], *, seed: int) -> RadarCube:
        """The cube of all people and the room, with occlusion and receiver noise.

        Args:
            motions: Motion of each person; at least one.
            seed: Seed of noise and drift.

        Returns:
            Cube in sqrt(mW), or in the units of the background recording.
        """
        return self.signal(motions, seed=seed, keep_adc=False)[0]

    def signal(
        self,
        motions: Sequence[FrameMotion],
        *,
        seed: int,
        keep_adc: bool,
        first_frame: int = 0,
        num_frames: int | None = None,
    ) -> tuple[RadarCube, AdcCube | None]:
        """The cube, and optionally ADC samples of the same paths and noise.

        Args:
            motions: Motion of each person; may be empty.
            seed: Seed of noise and drift.
            keep_adc: Whether ADC samples are computed; the cube does not depend on it.
            first_frame: Number of the first frame within a longer signal; each part has its own noise.
            num_frames: Number of frames; needed without motions only.

        Returns:
            The cube, and the samples or None.
        """
        with torch.inference_mode(), one_thread():
            paths = self._paths(motions, first_frame) if motions else self._empty_room_paths(num_frames or 1)
            count = len(paths.occluded) - 1
            grid = CubeGrid.of(self.nominal, count, first_frame)
            frames, layer = first_frame + np.arange(count), self.layer
            paths = self.given.things.added(paths, frames, self.renderer.clock, self.given.traced)
            if self.board is not None:
                paths = replace(paths, moving=self.board.recorded_moving(paths.moving, frames, seed))
                drift = torch.from_numpy(self.board.drift(frames, seed)).to(torch.complex64)
                layer = layer + drift[:, None, None] * self._layer_rate
            part = (first_frame,) if first_frame else ()
            noise = cell_noise(stream(seed, "scatterer field noise", *part), self.config, count)
            noise *= np.float32(math.sqrt(self.noise_power)) * self._noise_factor
            values = self.renderer.moving(paths.moving)
            lost = self._noticed.layers(paths.occluded[:, : self._num_noticed])
            self.renderer.add_static(values, layer - lost[:-1])
            self.renderer.add_ramp(values, lost[:-1] - lost[1:])
            values += torch.from_numpy(noise)
            interferers, bursts = self.given.scene.interferers, None
            if interferers:
                bursts = interference(interferers, self.given.scene.radar_pose, self.nominal, frames, seed)
                values += torch.from_numpy(cube_values(bursts, self.config))
            cube = RadarCube(values=values.numpy(), grid=grid, config=self.nominal, scale=1.0)
            adc = self._adc(paths, replace(cube, values=noise), seed, first_frame, bursts) if keep_adc else None
        unit = 1.0 if self.background is None else self.background.unit
        if unit == 1.0:
            return cube, adc
        cube = replace(cube, values=cube.values / np.float32(unit), scale=unit)
        return cube, None if adc is None else replace(adc, samples=adc.samples / np.float32(unit), scale=unit)

    def _adc(
        self, paths: ScenePaths, noise: RadarCube, seed: int, first_frame: int, bursts: np.ndarray | None
    ) -> AdcCube:
        """ADC samples of the paths and of interference, with noise whose cube is `noise`, white outside its cells."""
        config = self.config
        if self._synthesis is None:
            synthesis = AdcSynthesis(config, board=self.board, is_faded=True)
            self._synthesis = synthesis, self._static_adc(synthesis)
        synthesis, static = self._synthesis
        frames, count = len(paths.occluded) - 1, len(synthesis.clock.segments)
        samples = np.empty(
            (frames, config.num_loops, config.num_slots, config.num_rx, config.num_samples), np.complex64
        )
        for first in range(0, frames, ADC_FRAMES_AT_ONCE):
            some = slice(first, min(first + ADC_FRAMES_AT_ONCE, frames))
            moving = paths.moving[some.start * count : some.stop * count]
            here = replace(paths, moving=moving, occluded=paths.occluded[some.start : some.stop + 1])
            still = static
            if self.board is not None:
                drift = self.board.drift(first_frame + np.arange(some.start, some.stop), seed)
                still = still + torch.from_numpy(drift).to(torch.complex64)[:, None, None, None] * self._drift_rate
            clean = synthesis.moving(moving) + (still[:, None] if still.dim() > 3 else still)
            synthesis.subtract_occluded(clean, here)
            if self.board is not None:
                clean[:, 0, self.board.first_slot] *= self.board.first_chirp
            clean = clean.numpy() + self._sample_noise(noise.values[some], first_frame + first, seed)
            clean = clean if bursts is None else clean + bursts[some]
            samples[some] = clean if config.complex_samples else np.real(clean)
        count_sqrt_mw = config.adc_count_sqrt_mw if self.background is None else self.background.count_sqrt_mw
        quantise(torch.from_numpy(samples), count_sqrt_mw)
        return AdcCube(samples=samples, config=self.nominal, scale=1.0)

    def _static_adc(self, synthesis: AdcSynthesis) -> Tensor:
        """Samples (tx, rx, sample) of the empty room."""
        if self.board is not None:
            carrier_over_slope_s = self.config.centre_frequency_hz / self.config.chirp_slope_hz_per_s
            self._drift_rate = carrier_over_slope_s * synthesis.static_rate(self.static)
        if self.background is None:
            static = synthesis.static(self.static)
            if self.board is None:
                return static
            self._drift_rate = self._drift_rate + synthesis.leakage(*self.board.leakage_rate)
            return static + synthesis.leakage(*self.board.leakage)
        return torch.from_numpy(static_samples(self.background.static.numpy(), self.config))

    def _sample_noise(self, cells: np.ndarray, first: int, seed: int) -> np.ndarray:
        """Noise (frame, loop, tx, rx, sample) whose cube is `cells` (frame, range, doppler, antenna).

        White noise minus its part in the cube's cells, plus the samples of least energy that give those cells.
        """
        config = self.config
        shape = (len(cells), config.num_loops, config.num_slots, config.num_rx, config.num_samples, 2)
        white = stream(seed, "learned receiver noise", first).standard_normal(shape, dtype=np.float32)
        power_mw = config.noise_power_mw if self.background is None else self.background.sample_noise_mw
        white = white.view(np.complex64)[..., 0] * np.float32(math.sqrt(power_mw / 2))
        if self.board is not None and self.board.has_filter:
            gain = self.board.noise_gain(np.arange(config.num_samples) / config.num_samples).astype(np.float32)
            white = np.asarray(fft.ifft(fft.fft(white) * gain))
        if not config.complex_samples:
            white = white.real.astype(np.complex64)
        missing = cells - cube_values(white, config)
        grid = CubeGrid.of(config, len(cells))
        own = adc_from_cube(RadarCube(values=missing, grid=grid, config=config, scale=1.0))
        return white + own.samples


def trunk_share(joints_m: Tensor) -> Tensor:
    """How far each echo moves towards the radar with the fronts of chest and belly, (..., echo, 2).

    Args:
        joints_m: Joints (..., 22, 3) in metres.
    """
    ahead = -(facing(joints_m) * torch.nn.functional.normalize(joints_m[..., joint("spine3"), :], dim=-1)).sum(-1)
    seen = ahead.clamp(min=0) + CHEST_BACK * (-ahead).clamp(min=0)
    parts = torch.tensor([[part.get(name, 0.0) for part in (CHEST, BELLY)] for name in JOINT_NAMES])
    of_body = anchor_places(parts).clamp(0, 1)
    of_ghosts = parts[list(MIRRORED)].repeat(NUM_GHOSTS // len(MIRRORED), 1) / 2  # one of two legs leads straight there
    return torch.cat([of_body, of_ghosts]) * seen[..., None, None]


def aspect(joints_m: Tensor) -> Tensor:
    """Twice the line of sight in the body's frame of reference, which determines the phase of its skin.

    Args:
        joints_m: Joints (frame, 22, 3).

    Returns:
        Components to the front, to the side and up, (frame, 3).
    """
    front = facing(joints_m)
    up = torch.tensor([0.0, 0.0, 1.0], device=joints_m.device).expand_as(front)
    side = torch.linalg.cross(up, front)
    sight = torch.nn.functional.normalize(joints_m[:, joint("pelvis")], dim=-1)
    return 2 * torch.stack([(sight * front).sum(-1), (sight * side).sum(-1), sight[:, 2]], dim=-1)
