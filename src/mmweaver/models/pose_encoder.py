"""Poses to z_pose: attention among the joints of a frame, then among frames.

Reference: paper, section "Generalization via Hypernetworks", Pose Encoder (4.9 M parameters).
"""

import math

import torch
from torch import Tensor, nn

from mmweaver.core.skeleton import NUM_JOINTS

Z_POSE = 512
JOINT_WIDTH, JOINT_LAYERS, JOINT_HIDDEN = 128, 2, 512
FRAME_LAYERS, FRAME_HIDDEN, HEADS = 2, 1024, 8
JOINT_VALUES = 6  # place and velocity


class PoseEncoder(nn.Module):
    """Encodes motions.

    (frame, 22, 6) -> FC -> + joint -> attention over joints -> mean | pelvis -> FC -> + time
                   -> attention over frames -> z_pose
    """

    def __init__(self) -> None:
        super().__init__()
        self.embed = nn.Linear(JOINT_VALUES, JOINT_WIDTH)
        self.joint = nn.Parameter(0.02 * torch.randn(NUM_JOINTS, JOINT_WIDTH))
        self.spatial = _attention(JOINT_WIDTH, JOINT_HIDDEN, JOINT_LAYERS)
        self.merge = nn.Linear(2 * JOINT_WIDTH, Z_POSE)
        self.temporal = _attention(Z_POSE, FRAME_HIDDEN, FRAME_LAYERS)

    def forward(self, motion: Tensor) -> Tensor:
        """Encodes motions.

        Args:
            motion: Joints and their velocities (sequence, frame, 22, 6).

        Returns:
            z_pose (sequence, frame, 512).
        """
        sequences, frames = motion.shape[:2]
        joints = self.spatial(self.embed(motion.flatten(0, 1)) + self.joint)
        each = self.merge(torch.cat([joints.mean(dim=1), joints[:, 0]], dim=-1)).unflatten(0, (sequences, frames))
        return self.temporal(each + _time_code(frames, Z_POSE, motion.device))


def _attention(width: int, hidden: int, layers: int) -> nn.TransformerEncoder:
    layer = nn.TransformerEncoderLayer(
        width, HEADS, hidden, dropout=0.0, activation="gelu", batch_first=True, norm_first=True
    )
    return nn.TransformerEncoder(layer, layers, enable_nested_tensor=False)


def _time_code(frames: int, width: int, device: torch.device) -> Tensor:
    """Sinusoidal position encoding of the frame number (Vaswani et al.)."""
    rate = torch.exp(torch.arange(0, width, 2, device=device) * (-math.log(1e4) / width))
    angle = torch.arange(frames, device=device)[:, None] * rate
    return torch.cat([angle.sin(), angle.cos()], dim=-1)
