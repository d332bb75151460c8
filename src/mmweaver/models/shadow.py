"""The resting echoes that a body hides: it stands between the radar and them.

No numbers are needed for it: joints and the room's points say it. Reference: decision 97.
"""

import torch
from torch import Tensor

from mmweaver.models.body_prior import middling_body
from mmweaver.models.echoes import Echoes

BEHIND_M = 0.1  # farther than the body at least
CORNERS = 0.93  # mean radius of a hull of six corners, which the simulator's shadows are cast by


def hidden(resting: Echoes, joints_m: Tensor) -> Tensor:
    """Which resting echoes (echo,) the body of joints (frame, 22, 3) hides: (frame, echo) bool.

    The body is the simulator's capsules about the bones of a person of middle height; a ray that meets one does not
    come back.
    """
    body = middling_body()
    starts, axes, rotations = (torch.from_numpy(part).float() for part in body.frames(joints_m.double().cpu().numpy()))
    ahead = (1 - resting.direction.square().sum(-1)).clamp(min=0).sqrt()
    ways = torch.stack([resting.direction[:, 0], ahead, resting.direction[:, 1]], dim=-1).cpu()
    radius = CORNERS * torch.from_numpy(body.radii_m).float()
    width = torch.from_numpy(body.widths).float()
    far = resting.range_m.cpu() - BEHIND_M
    each = zip(starts, axes, rotations[..., 0], strict=True)
    return torch.stack([_met(ways, far, radius, width, *one) for one in each]).to(joints_m.device)


def _met(
    ways: Tensor, far_m: Tensor, radius_m: Tensor, width: Tensor, start_m: Tensor, axis_m: Tensor, right: Tensor
) -> Tensor:
    """Whether each ray (ray, 3) comes nearer to a capsule (capsule, 3) than its radius before it gets `far_m`."""
    along = ways @ axis_m.T  # (ray, capsule)
    begun = ways @ start_m.T
    # the point of the bone nearest to the ray, both seen along the ray
    across = axis_m.square().sum(-1) - along.square()
    share = ((along * begun - (axis_m * start_m).sum(-1)) / across.clamp(min=1e-9)).clamp(0, 1)
    gone = begun + share * along
    gap = start_m + share[..., None] * axis_m - gone[..., None] * ways[:, None]
    sideways = (gap * right).sum(-1)
    distance = (gap.square().sum(-1) - sideways.square() * (1 - width**-2)).clamp(min=0).sqrt()
    reach = radius_m[:, 0] + share * (radius_m[:, 1] - radius_m[:, 0])
    return ((distance < reach) & (gone > 0) & (gone < far_m[:, None])).any(dim=-1)
