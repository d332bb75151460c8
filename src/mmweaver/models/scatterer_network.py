"""The weaver: a network that predicts the scatterer field of a person moving in a room.

    picture --EnvironmentEncoder--> z_env, map of places --+--> strength of 5,000 static points and faces
                                                           |
    joints ---PoseEncoder--------> z_pose -----------------+--> strength and place of moving points
                                                                (anchored to the body and its images)

The network predicts the mean strength and the position of each echo; phases are unpredictable and are sampled when a
signal is made. Geometry (positions of joints, decay with distance by the radar equation) is not learned.
Reference: paper, section "Generalization via Hypernetworks".

Physical prior of a body's echoes for the network: strength of each part, and the position of its skin.

Computed from the simulator's skin on a person of average height, without rays: everything that faces the radar counts,
nothing is occluded. The network scales it, as it does with the physical prior of the room's surfaces.
Reference: docs/decisions/skin.md, docs/decisions/network-predicts-echoes.md.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from mmweaver.core.pinhole import pixel_coordinates
from mmweaver.core.tensor_files import TensorRecord
from mmweaver.models.body_anchors import (
    BODY_FEATURES,
    GHOST_FEATURES,
    MIRRORED,
    NUM_ANCHORS,
    NUM_GHOSTS,
    NUM_REFLECTORS,
    Anchors,
    anchor_places,
    body_anchors,
    ghost_anchors,
)
from mmweaver.models.environment_encoder import DEFAULT_ENCODER, ENCODERS, MAP_CHANNELS, Z_ENV
from mmweaver.models.pose_encoder import Z_POSE, PoseEncoder
from mmweaver.models.precision import full_precision
from mmweaver.models.scene_tensors import PLANE_FEATURES, POINT_FEATURES, SceneTensors
from mmweaver.propagation.body_model import average_body
from mmweaver.propagation.mean_power import MeanEchoes


@dataclass(frozen=True, kw_only=True)
class BodyPrior(TensorRecord):
    """Cross section in m2 of each anchor (..., frame, anchor), and range offset of its skin in m."""

    cross_section_m2: Tensor
    offset_m: Tensor  # negative in front of the anchor, where skin is


def body_prior(joints_m: Tensor) -> BodyPrior:
    """The prior of motions.

    Args:
        joints_m: Joints (sequence, frame, 22, 3) in metres, in the radar's coordinates.

    Returns:
        Cross sections and offsets (sequence, frame, anchor), on the device of the joints.
    """
    if joints_m.is_meta:  # shapes alone, no numbers
        nothing = joints_m.new_zeros((*joints_m.shape[:2], NUM_ANCHORS))
        return BodyPrior(cross_section_m2=nothing, offset_m=nothing)
    with torch.no_grad():
        anchors = anchor_places(joints_m.detach().cpu()).double().numpy()
        parts = [_one(joints, place) for joints, place in zip(joints_m.detach().cpu().numpy(), anchors, strict=True)]
    stacked = [np.stack(each).astype(np.float32) for each in zip(*parts, strict=True)]
    section, offset = (torch.from_numpy(each).to(joints_m) for each in stacked)
    return BodyPrior(cross_section_m2=section, offset_m=offset)


BOTH_WAYS = 1.0  # two directions of travel, half of which is blocked by furniture


def ghost_section(joints_m: Tensor, prior: BodyPrior) -> Tensor:
    """Cross section of the body's images, before the reflection by the face.

    Each of the few anchors that represent the body in reflections has the sum of all anchors nearest to it.

    Args:
        joints_m: Joints (..., frame, 22, 3) in metres.
        prior: Prior of the same motions.

    Returns:
        Cross section (..., frame, ghost) in m2.
    """
    places = anchor_places(joints_m)
    nearest = torch.cdist(places, places[..., MIRRORED, :]).argmin(dim=-1)
    of = torch.nn.functional.one_hot(nearest, len(MIRRORED)).to(prior.cross_section_m2)
    section = BOTH_WAYS * (prior.cross_section_m2[..., None, :] @ of)[..., 0, :]
    return section.repeat(*[1] * (section.dim() - 1), NUM_REFLECTORS)


def _one(joints_m: np.ndarray, anchors_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    body = average_body()
    skin = body.skin(joints_m.astype(float))
    distance = np.linalg.norm(skin.place_m, axis=-1)
    cos = -(skin.normal * skin.place_m).sum(-1) / np.maximum(distance, 1e-6)
    section = body.echo.monostatic(cos) * body.area_m2 * body.brightness  # (frame, point)
    gap = np.linalg.norm(skin.place_m[0][:, None] - anchors_m[0][None], axis=-1)
    of = np.zeros((len(body.part), NUM_ANCHORS))
    of[np.arange(len(of)), gap.argmin(axis=1)] = 1.0
    total = section @ of
    behind = (section * distance) @ of / np.maximum(total, 1e-12) - np.linalg.norm(anchors_m, axis=-1)
    return total, np.where(total > 1e-9, np.clip(behind, -0.3, 0.3), 0.0)


class ScattererNetwork(nn.Module):
    """Interface of the networks: `encode_room` once per room, then `moving` for each motion.

    The code of a room is the network's own record; its `view` (SceneTensors) and `static` (MeanEchoes) are public.
    """

    def encode_room(self, view: SceneTensors) -> Any:
        """Encodes rooms.

        Args:
            view: Tensors of the rooms, (room, ...).

        Returns:
            Their code, with static echoes (room, echo).
        """
        raise NotImplementedError

    def moving(self, code: Any, joints_m: Tensor, velocity_mps: Tensor, frames: Tensor | None = None) -> MeanEchoes:
        """Moving echoes of one motion per room.

        Args:
            code: Code of the rooms.
            joints_m: Joints (room, frame, 22, 3) in metres, in the radar's coordinates.
            velocity_mps: Velocities of the joints, of the same shape.
            frames: Frames (room, chosen) whose echoes are wanted; by default all.

        Returns:
            Echoes (room, frame, echo).
        """
        raise NotImplementedError


WIDTH, HEADS, LAYERS = 128, 4, 2
MAX_STEP = 12.0  # limit of the correction of a body echo, as a natural logarithm of power
FAINTEST_M2 = 1e-4  # lower bound of the prior cross section of a part of the body
MAX_CORRECTION = 2.0  # limit of the correction of the photographed room, as a natural logarithm of power


@dataclass(frozen=True, kw_only=True)
class SceneEncoding(TensorRecord):
    """Code of a room, computed once from its photo and used for any number of motions."""

    view: SceneTensors
    z_env: Tensor
    static: MeanEchoes


class WeaverNetwork(ScattererNetwork):
    """From rooms and motions to mean echoes.

    Args:
        corrects_surfaces: Whether the network corrects the strength that physics predicts for photographed surfaces.
        encoder: Name of the environment encoder.
    """

    max_correction = MAX_CORRECTION

    def __init__(self, *, corrects_surfaces: bool = True, encoder: str = DEFAULT_ENCODER) -> None:
        super().__init__()
        self.corrects_surfaces = corrects_surfaces
        self.environment = ENCODERS[encoder]()
        self.pose = PoseEncoder()
        self.point = _mlp(POINT_FEATURES + MAP_CHANNELS, 96, 1)
        self.face = _mlp(PLANE_FEATURES, 64, 1)
        self.body_in, self.ghost_in = nn.Linear(BODY_FEATURES + 2, WIDTH), nn.Linear(GHOST_FEATURES, WIDTH)
        self.part = nn.Parameter(0.02 * torch.randn(NUM_ANCHORS + NUM_GHOSTS, WIDTH))
        self.from_env, self.from_pose = nn.Linear(Z_ENV, WIDTH), nn.Linear(Z_POSE, WIDTH)
        layer = nn.TransformerEncoderLayer(
            WIDTH, HEADS, 2 * WIDTH, dropout=0.0, activation="gelu", batch_first=True, norm_first=True
        )
        self.mix = nn.TransformerEncoder(layer, LAYERS, enable_nested_tensor=False)
        self.out = nn.Sequential(nn.LayerNorm(WIDTH), nn.Linear(WIDTH, 5))
        for network in (self.point, self.face, self.out):
            head = network[-1]
            assert isinstance(head, nn.Linear)
            nn.init.normal_(head.weight, std=0.0 if network is self.point else 1e-3)
            nn.init.zeros_(head.bias)

    def encode_room(self, view: SceneTensors) -> SceneEncoding:
        """Encodes rooms, see `ScattererNetwork.encode_room`."""
        z_env, places = self.environment(view.image)
        parts = [self._points(view, places), self._faces(view)]
        return SceneEncoding(view=view, z_env=z_env, static=MeanEchoes.cat(parts, 1))

    def moving(
        self, code: SceneEncoding, joints_m: Tensor, velocity_mps: Tensor, frames: Tensor | None = None
    ) -> MeanEchoes:
        """Moving echoes, see `ScattererNetwork.moving`.

        The pose encoder sees all frames, including those not chosen.
        """
        z_pose = self.pose(torch.cat([joints_m / 2, velocity_mps / 2], dim=-1))
        if frames is not None:
            z_pose, joints_m, velocity_mps = (_picked(part, frames) for part in (z_pose, joints_m, velocity_mps))
        body, ghosts, prior = self.anchors(joints_m, velocity_mps, code.view)
        physics = torch.stack([torch.log10(prior.cross_section_m2 + FAINTEST_M2) / 2, 5 * prior.offset_m], dim=-1)
        of_body = self.body_in(torch.cat([body.features, physics], dim=-1))
        token = torch.cat([of_body, self.ghost_in(ghosts.features)], dim=-2) + self.part
        token = token + self.from_pose(z_pose)[..., None, :] + self.from_env(code.z_env)[:, None, None, :]
        mixed = self.mix(token.flatten(0, 1)).unflatten(0, token.shape[:2])
        return _placed(self.steps(mixed), body, ghosts, prior, ghost_section(joints_m, prior))

    def anchors(self, joints_m: Tensor, velocity_mps: Tensor, view: SceneTensors) -> tuple[Anchors, Anchors, BodyPrior]:
        """Anchors and the physical prior of motions.

        Args:
            joints_m: Joints (room, frame, 22, 3) in metres, in the radar's coordinates.
            velocity_mps: Velocities of the joints, of the same shape.
            view: Tensors of the rooms.

        Returns:
            Anchors of direct echoes, anchors of ghosts, and the prior of the body.
        """
        body, ghosts = body_anchors(joints_m, velocity_mps, view), ghost_anchors(joints_m, velocity_mps, view)
        return body, ghosts, body_prior(joints_m)

    def steps(self, mixed: Tensor) -> Tensor:
        """Level, and steps in range, velocity and direction (..., echo, 5), from features (..., echo, WIDTH)."""
        return self.out(mixed)

    def _points(self, view: SceneTensors, places: Tensor) -> MeanEchoes:
        local = _looked_up(places, view.point_m, view)
        level = self.point(torch.cat([view.point_features, local], dim=-1))[..., 0]
        distance = view.point_m.norm(dim=-1).clamp(min=0.1)
        level = level if self.corrects_surfaces else 0 * level
        cross_section = view.point_cross_section_m2 * torch.exp(_bounded(level, self.max_correction))
        return _static(distance, (view.point_m / distance[..., None])[..., [0, 2]], cross_section)

    def _faces(self, view: SceneTensors) -> MeanEchoes:
        """The mirror image of the radar in each face: an echo from the foot of the perpendicular."""
        level = self.face(view.plane_features)[..., 0]
        normal = view.plane_axes[..., 2, :]
        distance = -(view.plane_centre_m * normal).sum(-1)
        there = (distance > 0.15) & (view.plane_half_m[..., 0] > 0)
        cross_section = there * torch.exp(_bounded(level) - 8.0)
        return _static(distance.clamp(min=0.15), -normal[..., [0, 2]], cross_section)


@full_precision
def _looked_up(places: Tensor, point_m: Tensor, view: SceneTensors) -> Tensor:
    """Values of the map (room, point, channel) at the projections of points; zeros outside the picture."""
    camera = (point_m - view.camera_m[:, None]) @ view.camera_from_radar.transpose(-1, -2)
    depth = camera[..., 2].clamp(min=0.05)
    column, row = pixel_coordinates(camera[..., 0], camera[..., 1], depth, *view.camera[:, None].unbind(-1))
    rows, columns = view.depth_m.shape[-2:]
    grid = torch.stack([(2 * column + 1) / columns - 1, (2 * row + 1) / rows - 1], dim=-1)
    found = nn.functional.grid_sample(places, grid[:, None].clamp(-3, 3), align_corners=False)
    return found[:, :, 0].transpose(1, 2)


def _picked(values: Tensor, frames: Tensor) -> Tensor:
    index = frames.reshape(*frames.shape, *[1] * (values.dim() - 2)).expand(-1, -1, *values.shape[2:])
    return values.gather(1, index)


def _static(distance: Tensor, direction: Tensor, cross_section: Tensor) -> MeanEchoes:
    return MeanEchoes(
        range_m=distance, velocity_mps=torch.zeros_like(distance), direction=direction, cross_section_m2=cross_section
    )


def _placed(out: Tensor, body: Anchors, ghosts: Anchors, prior: BodyPrior, of_ghosts_m2: Tensor) -> MeanEchoes:
    """Applies the network's output: level, and small steps in range, velocity and direction."""
    level, step_r, step_v, step_x, step_z = out.unbind(-1)
    share = torch.cat([body.share, ghosts.share], -1)
    known = torch.cat([prior.cross_section_m2, of_ghosts_m2], -1) + FAINTEST_M2
    range_m = torch.cat([body.range_m + prior.offset_m, ghosts.range_m - 0.06], -1)
    return MeanEchoes(
        range_m=range_m + 0.2 * torch.tanh(step_r),
        velocity_mps=torch.cat([body.velocity_mps, ghosts.velocity_mps], -1) + 0.5 * torch.tanh(step_v),
        direction=torch.cat([body.direction, ghosts.direction], -2)
        + 0.1 * torch.tanh(torch.stack([step_x, step_z], -1)) / range_m[..., None],
        cross_section_m2=share * known * torch.exp(_bounded(level)),
    )


def _bounded(level: Tensor, largest: float = MAX_STEP) -> Tensor:
    return largest * torch.tanh(level / largest)


def _mlp(wide_in: int, hidden: int, wide_out: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Linear(wide_in, hidden), nn.GELU(), nn.Linear(hidden, hidden), nn.GELU(), nn.Linear(hidden, wide_out)
    )
