"""Anchors of moving echoes on a body and over reflecting faces, with the features of each.

An anchor is a place between two joints, where its direct echo originates. Ghosts lie between an anchor and its images
in the room's faces: a path that departs directly and arrives over a face has the mean of both lengths.
"""

from dataclasses import dataclass

import torch
from torch import Tensor

from mmweaver.core.pinhole import pixel_coordinates
from mmweaver.core.skeleton import NUM_JOINTS, PARENTS, joint
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.models.precision import full_precision
from mmweaver.models.scene_tensors import NUM_PLANES, SceneTensors
from mmweaver.propagation.image_method import mirrored

# from joint, to joint, how far along (above 1: past the second)
_MIDDLE = (
    ("hip", "knee", 0.35),
    ("hip", "knee", 0.7),
    ("knee", "ankle", 0.35),
    ("knee", "ankle", 0.7),
    ("shoulder", "elbow", 0.5),
    ("elbow", "wrist", 0.5),
    ("elbow", "wrist", 1.4),
    ("ankle", "foot", 1.2),
)
_TORSO = (
    ("neck", "head", 2.0),
    ("pelvis", "spine2", 0.5),
    ("left_hip", "spine3", 0.5),
    ("right_hip", "spine3", 0.5),
    ("left_shoulder", "spine2", 0.5),
    ("right_shoulder", "spine2", 0.5),
)
ANCHORS: tuple[tuple[int, int, float], ...] = (
    *((index, index, 0.0) for index in range(NUM_JOINTS)),
    *((joint(f"{side}_{a}"), joint(f"{side}_{b}"), part) for a, b, part in _MIDDLE for side in ("left", "right")),
    *((joint(a), joint(b), part) for a, b, part in _TORSO),
)
NUM_ANCHORS = len(ANCHORS)
# the few anchors that represent the body in reflections, each for the anchors nearest to it
MIRRORED = tuple(joint(name) for name in ("pelvis", "spine3", "head", "left_knee", "right_knee"))
NUM_REFLECTORS = 5  # the floor and the next largest faces
NUM_GHOSTS = len(MIRRORED) * NUM_REFLECTORS
BODY_FEATURES, GHOST_FEATURES = 21, 16
_EDGE_M = 0.1  # about a Fresnel zone: width of the transition at the edge of a face


@dataclass(frozen=True, kw_only=True)
class Anchors(TensorRecord):
    """Expected echoes (..., echo): range, velocity, direction cosines, and features."""

    range_m: Tensor
    velocity_mps: Tensor
    direction: Tensor  # (..., echo, 2) x and z
    features: Tensor  # (..., echo, feature)
    share: Tensor  # (..., echo) two-way power share: 1 for the body, that of the face for ghosts


def anchor_places(joints: Tensor) -> Tensor:
    """Values at anchors (..., anchor, value), interpolated from those at joints (..., 22, value)."""
    first = torch.tensor([a for a, _, _ in ANCHORS], device=joints.device)
    second = torch.tensor([b for _, b, _ in ANCHORS], device=joints.device)
    share = torch.tensor([part for _, _, part in ANCHORS], device=joints.device)[:, None]
    return joints[..., first, :] * (1 - share) + joints[..., second, :] * share


@full_precision
def body_anchors(joints_m: Tensor, velocity_mps: Tensor, room: SceneTensors) -> Anchors:
    """Anchors of direct echoes.

    Args:
        joints_m: Joints (room, frame, 22, 3) in metres, in the radar's coordinates.
        velocity_mps: Velocities of the joints, of the same shape.
        room: Tensors of the rooms, with a leading axis.

    Returns:
        Anchors (room, frame, anchor).
    """
    place, speed = anchor_places(joints_m), anchor_places(velocity_mps)
    bone = _bones(joints_m)
    distance = place.norm(dim=-1).clamp(min=0.2)
    towards = -place / distance[..., None]
    radial = -(speed * towards).sum(-1)
    front = facing(joints_m)
    side = (front[..., None, :] * towards).sum(-1)
    clear, in_view = _clearance(place, distance, room)
    floor = room.plane_centre_m[:, 0, 2]
    length = bone.norm(dim=-1).clamp(min=1e-3)
    unit = bone / length[..., None]
    features = torch.stack(
        [
            *(place / 3).unbind(-1),
            distance / 3,
            1 / distance,
            radial / 2,
            speed.norm(dim=-1) / 2,
            *unit.unbind(-1),
            (unit * towards).sum(-1).abs(),
            side,
            *front[..., None, :2].expand(*distance.shape, 2).unbind(-1),
            place[..., 2] - floor[:, None, None],
            *clear.unbind(-1),
            in_view,
            _depth_behind(distance, towards),
        ],
        dim=-1,
    )
    return Anchors(
        range_m=distance,
        velocity_mps=radial,
        direction=-towards[..., [0, 2]],
        features=features,
        share=torch.ones_like(distance),
    )


@full_precision
def ghost_anchors(joints_m: Tensor, velocity_mps: Tensor, room: SceneTensors) -> Anchors:
    """Anchors of echoes over one face of the room.

    Args:
        joints_m: Joints (room, frame, 22, 3) in metres, in the radar's coordinates.
        velocity_mps: Velocities of the joints, of the same shape.
        room: Tensors of the rooms, with a leading axis.

    Returns:
        Anchors (room, frame, ghost); `share` is 0 where a face does not exist or is not usable.
    """
    place = joints_m[..., MIRRORED, :][..., None, :, :]  # (room, frame, 1, joint, 3)
    speed = velocity_mps[..., MIRRORED, :][..., None, :, :]
    centre = room.plane_centre_m[:, None, :NUM_REFLECTORS, None]
    axes = room.plane_axes[:, None, :NUM_REFLECTORS, None]
    normal = axes[..., 2, :]
    height = ((place - centre) * normal).sum(-1)
    own_height = -(centre * normal).sum(-1)  # of the radar above the face
    image, moving = mirrored(place, height, normal), mirrored(speed, (speed * normal).sum(-1), normal)
    far, near = image.norm(dim=-1).clamp(min=0.2), place.norm(dim=-1).clamp(min=0.2)
    to_image, to_place = image / far[..., None], place / near[..., None]
    # where the mirrored ray meets the face
    share = own_height / (own_height + height).clamp(min=1e-3)
    bounce = share[..., None] * image
    turn = -(torch.nn.functional.normalize(bounce - place, dim=-1) * to_place).sum(-1)
    corner = bounce - centre
    half = room.plane_half_m[:, None, :NUM_REFLECTORS, None]
    margin = torch.stack([half[..., i] - (corner * axes[..., i, :]).sum(-1).abs() for i in (0, 1)], dim=-1)
    valid = (height > 0.02) & (own_height > 0.02) & (half[..., 0] > 0)
    radial = 0.5 * ((moving * to_image).sum(-1) + (speed * to_place).sum(-1))
    cos = (to_image * normal).sum(-1).abs()
    inside = (0.5 * (1 + torch.erf(margin / _EDGE_M))).prod(dim=-1)
    # the larger the bistatic angle, the less skin faces both the radar and the face
    both = (0.5 * (1 + turn)).clamp(0, 1).square()
    left = valid * both * inside.square() * _reflected(room.plane_reflection[:, None, :NUM_REFLECTORS, None], cos)
    material = room.plane_features[:, None, :NUM_REFLECTORS, None, :5].expand(*cos.shape, 5)
    features = torch.stack(
        [
            near.expand_as(far) / 3,
            far / 3,
            radial / 2,
            cos,
            *torch.tanh(3 * margin).unbind(-1),
            height / 2,
            own_height.expand_as(far) / 2,
            torch.log10(left + 1e-4) / 2,
            *to_image.unbind(-1)[::2],
        ],
        dim=-1,
    )
    return Anchors(
        range_m=((near + far) / 2).flatten(-2),
        velocity_mps=radial.flatten(-2),
        direction=((to_image + to_place) / 2)[..., [0, 2]].flatten(-3, -2),
        features=torch.cat([features, material], dim=-1).flatten(-3, -2),
        share=left.flatten(-2),
    )


def _reflected(table: Tensor, cos: Tensor) -> Tensor:
    """Reflected power share at cosines (...), interpolated from a table (..., angle)."""
    place = cos.clamp(0, 1) * (table.shape[-1] - 1)
    low = place.floor().clamp(max=table.shape[-1] - 2)
    wide = table.expand(*cos.shape, table.shape[-1])
    ends = [wide.gather(-1, (low + step).long()[..., None])[..., 0] for step in (0, 1)]
    return ends[0] + (place - low) * (ends[1] - ends[0])


def _bones(joints_m: Tensor) -> Tensor:
    """Bone (..., anchor, 3) that each anchor lies on; for a joint, the bone that ends there."""
    starts = [first if first != second else max(PARENTS[first], 0) for first, second, _ in ANCHORS]
    return joints_m[..., [second for _, second, _ in ANCHORS], :] - joints_m[..., starts, :]


def facing(joints_m: Tensor) -> Tensor:
    """Direction of the chest.

    Args:
        joints_m: Joints (..., 22, 3).

    Returns:
        Unit vectors (..., 3) towards the front.
    """
    across = joints_m[..., joint("left_shoulder"), :] - joints_m[..., joint("right_shoulder"), :]
    up = joints_m[..., joint("neck"), :] - joints_m[..., joint("pelvis"), :]
    return torch.nn.functional.normalize(torch.linalg.cross(across, up), dim=-1)


def _clearance(place: Tensor, distance: Tensor, room: SceneTensors) -> tuple[Tensor, Tensor]:
    """Distance of the photo's surface behind the anchor (at it, above, to both sides), and whether it is in view."""
    seen, inside = [], torch.zeros_like(distance)
    for x, z in ((0.0, 0.0), (0.0, 0.1), (0.12, 0.0), (-0.12, 0.0)):
        shifted = place + place.new_tensor([x, 0.0, z]) - room.camera_m[:, None, None]
        camera = shifted @ room.camera_from_radar[:, None].transpose(-1, -2)
        depth = camera[..., 2].clamp(min=0.1)
        column, row = pixel_coordinates(camera[..., 0], camera[..., 1], depth, *room.camera[:, None, None].unbind(-1))
        rows, columns = room.depth_m.shape[-2:]
        grid = torch.stack([(2 * column + 1) / columns - 1, (2 * row + 1) / rows - 1], dim=-1)
        surface = torch.nn.functional.grid_sample(room.depth_m[:, None], grid, mode="nearest", align_corners=False)[
            :, 0
        ]
        inside = (grid.abs() < 1).all(dim=-1).to(distance.dtype)
        known = (surface > 0.1) & (inside > 0)
        seen.append(torch.where(known, torch.tanh(2 * (surface - depth)), torch.ones_like(surface)))
    return torch.stack(seen, dim=-1), inside


def _depth_behind(distance: Tensor, towards: Tensor) -> Tensor:
    """Amount of the body in front of an anchor in the same direction: 0 for the foremost one."""
    near = (distance[..., :, None] - distance[..., None, :]).clamp(min=0)
    angle = torch.cdist(towards, towards)
    return (torch.exp(-((angle / 0.05) ** 2)) * torch.tanh(5 * near)).sum(-1) / 4


assert NUM_REFLECTORS <= NUM_PLANES
