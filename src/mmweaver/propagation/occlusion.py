"""Occlusion by a body from its joints alone: the average body's capsules, without a ray caster.

A capsule casts a smooth shadow: the field behind a strip by its two edges, each a knife edge. Reference: 3GPP TR
38.901, section 7.6.4.2 (blockage model B); docs/decisions/network-predicts-echoes.md.

Visibility of one motion in one room, stored as bits, so that its rays need not be cast again.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.tensor_files import TensorRecord
from mmweaver.propagation.body_model import average_body
from mmweaver.propagation.paths import StaticPaths


@dataclass(frozen=True, kw_only=True)
class Visibility(TensorRecord):
    """What rays decide about one person: visible skin, clear paths over the room's faces, occluded static paths."""

    skin: np.ndarray  # (frame, point) bool: faces the radar, and nothing lies between
    over_faces: np.ndarray  # (frame, face, ghost point) bool: the path over the face is clear, where it was tested
    occluded: np.ndarray  # (frame, static path) bool: the person is in the way

    def packed(self) -> np.ndarray:
        """Eight values per byte, uint8 (frame, byte)."""
        frames = len(self.skin)
        return np.packbits(np.concatenate([self.skin, self.over_faces.reshape(frames, -1), self.occluded], 1), axis=1)

    @classmethod
    def unpacked(cls, packed: np.ndarray, *, points: int, faces: int, ghosts: int, static_paths: int) -> "Visibility":
        """The inverse of `packed`.

        Args:
            packed: Bytes (frame, byte).
            points: Number of skin points.
            faces: Number of faces of the room.
            ghosts: Number of ghost points.
            static_paths: Number of static paths.
        """
        bits = np.unpackbits(packed, axis=1, count=points + faces * ghosts + static_paths).astype(bool)
        skin, over_faces, occluded = np.split(bits, [points, points + faces * ghosts], axis=1)
        return cls(skin=skin, over_faces=over_faces.reshape(len(packed), faces, ghosts), occluded=occluded)


MAX_FLESH_M = 0.2  # maximum distance from bone to skin
SHADOW_M = 0.3  # how far outside the skin the shadow is followed,
LEAST_LOST = 0.02  # where less than this share of the field is lost
BEHIND_M, EASE_M = 0.1, 0.05  # minimum distance behind the body of what it occludes, and over which the shadow sets in
RAYS_M = 1e-9  # a wavelength without diffraction
FRAMES_AT_ONCE = 5  # fit into the cache
CORNERS = 0.93  # mean over outer radius of a hexagon: the ray tracer's bodies occlude by six-sided hulls


def occluded(ends_m: Tensor, joints_m: Tensor) -> Tensor:
    """Whether a body blocks the line of sight from the radar to places: its shadow without diffraction.

    Args:
        ends_m: Places (path, 3) in metres, or (frame, path, 3).
        joints_m: Joints (frame, 22, 3) in metres.

    Returns:
        Bool (frame, path), on the device of the joints.
    """
    return shadow(ends_m, joints_m, RAYS_M) > 0.5


def shadow(ends_m: Tensor, joints_m: Tensor, wavelength_m: float) -> Tensor:
    """Share of the field that a body takes from the line of sight between the radar and places.

    The body consists of the ray tracer's capsules, around the bones of a person of average height.

    Args:
        ends_m: Places (path, 3) in metres, or (frame, path, 3).
        joints_m: Joints (frame, 22, 3) in metres.
        wavelength_m: Wavelength in metres.

    Returns:
        Shares (frame, path) from 0 to 1, on the device of the joints.
    """
    body = average_body()
    posed = body.posed(joints_m.double().cpu().numpy())
    starts, axes, rotations = (torch.from_numpy(part).float() for part in (posed.start_m, posed.axis_m, posed.rotation))
    radius = CORNERS * torch.from_numpy(body.radii_m).float()
    width = torch.from_numpy(body.widths).float()
    ends = ends_m.cpu().float()
    distance = ends.norm(dim=-1)
    rays = (ends / distance.clamp(min=1e-6)[..., None]).expand(len(starts), -1, -1)
    distance = distance.expand(len(starts), -1)
    near = _towards(rays, starts, starts + axes)
    out = torch.zeros(near.shape)
    for first in range(0, len(rays), FRAMES_AT_ONCE):
        some = slice(first, first + FRAMES_AT_ONCE)
        asked = torch.nonzero(near[some].any(dim=0))[:, 0]
        far = distance[some, asked] - BEHIND_M
        lost = _lost(
            rays[some, asked], far, radius, width, starts[some], axes[some], rotations[some, ..., 0], wavelength_m
        )
        out[some, asked] = lost * near[some, asked]
    return out.to(joints_m.device)


def people_shadow(paths: StaticPaths, joints_m: Sequence[np.ndarray | Tensor], wavelength_m: float) -> Tensor:
    """Share of the amplitude of static paths that people take on the way out and back.

    Args:
        paths: Static paths, (path,).
        joints_m: Joints (frame, 22, 3) in metres of each person.
        wavelength_m: Wavelength in metres.

    Returns:
        Shares (frame, path) from 0 to 1, float32.
    """
    out_m, back_m = paths.departure_vertex_m, paths.arrival_vertex_m
    other = (out_m != back_m).any(dim=1).nonzero()[:, 0]
    left = torch.ones(len(joints_m[0]), len(paths))
    for own in joints_m:
        joints = torch.as_tensor(own).float()
        out = 1 - shadow(out_m, joints, wavelength_m)
        back = out.clone()
        if len(other):
            back[:, other] = 1 - shadow(back_m[other], joints, wavelength_m)
        left *= out * back
    return 1 - left


def _towards(rays: Tensor, *ends_m: Tensor) -> Tensor:
    """Which unit vectors (frame, ray, 3) may meet the body, (frame, ray): a cone, cut by a wedge."""
    ends = torch.cat(ends_m, dim=1)
    distance = ends.norm(dim=-1)
    unit = ends / distance[..., None]
    middle = torch.nn.functional.normalize(unit.mean(dim=1), dim=-1)
    flesh = torch.asin(((MAX_FLESH_M + SHADOW_M) / distance.amin(dim=1)).clamp(max=1.0))
    widest = torch.acos((unit @ middle[..., None])[..., 0].amin(dim=1).clamp(-1, 1)) + flesh
    in_cone = (rays @ middle[..., None])[..., 0] > torch.cos(widest.clamp(max=torch.pi))[:, None]
    return in_cone & (rays @ _sides(ends, middle) >= 0).all(dim=-1)


def _sides(ends_m: Tensor, middle: Tensor) -> Tensor:
    """Inward normals (frame, 3, 2) of two vertical planes through the radar that enclose the body.

    Zero where the body fills half of the horizon or more.
    """
    ahead = middle[:, None, :2]
    along, across = (ends_m[..., :2] * ahead).sum(-1), ends_m[..., 1] * ahead[..., 0] - ends_m[..., 0] * ahead[..., 1]
    azimuth = torch.atan2(across, along) + torch.atan2(ahead[..., 1], ahead[..., 0])
    flesh = torch.asin(((MAX_FLESH_M + SHADOW_M) / ends_m[..., :2].norm(dim=-1).amin(dim=1)).clamp(max=1.0))
    right, left = azimuth.amin(dim=1) - flesh, azimuth.amax(dim=1) + flesh
    level = torch.zeros_like(left)
    normals = (torch.stack([-right.sin(), right.cos(), level], -1), torch.stack([left.sin(), -left.cos(), level], -1))
    return torch.stack(normals, dim=-1) * (left - right < torch.pi)[:, None, None]


def _lost(
    rays: Tensor,
    far_m: Tensor,
    radius_m: Tensor,
    width: Tensor,
    start_m: Tensor,
    axis_m: Tensor,
    right: Tensor,
    wavelength_m: float,
) -> Tensor:
    """Share of the field that capsules take from each ray (frame, ray, 3) within `far_m` (frame, ray).

    Capsules are (frame, capsule, 3), their radii (capsule, 2).
    """
    along, begun, across_m = (part @ rays.mT for part in (axis_m, start_m, right))  # (frame, capsule, ray)

    def dot(one: Tensor, other: Tensor) -> Tensor:
        return (one * other).sum(-1, keepdim=True)

    length2, slope, start2 = dot(axis_m, axis_m), dot(axis_m, start_m), dot(start_m, start_m)
    # the point of the bone nearest to the ray, both seen along the ray
    share = ((along * begun).sub_(slope) / (length2 - along.square()).clamp_(min=1e-9)).clamp_(0, 1)
    gone = (share * along).add_(begun)
    sideways = (share * dot(axis_m, right)).add_(dot(start_m, right)).sub_(across_m.mul_(gone))
    gap2 = (share * length2).add_(2 * slope).mul_(share).add_(start2).sub_(gone.square())
    reach = share.mul_(radius_m[:, 1:] - radius_m[:, :1]).add_(radius_m[:, :1])
    gap = gap2.sub_(sideways.square_().mul_(1 - width[:, None] ** -2)).clamp_(min=0).sqrt_()
    left_m = far_m[:, None] - gone
    # F = atan(pi/2 sqrt(pi / wavelength (D1 + D2 - r))) / pi per edge, with D1 + D2 - r = h^2 (1/d1 + 1/d2) / 2
    sharp = (
        (1 / gone.clamp(min=0.05) + 1 / (left_m + BEHIND_M).clamp(min=0.05)).mul_(math.pi / (2 * wavelength_m)).sqrt_()
    )
    sharp.mul_(math.pi / 2)
    lost = torch.atan((reach - gap).mul_(sharp)).add_(torch.atan(gap.add_(reach).mul_(sharp))).div_(math.pi)
    between = torch.minimum(gone, left_m).div_(EASE_M).clamp_(0, 1)
    return lost.mul_(between).amax(dim=1).sub_(LEAST_LOST).clamp_(min=0).div_(1 - LEAST_LOST)
