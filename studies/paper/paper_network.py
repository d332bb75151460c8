"""The paper's network: two encoders, and a hypernetwork that writes an implicit neural representation.

    picture --EnvironmentEncoder--> z_env --+--> MLP --> theta (4,898) for all frames
    joints  ---PoseEncoder--------> z_pose -+         -> gamma(t), beta(t) (256 a frame)

Reference: paper, section "Generalization via Hypernetworks" and "Implementation" (2.1 M + 4.9 M, 14.73 M in all).
"""

import itertools

import torch
from torch import Tensor, nn

from mmweaver.models.environment_encoder import Z_ENV, EnvironmentEncoder
from mmweaver.models.pose_encoder import Z_POSE, PoseEncoder
from studies.paper.paper_inr import HIDDEN_WIDTH, MODULATIONS_PER_FRAME, NUM_HIDDEN, InrShape

TRUNK_WIDTH = 1088


class Hypernetwork(nn.Module):
    """z_env (sequence, 512) and z_pose (sequence, frame, 512) -> theta (sequence, 4898) and gamma, beta.

    z_env is repeated over the frames and concatenated with z_pose; theta comes from the mean over the frames. gamma and
    beta are (sequence, frame, 4, 32); gamma is initialised around 1, the rest as the layers' default.
    """

    def __init__(self, shape: InrShape | None = None):
        super().__init__()
        self.shape = shape or InrShape()
        self.trunk = nn.Sequential(
            nn.Linear(Z_ENV + Z_POSE, TRUNK_WIDTH), nn.ReLU(), nn.Linear(TRUNK_WIDTH, TRUNK_WIDTH), nn.ReLU()
        )
        self.theta = nn.Linear(TRUNK_WIDTH, self.shape.num_weights)
        self.modulation = nn.Linear(TRUNK_WIDTH, MODULATIONS_PER_FRAME)

    def forward(self, z_env: Tensor, z_pose: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        both = torch.cat([z_env[:, None].expand(-1, z_pose.shape[1], -1), z_pose], dim=-1)
        fused = self.trunk(both)
        gamma, beta = self.modulation(fused).unflatten(-1, (2, NUM_HIDDEN, HIDDEN_WIDTH)).unbind(-3)
        return self.theta(fused.mean(dim=1)), 1 + gamma, beta


class PaperNetwork(nn.Module):
    """Pictures (sequence, 5, row, column) and motions (sequence, frame, 22, 6) -> theta, gamma, beta."""

    def __init__(self) -> None:
        super().__init__()
        self.environment = EnvironmentEncoder(batch_norm=True)
        self.pose = PoseEncoder()
        self.hypernetwork = Hypernetwork()

    def forward(self, image: Tensor, motion: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        z_env, _ = self.environment(image)
        return self.hypernetwork(z_env, self.pose(motion))


def evaluate_each(theta: Tensor, gamma: Tensor, beta: Tensor, encoded: Tensor, shape: InrShape) -> Tensor:
    """Many INRs at once: encoded coordinates (sequence, frame, point, 51) -> I and Q (sequence, frame, point, 2)."""
    act = torch.relu
    at, h = 0, encoded
    sizes = shape.sizes
    for index, (fan_in, fan_out) in enumerate(itertools.pairwise(sizes)):
        weight = theta[:, at : at + fan_in * fan_out].unflatten(-1, (fan_out, fan_in))
        bias = theta[:, at + fan_in * fan_out : at + (fan_in + 1) * fan_out]
        at += (fan_in + 1) * fan_out
        h = h @ weight[:, None].transpose(-1, -2) + bias[:, None, None]
        if index < NUM_HIDDEN:
            h = act(h * gamma[:, :, None, index] + beta[:, :, None, index])
    return h
