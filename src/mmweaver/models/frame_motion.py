"""One person at the middle of each radar frame: the motion input of the network.

Input maps of networks: range-Doppler and range-azimuth power in decibels above the receiver's noise.

Everything is scaled by constants of the radar, not of the sequence, so the absolute strength of a signal is
preserved. Differentiable with respect to the cube.
"""

import math
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.body_capsules import REFERENCE_HEIGHT_M
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import AT_CAMERA, RadarPose
from mmweaver.core.records import PoseSequence
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.motion.animation.root_path import joints_and_velocities
from mmweaver.motion.physiology import Physiology
from mmweaver.propagation.paths import FrameClock
from mmweaver.signal.windows import noise_share

NUM_AZIMUTHS, WIDEST_DEG = 32, 60.0
NUM_ANGLE_MAPS = 2  # all echoes, and the moving ones
MIDDLE_DB, SPREAD_DB = 20.0, 15.0  # offset and scale that normalise decibels above the noise
STATIC_BINS = 1  # on either side of zero Doppler, to which a Hann window spreads static clutter


class LogMaps(nn.Module):
    """Normalised log power maps of cubes, in units of 15 dB about 20 dB above the noise."""

    def __init__(self, config: RadarConfig):
        super().__init__()
        place = config.antenna_position_m
        row = azimuth_row(place, config.wavelength_m)
        sine = torch.linspace(-WIDEST_DEG, WIDEST_DEG, NUM_AZIMUTHS).deg2rad().sin()
        x = torch.tensor(2 * math.pi / config.wavelength_m * place[row, 0], dtype=torch.float32)
        moving = (torch.arange(config.num_loops) - config.num_loops // 2).abs() > STATIC_BINS
        self.noise_mw = config.noise_power_mw * noise_share(config.num_samples, config.num_loops)
        self.row: Tensor
        self.steering: Tensor
        self.is_moving: Tensor
        self.register_buffer("row", torch.from_numpy(row.astype("int64")), persistent=False)
        self.register_buffer("steering", torch.polar(torch.ones(()), x[:, None] * sine) / len(row), persistent=False)
        self.register_buffer("is_moving", moving.float(), persistent=False)

    def forward(self, values: Tensor) -> tuple[Tensor, Tensor]:
        """Computes the maps.

        Args:
            values: Cubes (..., range, doppler, antenna), complex, in sqrt(mW).

        Returns:
            Range-Doppler maps (..., 1, range, doppler), and range-azimuth maps (..., 2, range, azimuth) of all echoes
            and of moving ones.
        """
        power = values.abs().square().mean(dim=-1)
        beams = (values[..., self.row] @ self.steering).abs().square()
        count = float(len(self.is_moving))
        everything, moving = beams.sum(dim=-2), (beams * self.is_moving[:, None]).sum(dim=-2)
        noise = self.noise_mw * count / len(self.row)
        angle = torch.stack([everything, moving], dim=-3)
        return _numbers(power / self.noise_mw)[..., None, :, :], _numbers(angle / noise)


def _numbers(ratio: Tensor) -> Tensor:
    return (10 * torch.log10(ratio + 1) - MIDDLE_DB) / SPREAD_DB


STEP_S = 1e-3  # of numerical velocities
HISTORY_FRAMES = 10  # before a part of a longer signal, as context of the pose encoder


@dataclass(frozen=True, kw_only=True)
class FrameMotion:
    """Joints and velocities (frame, 22, 3) of one person at the middle of each radar frame.

    With long chirp sequences, at the middle of each time segment: (frame * segment, 22, 3). The first `num_before`
    frames are context for the pose encoder, which looks at motion before and after a frame.
    """

    joints_m: np.ndarray
    velocity_mps: np.ndarray
    subject: int
    num_segments: int = 1
    num_before: int = 0
    height_m: float = REFERENCE_HEIGHT_M
    girth: float = 1.0
    trunk_m: np.ndarray | None = None  # outward displacement of chest and belly by breathing, (frame, 2), and its rate
    trunk_mps: np.ndarray | None = None
    cover_db: float = 0.0  # two-way loss of a blanket

    @classmethod
    def of(
        cls,
        pose: PoseSequence,
        config: RadarConfig,
        num_frames: int,
        first_frame: int = 0,
        physiology: Physiology | None = None,
        radar_pose: RadarPose = AT_CAMERA,
    ) -> "FrameMotion":
        """Samples a dense motion at radar frames, with preceding frames as context where the motion is known.

        Args:
            pose: The motion.
            config: The radar.
            num_frames: Number of frames.
            first_frame: Number of the first one, in the time of the motion.
            physiology: Sway, tremor, breathing and heartbeat of the person; by default none.
            radar_pose: Pose of the radar, for what is up.
        """
        middle_s = FrameClock(config).middle_s
        if len(middle_s) == 1:
            middle_s = np.array([config.active_time_s / 2])
        known = first_frame - int(np.ceil(pose.time_s[0] / config.frame_period_s - 1e-6))
        before = max(0, min(HISTORY_FRAMES, known, first_frame))
        frames = np.arange(first_frame - before, first_frame + num_frames)
        time_s = frames[:, None] * config.frame_period_s + middle_s
        joints_m, velocity_mps = joints_and_velocities(pose, time_s.ravel())
        trunk = {}
        if physiology is not None:
            level_m, late_m = (radar_pose.in_level_frame(part) for part in (joints_m, STEP_S * velocity_mps + joints_m))
            each = [(level_m, time_s.ravel()), (late_m, time_s.ravel() + STEP_S)]
            moved_m = [radar_pose.seen(physiology.moved(*one, pose.height_m)) for one in each]
            trunk_m = [physiology.trunk_m(*one, pose.height_m) for one in each]
            joints_m, velocity_mps = (
                moved_m[0].astype(np.float32),
                (moved_m[1] - moved_m[0]).astype(np.float32) / STEP_S,
            )
            trunk = {"trunk_m": trunk_m[0], "trunk_mps": (trunk_m[1] - trunk_m[0]) / STEP_S}
        return cls(
            **trunk,
            cover_db=pose.cover_db,
            joints_m=joints_m,
            velocity_mps=velocity_mps,
            subject=pose.subject,
            num_segments=len(middle_s),
            num_before=before,
            height_m=pose.height_m,
            girth=pose.girth,
        )

    def segments(self, clock: FrameClock) -> tuple[Tensor, Tensor]:
        """Joints and velocities (frame, segment, 22, 3), extrapolated if known at the middle of the frame only."""
        joints, velocity = (
            torch.from_numpy(part).float().unflatten(0, (-1, self.num_segments))
            for part in (self.joints_m, self.velocity_mps)
        )
        late_s = torch.from_numpy(clock.middle_s - clock.middle_s.mean()).float()
        if len(late_s) == self.num_segments:
            return joints, velocity
        return joints + velocity * late_s[:, None, None], velocity.expand(-1, len(late_s), -1, -1)

    @property
    def middle_joints_m(self) -> Tensor:
        """Joints at the middle of each frame, without context frames, float32 (frame, 22, 3)."""
        middle_m = self.joints_m[self.num_segments // 2 :: self.num_segments]
        return torch.from_numpy(middle_m[self.num_before :]).float()

    def start_joints_m(self, clock: FrameClock) -> Tensor:
        """Joints at the first node of each frame and one frame period after the last one's, (frame + 1, 22, 3)."""
        joints, velocity = (part[self.num_before :] for part in self.segments(clock))
        first_s = float(clock.middle_s[0] - clock.node_s[0])
        last_s = float(clock.config.frame_period_s + clock.node_s[0] - clock.middle_s[-1])
        starts = joints[:, 0] - velocity[:, 0] * first_s
        return torch.cat([starts, joints[-1:, -1] + velocity[-1:, -1] * last_s])

    def node_joints_m(self, clock: FrameClock) -> np.ndarray:
        """Joints at the clock's nodes, without context frames, (frame, node, 22, 3)."""
        joints_m, velocity_mps = (part[self.num_before :].double().numpy() for part in self.segments(clock))
        late_s = np.stack([segment.node_s for segment in clock.segments])[..., None, None]
        nodes_m = joints_m[:, :, None] + velocity_mps[:, :, None] * late_s
        return nodes_m.reshape(len(nodes_m), -1, *nodes_m.shape[3:])
