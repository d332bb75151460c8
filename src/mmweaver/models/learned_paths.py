"""Room and motion -> signal by the network: what `method="weaver"` runs."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PoseSequence, RadarCube, Scene
from mmweaver.core.skeleton import joint
from mmweaver.dsp.point_response import Points
from mmweaver.fields.scatterers.scatterer_field import ScattererField
from mmweaver.models.background import BackgroundRecording
from mmweaver.models.body_anchors import facing
from mmweaver.models.network import SceneEncoding, WeaverNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.motion.animation.resample import joints_and_velocities
from mmweaver.paths.mean_power import MeanPower
from mmweaver.paths.occlusion import hidden
from mmweaver.paths.radar_equation import points_of
from mmweaver.paths.random_phases import field_of, sample_moving, sample_static


@dataclass(frozen=True, kw_only=True)
class FrameMotion:
    """One person at the middle of each radar frame: joints and their velocities, (frame, 22, 3)."""

    joints_m: np.ndarray
    velocity_mps: np.ndarray
    subject: int

    @classmethod
    def of(cls, pose: PoseSequence, config: RadarConfig, num_frames: int) -> "FrameMotion":
        """A dense motion at so many radar frames."""
        time_s = np.arange(num_frames) * config.frame_period_s + config.active_time_s / 2
        joints_m, velocity_mps = joints_and_velocities(pose, time_s)
        return cls(joints_m=joints_m, velocity_mps=velocity_mps, subject=pose.subject)


class LearnedRoom:
    """A room that the network has encoded for one radar; `field` may then be asked for many motions.

    The network runs on `device` and is moved there; phases are drawn and echoes rendered on the CPU. `empty`: a
    recording of the room by this radar with nobody there, which what rests is then taken from. Raises InputError for
    one of another radar.
    """

    def __init__(
        self,
        network: WeaverNetwork,
        scene: Scene | SceneTensors,
        config: RadarConfig,
        *,
        room_seed: int = 0,
        device: str = "cpu",
        empty: RadarCube | None = None,
    ):
        self.network, self.config, self.device = network.to(device), config, device
        self.radar = MeanPower(config)
        view = scene if isinstance(scene, SceneTensors) else SceneTensors.of(scene, config)
        with torch.inference_mode(), one_thread():
            self.code: SceneEncoding = network.encode_room(view[None].to(device))
            resting = self.code.resting[0].to("cpu")
            self._drawn = sample_static(resting, self.radar.response, room_seed)
            self.empty: BackgroundRecording | None = None
            if empty is not None:
                expected = self.radar.maps(points_of(resting, self.radar.response)).range_azimuth
                self.empty = BackgroundRecording.of(empty, expected, self.radar)
                self._drawn = self.empty.conditioned(self._drawn)
                self.radar.noise = self.empty.noise_power
            self._strong = resting[self._drawn.strong]
            self.static = self._drawn.layer()

    def field(self, motions: Sequence[FrameMotion]) -> ScattererField:
        """The field of everybody's motion; people are superimposed and hide neither each other nor the room."""
        with torch.inference_mode(), one_thread():
            points = [self._points(motion) for motion in motions]
        together = Points.cat(points, 1)
        return field_of(self.static, together, self.config, len(together.range_bin), self.radar.noise)

    def cube(self, motions: Sequence[FrameMotion], *, seed: int) -> RadarCube:
        """The signal of everybody, the shadows they cast on the room, and the receiver's noise.

        In sqrt(mW), or in the units of the recording of the empty room.
        """
        field = self.field(motions)
        with torch.inference_mode(), one_thread():
            values = field.native()
            self._take_shadows_off(values, motions)
            cube = RadarCube(values=values, grid=field.grid, config=self.config, scale=1.0)
        whole = field.with_noise(cube, seed)
        if self.empty is None:
            return replace(whole, scale=1.0)
        return replace(whole, values=whole.values / np.float32(self.empty.unit), scale=self.empty.unit)

    def _take_shadows_off(self, values: np.ndarray, motions: Sequence[FrameMotion]) -> None:
        """Takes off what the room does not return because somebody stands before it."""
        is_hidden = [hidden(self._strong, torch.from_numpy(motion.joints_m).float()) for motion in motions]
        lost = self._drawn.hidden(torch.stack(is_hidden).any(dim=0))
        response = self.radar.response
        axes = response.axes()
        at_rest = response.doppler_kernel(axes.doppler_bin)[0]
        bins = torch.nonzero(at_rest.abs() > 1e-6)[:, 0]  # a resting echo has three
        turn = response.turn(axes)[:, bins]
        values[:, :, bins.numpy()] -= (lost[:, :, None] * (at_rest[bins][:, None] * turn)).numpy()

    def _points(self, motion: FrameMotion) -> Points:
        joints, velocity = torch.from_numpy(motion.joints_m).float(), torch.from_numpy(motion.velocity_mps).float()
        moving = self.network.moving(self.code, joints[None].to(self.device), velocity[None].to(self.device))
        return sample_moving(moving[0].to("cpu"), aspect(joints), self.radar.response, motion.subject)


@contextmanager
def one_thread() -> Iterator[None]:
    """20 frames are 30 ms of one thread; several are hardly quicker, and on a busy machine a hundred times slower."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def aspect(joints_m: Tensor) -> Tensor:
    """Twice the line of sight as the body sees it (front, side, up), (frame, 3): what turns the phase of its skin."""
    front = facing(joints_m)
    up = torch.tensor([0.0, 0.0, 1.0], device=joints_m.device).expand_as(front)
    side = torch.linalg.cross(up, front)
    sight = torch.nn.functional.normalize(joints_m[:, joint("pelvis")], dim=-1)
    return 2 * torch.stack([(sight * front).sum(-1), (sight * side).sum(-1), sight[:, 2]], dim=-1)
