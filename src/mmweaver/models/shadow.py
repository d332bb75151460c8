"""The resting echoes that a body hides: it stands between the radar and them.

No numbers are needed for it: joints and the room's points say it. Reference: decision 97.
"""

import torch
from torch import Tensor

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.models.body_anchors import ANCHORS, anchor_places
from mmweaver.models.echoes import Echoes

TRUNK_M, LIMB_M, HEAD_M = 0.13, 0.055, 0.1
_TRUNK = ("pelvis", "spine", "neck", "collar", "shoulder", "hip")
NUM_BALLS = 30  # the joints and the middles of thighs, shins and arms; those of the trunk lie between joints' balls
BEHIND_M = 0.1  # farther than the body at least


def hidden(resting: Echoes, joints_m: Tensor) -> Tensor:
    """Which resting echoes (echo,) the body of joints (frame, 22, 3) hides: (frame, echo) bool.

    The body is a ball about each of its first anchors; a ray that passes through one does not come back.
    """
    ahead = (1 - resting.direction.square().sum(-1)).clamp(min=0).sqrt()
    way = torch.stack([resting.direction[:, 0], ahead, resting.direction[:, 1]], dim=-1)
    place = anchor_places(joints_m)[:, :NUM_BALLS]
    distance = place.norm(dim=-1)
    radius = _radii().to(place)
    out = torch.zeros(len(joints_m), len(way), dtype=torch.bool, device=place.device)
    for frame, (anchors, far) in enumerate(zip(place, distance, strict=True)):
        axis = torch.nn.functional.normalize(anchors.mean(dim=0), dim=0)
        reach = ((anchors / far[:, None]) @ axis).min() - 0.05
        near = torch.nonzero(way @ axis > reach)[:, 0]
        along = way[near] @ anchors.T  # of each ray to its nearest point to each anchor
        beside = far.square() - along.square()
        is_hit = (beside < radius.square()) & (along > 0) & (resting.range_m[near, None] > far + BEHIND_M)
        out[frame, near] = is_hit.any(dim=-1)
    return out


def _radii() -> Tensor:
    names = [JOINT_NAMES[second] for _, second, _ in ANCHORS[:NUM_BALLS]]
    return torch.tensor([_radius(name) for name in names])


def _radius(name: str) -> float:
    if name == "head":
        return HEAD_M
    return TRUNK_M if any(part in name for part in _TRUNK) else LIMB_M
