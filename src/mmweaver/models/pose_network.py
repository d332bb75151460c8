"""Estimates a person's joints from radar points, frame by frame.

    points (frame, 40, 5) --the same layers for each--> --largest, mean over points--> (frame, 320)--+
                                                                                                     |
    joints (frame, 22, 3) <--layers, around a mean pose-- recurrent, forwards and backwards <--------+

A PointNet (Qi et al., CVPR 2017) over the points of a frame and a gated recurrent unit over frames; 0.4 M parameters.
"""

from itertools import pairwise
from pathlib import Path

import torch
from torch import Tensor, nn

from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.point_frames import COLUMNS
from mmweaver.models.weights import WeightsCard, load_into

POINT_WIDTHS = (48, 96, 160)
MEMORY, HEAD = 112, 192
USUAL_POINTS, USUAL_DB, USUAL_M, USUAL_MPS = 30.0, 10.0, 0.4, 0.4  # typical values, which normalise the inputs
RECIPE = "pose"


class PoseNetwork(nn.Module):
    """From windows of points to joints relative to the pelvis, and the position of the pelvis."""

    mean_m: Tensor

    def __init__(self) -> None:
        super().__init__()
        widths = (COLUMNS, *POINT_WIDTHS)
        layers = [(nn.Linear(a, b), nn.ReLU()) for a, b in pairwise(widths)]
        self.points = nn.Sequential(*(layer for pair in layers for layer in pair))
        # Features of frames differ little; without normalisation, training stalls for hundreds of steps.
        self.evened = nn.BatchNorm1d(2 * POINT_WIDTHS[-1])
        self.over_time = nn.GRU(2 * POINT_WIDTHS[-1] + 4, MEMORY, batch_first=True, bidirectional=True)
        self.head = nn.Sequential(
            nn.Linear(2 * MEMORY + 2 * POINT_WIDTHS[-1], HEAD), nn.ReLU(), nn.Linear(HEAD, 3 * NUM_JOINTS + 3)
        )
        self.register_buffer("mean_m", torch.zeros(NUM_JOINTS, 3))

    def forward(self, values: Tensor, is_there: Tensor, middle_m: Tensor) -> tuple[Tensor, Tensor]:
        """Estimates joints.

        Args:
            values: Points (window, frame, point, 5) with the columns of `point_frames`.
            is_there: Mask (window, frame, point) of actual points.
            middle_m: Position of the person in each window, (window, 3), in metres.

        Returns:
            Joints relative to the pelvis (window, frame, 22, 3), and the pelvis (window, frame, 3), in metres.
        """
        place = (values[..., :3] - middle_m[:, None, None]) / USUAL_M
        read = torch.cat([place, values[..., 3:4] / USUAL_MPS, values[..., 4:] / USUAL_DB], dim=-1)
        each = self.points(read[is_there])  # of actual points, frame by frame; never negative
        frame = is_there.flatten(0, 1).nonzero()[:, :1].expand(-1, each.shape[-1])
        nothing = each.new_zeros(values.shape[0] * values.shape[1], each.shape[-1])
        count = is_there.sum(dim=2, keepdim=True)
        largest = nothing.scatter_reduce(0, frame, each, "amax").unflatten(0, values.shape[:2])
        mean = nothing.scatter_add(0, frame, each).unflatten(0, values.shape[:2]) / count.clamp(min=1)
        seen = self.evened(torch.cat([largest, mean], dim=-1).flatten(0, 1)).unflatten(0, values.shape[:2])
        radar = middle_m[:, None].expand(-1, values.shape[1], -1)
        after, _ = self.over_time(torch.cat([seen, count / USUAL_POINTS, radar], dim=-1))
        moved = self.head(torch.cat([after, seen], dim=-1))
        joints = self.mean_m + moved[..., :-3].unflatten(-1, (NUM_JOINTS, 3))
        return joints - joints[..., :1, :], moved[..., -3:] + middle_m[:, None]


def load_pose(file: Path) -> tuple[PoseNetwork, WeightsCard]:
    """Loads weights of recipe `pose`.

    Args:
        file: The weight file.

    Returns:
        The network and its card.

    Raises:
        InputError: For any other file.
    """
    network = PoseNetwork()
    return network, load_into(network, file, recipe=RECIPE)
