"""What a field's coordinates are counted from: photographed surfaces, completed faces, and the parts of a body.

A cell of a field learns from these how much of each lies in it: area that is seen, area that faces the radar, joints
near it in range, velocity and direction. They follow from photo and joints alone, without any parameter of theirs but
the weights of body parts.
"""

import torch
from torch import Tensor, nn

from mmweaver.core.skeleton import BONES, NUM_JOINTS
from mmweaver.models.power_cells import REFERENCE
from mmweaver.models.scene_tensors import SceneTensors

# raster of the volume: first place, step and count along range and both direction cosines
FIRST, STEP, SHAPE = (0.0, -1.0, -1.0), (0.05, 0.0625, 0.125), (180, 33, 17)
FACING, SQUARE = 10.0, 100.0  # surfaces within 26 and 8 degrees of facing the radar
EDGE_PIXELS = 2  # to either side, over which a surface's normal is measured
FACE_POINTS = 24  # along each side of a completed face
LEAST_M2 = 1e-4
SURFACE_CHANNELS = 6
SURFACE_VALUES = 2 * SURFACE_CHANNELS

SCALES = (0.7, 1.5, 4.0)  # of reference cells, in which parts of a body count as near
HEADS = 4  # weighted sums of body parts at each scale
BODY_POINTS = NUM_JOINTS + len(BONES)
BODY_VALUES = HEADS * len(SCALES) + 4


def surface_volume(view: SceneTensors) -> Tensor:
    """Logarithms of areas (room, SURFACE_VALUES, range, cosine x, cosine z) that rooms show in each place.

    Of photographed pixels and of faces, each: all, facing the radar, square to it; then the same of the neighbourhood.
    """
    with torch.no_grad():
        pixels, faces = _splat(*_pixels(view)), _splat(*_faces(view))
        near = torch.cat([pixels, faces], 1)
        wide = nn.functional.avg_pool3d(near, 3, stride=1, padding=1)
        return ((torch.cat([near, wide], 1) + LEAST_M2) / LEAST_M2).log() / 4


def surface_values(volume: Tensor, at: Tensor) -> Tensor:
    """Values (room, place, SURFACE_VALUES) of the volume at (room, place, 3)."""
    first, last = at.new_tensor(FIRST), at.new_tensor(FIRST) + at.new_tensor(STEP) * (at.new_tensor(SHAPE) - 1)
    grid = (2 * (at - first) / (last - first) - 1).flip(-1)[:, :, None, None]
    found = nn.functional.grid_sample(volume, grid, mode="bilinear", padding_mode="border", align_corners=True)
    return found[..., 0, 0].transpose(1, 2)


def seen_surface(view: SceneTensors) -> tuple[Tensor, Tensor]:
    """Of each pixel: its place (room, 3, row, column) in the camera's frame, and the cosine of incidence there."""
    rows, columns = view.depth_m.shape[-2:]
    fx, fy, cx, cy = view.camera[:, :, None, None].unbind(1)
    x = (torch.arange(columns, device=fx.device) - cx) / fx
    y = (torch.arange(rows, device=fx.device)[:, None] - cy) / fy
    ray = torch.stack([x.expand(-1, rows, -1), y.expand(-1, -1, columns), torch.ones_like(view.depth_m)], 1)
    point = ray * view.depth_m[:, None]
    wide = nn.functional.pad(point, [EDGE_PIXELS] * 4, mode="replicate")
    step = slice(EDGE_PIXELS, -EDGE_PIXELS)
    across = wide[:, :, step, 2 * EDGE_PIXELS :] - wide[:, :, step, : -2 * EDGE_PIXELS]
    down = wide[:, :, 2 * EDGE_PIXELS :, step] - wide[:, :, : -2 * EDGE_PIXELS, step]
    normal = nn.functional.normalize(torch.linalg.cross(across, down, dim=1), dim=1)
    return point, (normal * point).sum(1).abs() / point.norm(dim=1).clamp(min=0.05)


def _pixels(view: SceneTensors) -> tuple[Tensor, Tensor, Tensor]:
    """Places (room, pixel, 3) in the radar's frame, areas (m2) square to the ray and cosines of incidence."""
    point, cosine = seen_surface(view)
    fx, fy = view.camera[:, :2, None, None].unbind(1)
    area = view.depth_m.square() / (fx * fy)
    return point.flatten(2).transpose(1, 2) @ view.camera_from_radar, area.flatten(1), cosine.flatten(1)


def _faces(view: SceneTensors) -> tuple[Tensor, Tensor, Tensor]:
    """The same of points on the flat faces, seen or completed."""
    step = (torch.arange(FACE_POINTS, device=view.plane_half_m.device) + 0.5) / FACE_POINTS * 2 - 1
    uv = torch.cartesian_prod(step, step)
    along = view.plane_half_m[:, :, None] * uv
    place = view.plane_centre_m[:, :, None] + along @ view.plane_axes[:, :, :2]
    normal = view.plane_axes[:, :, 2]
    cosine = (place * normal[:, :, None]).sum(-1).abs() / place.norm(dim=-1).clamp(min=0.05)
    area = (4 * view.plane_half_m.prod(-1) / FACE_POINTS**2)[..., None] * cosine
    return place.flatten(1, 2), area.flatten(1), cosine.flatten(1)


def _splat(place: Tensor, area: Tensor, cosine: Tensor) -> Tensor:
    """Areas shared out to the raster, (room, 3, range, cosine x, cosine z)."""
    distance = place.norm(dim=-1).clamp(min=0.05)
    unit = place / distance[..., None]
    spherical = torch.stack([distance, unit[..., 0], unit[..., 2]], -1)
    size = place.new_tensor(SHAPE).long()
    at = (spherical - place.new_tensor(FIRST)) / place.new_tensor(STEP)
    low = at.floor()
    is_ahead = (unit[..., 1] > 0) & (area > 0)
    weights = [area, area * (FACING * (cosine - 1) + 1).clamp(min=0), area * (SQUARE * (cosine - 1) + 1).clamp(min=0)]
    values = torch.stack(weights, -1) * is_ahead[..., None]
    volume = place.new_zeros((len(place), int(size.prod()), values.shape[-1]))
    for corner in torch.cartesian_prod(*[torch.arange(2, device=place.device)] * 3):
        node = low + corner
        share = (1 - (at - node).abs()).clamp(min=0).prod(-1) * ((node >= 0) & (node < size)).all(-1)
        node = node.long().clamp(min=0).minimum(size - 1)
        index = (node[..., 0] * size[1] + node[..., 1]) * size[2] + node[..., 2]
        volume.scatter_add_(1, index[..., None].expand_as(values), values * share[..., None])
    return volume.transpose(1, 2).unflatten(2, SHAPE)


def body_points(joints_m: Tensor, velocity_mps: Tensor) -> Tensor:
    """Range, radial velocity and direction cosines (..., BODY_POINTS, 4) of joints and middles of bones."""
    parent, child = torch.tensor(BONES, device=joints_m.device).T
    place, velocity = (
        torch.cat([part, (part[..., parent, :] + part[..., child, :]) / 2], -2) for part in (joints_m, velocity_mps)
    )
    distance = place.norm(dim=-1, keepdim=True).clamp(min=0.1)
    unit = place / distance
    return torch.cat([distance, (unit * velocity).sum(-1, keepdim=True), unit[..., [0, 2]]], dim=-1)


class BodyNearness(nn.Module):
    """How near places (field, place, 4) are to the parts of a body (field, BODY_POINTS, 4), which weigh as learned."""

    def __init__(self) -> None:
        super().__init__()
        self.weight_log = nn.Parameter(0.1 * torch.randn(len(SCALES), HEADS, BODY_POINTS))

    def forward(self, body: Tensor, at: Tensor) -> Tensor:
        """(field, place, BODY_VALUES): logarithms of weighted sums at each scale, and where the nearest parts lie."""
        off = (at[:, :, None] - body[:, None]) / at.new_tensor(REFERENCE)
        squared = off.square().sum(-1)
        values: list[Tensor] = []
        where = at.new_zeros(0)
        for scale, weight_log in zip(SCALES, self.weight_log, strict=True):
            level = -squared / (2 * scale**2)
            summed = level.clamp(min=-30).exp() @ weight_log.exp().T
            values.append((summed + 1e-4).log() / 4)
            if scale == SCALES[1]:
                where = (level.softmax(-1)[..., None] * off).sum(-2).clamp(-4, 4) / 4
        return torch.cat([*values, where], -1)


def nearness(body: Tensor, at: Tensor) -> Tensor:
    """How near places (place, 4) are to the nearest part of a body (BODY_POINTS, 4): minus the squared distance."""
    scaled = at.new_tensor(REFERENCE)
    return -torch.cdist(at / scaled, body / scaled).amin(-1)
