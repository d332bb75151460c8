"""The paper's hypernetwork: from photo and motion to the weights of an implicit neural representation.

    picture --EnvironmentEncoder--> z_env --+--> MLP --> theta (4,898) for all frames
    joints  ---PoseEncoder--------> z_pose -+         -> gamma(t), beta(t) (256 per frame)

Reference: paper, section "Generalization via Hypernetworks" and "Microbenchmarks" (2.1 M + 4.9 M, 14.73 M in all).
"""

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.inr.inr_field import InrField
from mmweaver.inr.networks import ModulatedINR
from mmweaver.models.environment_encoder import Z_ENV, EnvironmentEncoder
from mmweaver.models.pose_encoder import Z_POSE, PoseEncoder

TRUNK_WIDTH = 1088
UNIT_DB = 25.0  # the network's 1.0 above a sample's noise, the median peak; a constant, for it must hold in new rooms
MOTION_SCALE = 2.0  # metres, and metres per second


class HyperNetwork(nn.Module):
    """Pictures and motions -> weights and modulations of a `ModulatedINR` each.

    z_env is repeated over the frames and concatenated with z_pose; theta comes from the mean over the frames. gamma is
    initialised around 1, the rest as the layers' default.

    >>> network = HyperNetwork()
    >>> [sum(p.numel() for p in part.parameters()) for part in (network.environment, network.pose, network)]
    [2064300, 4737408, 14714446]
    """

    def __init__(self) -> None:
        super().__init__()
        self.environment, self.pose = EnvironmentEncoder(batch_norm=True), PoseEncoder()
        inr = ModulatedINR(num_frames=1)
        self.modulation_shape = inr.gamma.shape[1:]
        self.trunk = nn.Sequential(
            nn.Linear(Z_ENV + Z_POSE, TRUNK_WIDTH), nn.ReLU(), nn.Linear(TRUNK_WIDTH, TRUNK_WIDTH), nn.ReLU()
        )
        self.theta = nn.Linear(TRUNK_WIDTH, inr.theta.numel())
        self.modulation = nn.Linear(TRUNK_WIDTH, 2 * inr.gamma.numel())

    def forward(self, image: Tensor, motion: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Writes INRs.

        Args:
            image: Pictures (sequence, 5, row, column) of rooms.
            motion: Joints and velocities (sequence, frame, 22, 6), see `motion_input`.

        Returns:
            theta (sequence, 4898), gamma and beta (sequence, frame, 4, 32).
        """
        return self.write(self.environment(image)[0], self.pose(motion))

    def write(self, z_env: Tensor, z_pose: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """The same from codes (sequence, 512) of rooms and (sequence, frame, 512) of poses."""
        both = torch.cat([z_env[:, None].expand(-1, z_pose.shape[1], -1), z_pose], dim=-1)
        fused = self.trunk(both)
        gamma, beta = self.modulation(fused).unflatten(-1, (2, *self.modulation_shape)).unbind(-3)
        return self.theta(fused.mean(dim=1)), 1 + gamma, beta

    def field(self, image: Tensor, config: RadarConfig, joints_m: np.ndarray, velocity_mps: np.ndarray) -> InrField:
        """The INR of one room and motion.

        Args:
            image: Picture (5, row, column) of the room.
            config: The radar.
            joints_m: Joints (frame, 22, 3) in metres, in the radar's coordinates.
            velocity_mps: Their velocities.

        Returns:
            The field, on the CPU.

        Raises:
            InputError: For other joints.
        """
        if joints_m.shape != velocity_mps.shape or joints_m.shape[1:] != (22, 3):
            raise InputError(f"the network needs joints and velocities (frame, 22, 3), not {joints_m.shape}")
        device = self.theta.weight.device
        motion = motion_input(torch.from_numpy(joints_m), torch.from_numpy(velocity_mps))
        inr = ModulatedINR(len(joints_m))
        with torch.inference_mode():
            written = self(image[None].to(device), motion[None].to(device))
        for own, part in zip((inr.theta, inr.gamma, inr.beta), written, strict=True):
            own.data = part[0].float().cpu().clone()
        grid = CubeGrid.of(config, len(joints_m))
        return InrField(inr, config=config, grid=grid, scale=1.0, amplitude=unit_sqrt_mw(config), is_centred=False)


def motion_input(joints_m: Tensor, velocity_mps: Tensor) -> Tensor:
    """Input of the pose encoder, (..., frame, 22, 6), from joints in metres and velocities (..., frame, 22, 3)."""
    return torch.cat([joints_m, velocity_mps], dim=-1).float() / MOTION_SCALE


def unit_sqrt_mw(config: RadarConfig) -> float:
    """The value of the network's 1.0 in sqrt(mW): about the largest |I| or |Q| of a typical sequence."""
    return float(np.sqrt(config.noise_power_mw)) * 10 ** (UNIT_DB / 20)
