"""What a body stands in front of, from joints alone: the average body's capsules, without a ray caster.

Reference: decision 97.
"""

import torch
from torch import Tensor

from mmweaver.paths.body_model import average_body

WIDEST_M = 0.2  # from a bone to the skin at most
BEHIND_M = 0.1  # farther than the body at least
CORNERS = 0.93  # mean radius of a hull of six corners, by which the ray tracer's bodies occlude


def occluded(ends_m: Tensor, joints_m: Tensor) -> Tensor:
    """Whether the body of joints (frame, 22, 3) blocks the line from the radar to places (path, 3) or (frame, path, 3).

    Returns (frame, path) bool. The body has the capsules of the ray tracer, about the bones of a person of average
    height.
    """
    body = average_body()
    posed = body.posed(joints_m.double().cpu().numpy())
    starts, axes, rotations = (torch.from_numpy(part).float() for part in (posed.start_m, posed.axis_m, posed.rotation))
    radius = CORNERS * torch.from_numpy(body.radii_m).float()
    width = torch.from_numpy(body.widths).float()
    ends = ends_m.cpu().float().expand(len(starts), *ends_m.shape[-2:])
    distance = ends.norm(dim=-1)
    out = torch.zeros(ends.shape[:2], dtype=torch.bool)
    rays = ends / distance.clamp(min=1e-6)[..., None]
    for row, ray, far, start, axis, right in zip(
        out, rays, distance - BEHIND_M, starts, axes, rotations[..., 0], strict=True
    ):
        near = _towards(ray, start, start + axis)
        row[near] = _met(ray[near], far[near], radius, width, start, axis, right)
    return out.to(joints_m.device)


def _towards(rays: Tensor, *ends_m: Tensor) -> Tensor:
    """Indices of the unit vectors (ray, 3) within the cone that the body fills, its flesh included."""
    ends = torch.cat(ends_m)
    distance = ends.norm(dim=-1)
    unit = ends / distance[:, None]
    middle = torch.nn.functional.normalize(unit.mean(dim=0), dim=0)
    widest = torch.acos((unit @ middle).min().clamp(-1, 1)) + torch.asin((WIDEST_M / distance.min()).clamp(max=1.0))
    return torch.nonzero(rays @ middle > torch.cos(widest.clamp(max=torch.pi)))[:, 0]


def _met(
    rays: Tensor, far_m: Tensor, radius_m: Tensor, width: Tensor, start_m: Tensor, axis_m: Tensor, right: Tensor
) -> Tensor:
    """Whether each ray (ray, 3) comes nearer to a capsule (capsule, 3) than its radius before it gets `far_m`."""
    along, begun, across_m = rays @ axis_m.T, rays @ start_m.T, rays @ right.T  # (ray, capsule)
    length2, slope = axis_m.square().sum(-1), (axis_m * start_m).sum(-1)
    # the point of the bone nearest to the ray, both seen along the ray
    share = ((along * begun - slope) / (length2 - along.square()).clamp(min=1e-9)).clamp(0, 1)
    gone = begun + share * along
    sideways = (start_m * right).sum(-1) + share * (axis_m * right).sum(-1) - gone * across_m
    gap2 = start_m.square().sum(-1) + share * (2 * slope + share * length2) - gone.square()
    reach = radius_m[:, 0] + share * (radius_m[:, 1] - radius_m[:, 0])
    met = gap2 - sideways.square() * (1 - width**-2) < reach.square()
    return (met & (gone > 0) & (gone < far_m[:, None])).any(dim=-1)
