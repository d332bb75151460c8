"""The resting echoes that a body hides: it stands between the radar and them.

No numbers are needed for it: joints and the room's points say it. Reference: decision 97.
"""

import torch
from torch import Tensor

from mmweaver.paths.body_model import average_body
from mmweaver.paths.mean_paths import Echoes

WIDEST_M = 0.2  # from a bone to the skin at most
BEHIND_M = 0.1  # farther than the body at least
CORNERS = 0.93  # mean radius of a hull of six corners, which the simulator's shadows are cast by


def hidden(resting: Echoes, joints_m: Tensor) -> Tensor:
    """Which resting echoes (echo,) the body of joints (frame, 22, 3) hides: (frame, echo) bool.

    The body is the simulator's capsules about the bones of a person of middle height; a ray that meets one does not
    come back.
    """
    body = average_body()
    posed = body.posed(joints_m.double().cpu().numpy())
    starts, axes, rotations = (torch.from_numpy(part).float() for part in (posed.start_m, posed.axis_m, posed.rotation))
    ahead = (1 - resting.direction.square().sum(-1)).clamp(min=0).sqrt()
    ways = torch.stack([resting.direction[:, 0], ahead, resting.direction[:, 1]], dim=-1).cpu()
    radius = CORNERS * torch.from_numpy(body.radii_m).float()
    width = torch.from_numpy(body.widths).float()
    far = resting.range_m.cpu() - BEHIND_M
    out = torch.zeros(len(starts), len(ways), dtype=torch.bool)
    for row, start, axis, right in zip(out, starts, axes, rotations[..., 0], strict=True):
        near = _towards(ways, start, start + axis)
        row[near] = _met(ways[near], far[near], radius, width, start, axis, right)
    return out.to(joints_m.device)


def _towards(ways: Tensor, *ends_m: Tensor) -> Tensor:
    """The rays within the cone that the body fills, wide enough for its flesh too."""
    ends = torch.cat(ends_m)
    distance = ends.norm(dim=-1)
    unit = ends / distance[:, None]
    middle = torch.nn.functional.normalize(unit.mean(dim=0), dim=0)
    widest = torch.acos((unit @ middle).min().clamp(-1, 1)) + torch.asin((WIDEST_M / distance.min()).clamp(max=1.0))
    return torch.nonzero(ways @ middle > torch.cos(widest.clamp(max=torch.pi)))[:, 0]


def _met(
    ways: Tensor, far_m: Tensor, radius_m: Tensor, width: Tensor, start_m: Tensor, axis_m: Tensor, right: Tensor
) -> Tensor:
    """Whether each ray (ray, 3) comes nearer to a capsule (capsule, 3) than its radius before it gets `far_m`."""
    along, begun, across_m = ways @ axis_m.T, ways @ start_m.T, ways @ right.T  # (ray, capsule)
    length2, slope = axis_m.square().sum(-1), (axis_m * start_m).sum(-1)
    # the point of the bone nearest to the ray, both seen along the ray
    share = ((along * begun - slope) / (length2 - along.square()).clamp(min=1e-9)).clamp(0, 1)
    gone = begun + share * along
    sideways = (start_m * right).sum(-1) + share * (axis_m * right).sum(-1) - gone * across_m
    gap2 = start_m.square().sum(-1) + share * (2 * slope + share * length2) - gone.square()
    reach = radius_m[:, 0] + share * (radius_m[:, 1] - radius_m[:, 0])
    met = gap2 - sideways.square() * (1 - width**-2) < reach.square()
    return (met & (gone > 0) & (gone < far_m[:, None])).any(dim=-1)
