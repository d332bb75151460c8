"""The paper's hypernetwork with a target that can be learned: fields of log power.

    picture --EnvironmentEncoder--> z_env --> whitened --+--> 272 numbers --> field of the room over (r, azimuth,
                                                         |                    elevation)
    joints ---PoseEncoder---------> z_pose -> whitened --+--> 272 a frame --> field of the person over (r, d, azimuth,
                                                                              elevation)

Encoders are those of recipe `weaver` and stay as they are; their codes are whitened over the training set, so that
what differs between rooms and poses reaches the hypernetwork at unit spread.

Fields give the radar cross section of cells (`power_cells`); each cell that matters becomes one scatterer of unknown
phase, and the radar's own response makes the signal of them (`propagation.speckle`). Coordinates are those of the
radar and, next to them, counted from what photo and joints show: from the photographed surface in that direction, and
from the pelvis. Reference: paper, section "Generalization via Hypernetworks".
"""

from dataclasses import dataclass, replace

import torch
from torch import Tensor, nn

from mmweaver.core.pinhole import pixel_coordinates
from mmweaver.models.environment_encoder import Z_ENV, EnvironmentEncoder
from mmweaver.models.pose_encoder import Z_POSE, PoseEncoder
from mmweaver.models.power_anchors import (
    BODY_VALUES,
    HEADS,
    SURFACE_VALUES,
    BodyNearness,
    body_points,
    nearness,
    seen_surface,
    surface_values,
    surface_volume,
)
from mmweaver.models.power_cells import REACH, WIDEST, CellSizes
from mmweaver.models.power_field import FieldWriter, PcaWhitening, PowerField, octave_size, octaves
from mmweaver.models.precision import full_precision
from mmweaver.models.scatterer_network import ScattererNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.propagation.mean_power import MeanEchoes

ROOM_OCTAVES, PERSON_OCTAVES = (7, 6, 4, 4), (6, 6, 4, 4)
SURFACE_FEATURES, PERSON_FEATURES = 4, 2
ENV_PARTS, POSE_PARTS = 4, 32  # principal components of the codes that the hypernetwork reads
MIDDLE_M = 2.2  # of the ranges that a field is read at
SURFACE_REACH_M = 1.0  # before and behind the photographed surface
MOST_MOVING = 1024  # cells of a frame, the strongest
BLOCK = (2, 2, 2, 2)  # cells that are first looked at together
LIKELY_BLOCKS = 384  # of a frame, whose cells are looked at one by one
LARGEST_LOG = 6.0
# what fields say before training: levels and slopes of the last values, read off eight training rooms
ROOM_LOG, ROOM_SLOPES = -12.5, {0: 1.6, 1: 0.8, 3: 1.2, 6: 1.6}
PERSON_LOG, PERSON_SLOPES = -7.3, {**dict.fromkeys(range(HEADS), 0.7), **dict.fromkeys(range(HEADS, 2 * HEADS), 0.3)}


@dataclass(frozen=True, kw_only=True)
class CellEchoes(MeanEchoes):
    """Echoes that stand for resolution cells; a cell has one number in all frames, and so one phase."""

    cell: Tensor  # (..., echo) int64


@dataclass(frozen=True, kw_only=True)
class PowerEncoding:
    """A room that has been encoded: what the photo shows, its code, its field, and its cells at rest."""

    view: SceneTensors
    z_env: Tensor  # (room, 512)
    surface: Tensor  # (room, 3, row, column): distance of the surface, cosine of incidence, whether it is known
    volume: Tensor  # (room, SURFACE_VALUES, ...) of `surface_volume`
    written: Tensor  # (room, NUM_WRITTEN)
    sizes: CellSizes
    static: MeanEchoes  # (room, cell)


class PowerNetwork(ScattererNetwork):
    """Rooms and motions -> mean echoes of cells; `encode_room` once per room, then `moving` for each motion."""

    def __init__(self) -> None:
        super().__init__()
        self.environment, self.pose = EnvironmentEncoder(), PoseEncoder()
        for encoder in (self.environment, self.pose):
            encoder.requires_grad_(False)
        self.env_whitening, self.pose_whitening = PcaWhitening(Z_ENV, ENV_PARTS), PcaWhitening(Z_POSE, POSE_PARTS)
        self.room_writer, self.person_writer = FieldWriter(ENV_PARTS), FieldWriter(ENV_PARTS + POSE_PARTS)
        self.nearness = BodyNearness()
        self.room = PowerField(octave_size(ROOM_OCTAVES) + SURFACE_FEATURES + SURFACE_VALUES)
        self.person = PowerField(octave_size(PERSON_OCTAVES) + PERSON_FEATURES + BODY_VALUES)
        self.room.begin_with(ROOM_LOG, ROOM_SLOPES, SURFACE_VALUES)
        self.person.begin_with(PERSON_LOG, PERSON_SLOPES, BODY_VALUES)

    def train(self, mode: bool = True) -> "PowerNetwork":
        """Training or not, encoders drop nothing."""
        super().train(mode)
        for encoder in (self.environment, self.pose):
            encoder.eval()
        return self

    def pose_codes(self, joints_m: Tensor, velocity_mps: Tensor) -> Tensor:
        """z_pose (room, frame, 512) of motions (room, frame, 22, 3)."""
        return self.pose(torch.cat([joints_m / 2, velocity_mps / 2], dim=-1))

    def encode_room(self, view: SceneTensors, sizes: CellSizes | None = None) -> PowerEncoding:
        """Rooms (room, ...) -> their code, with echoes of all cells at rest (room, cell); `sizes`: of cells."""
        z_env, _ = self.environment(view.image)
        code = PowerEncoding(
            view=view, z_env=z_env, surface=_surfaces(view), volume=surface_volume(view),
            written=self.room_writer(self.env_whitening(z_env)), sizes=sizes or CellSizes(), static=_no_echoes(z_env),
        )  # fmt: skip
        cells = code.sizes.room_cells().to(z_env.device)[None].expand(len(z_env), -1, -1)
        level = self.room_level(code, cells)
        static = MeanEchoes(
            range_m=cells[..., 0], velocity_mps=torch.zeros_like(level), direction=cells[..., 1:],
            cross_section_m2=level.exp() * code.sizes.room_share,
        )  # fmt: skip
        return replace(code, static=static)

    def room_level(self, code: PowerEncoding, at: Tensor) -> Tensor:
        """Logarithm of the cross section (m2) of reference cells at rest at (room, place, 3) -> (room, place)."""
        return _bounded(self.room(self._room_coordinates(code, at), code.written))

    def write_person(self, code: PowerEncoding, joints_m: Tensor, velocity_mps: Tensor) -> Tensor:
        """What the hypernetwork writes of a motion (room, frame, 22, 3): (room, frame, NUM_WRITTEN)."""
        of_pose = self.pose_whitening(self.pose_codes(joints_m, velocity_mps))
        of_room = self.env_whitening(code.z_env)[:, None].expand(-1, of_pose.shape[1], -1)
        return self.person_writer(torch.cat([of_room, of_pose], dim=-1))

    def person_level(self, written: Tensor, body: Tensor, at: Tensor) -> Tensor:
        """Logarithm of the cross section (m2) of reference cells at (field, place, 4) -> (field, place).

        `body` (field, part, 4): range, radial velocity and direction cosines of its parts, the pelvis first.
        """
        return _bounded(self.person(self._person_coordinates(body, at), written))

    def moving(
        self, code: PowerEncoding, joints_m: Tensor, velocity_mps: Tensor, frames: Tensor | None = None
    ) -> CellEchoes:
        """Joints and velocities (room, frame, 22, 3), one motion for each room -> the strongest cells (room, frame,
        cell). `frames` (room, chosen) picks the frames whose echoes are wanted; the pose encoder sees all.
        """
        written, body = self.write_person(code, joints_m, velocity_mps), body_points(joints_m, velocity_mps)
        if frames is not None:
            written, body = (chosen_frames(part, frames) for part in (written, body))
        shape = written.shape[:2]
        written, body = written.flatten(0, 1), body.flatten(0, 1)
        cells = torch.stack([self._cells(code.sizes, one) for one in body])
        level, there = self.person_level(written, body, cells), _is_ahead(cells)
        echoes = CellEchoes(
            range_m=cells[..., 0].clamp(min=0.1), velocity_mps=cells[..., 1],
            direction=cells[..., 2:] * there[..., None], cell=code.sizes.numbers(cells),
            cross_section_m2=level.exp() * there * code.sizes.moving_share,
        )  # fmt: skip
        return echoes.map(lambda tensor: tensor.unflatten(0, shape))

    def _cells(self, sizes: CellSizes, body: Tensor) -> Tensor:
        """The cells (cell, 4) nearest to a body (part, 4): blocks first, then the cells of the likely ones."""
        with torch.no_grad():
            blocks, inside = (part.to(body.device) for part in sizes.boxes(body[0].cpu(), BLOCK))
            likely = nearness(body, blocks).topk(min(LIKELY_BLOCKS, len(blocks))).indices
            cells = (blocks[likely][:, None] + inside).flatten(0, 1)
            return cells[nearness(body, cells).topk(min(MOST_MOVING, len(cells))).indices]

    def _room_coordinates(self, code: PowerEncoding, at: Tensor) -> Tensor:
        distance, cosine, known = _seen(code, at[..., 1:]).unbind(1)
        behind = ((at[..., 0] - distance) / SURFACE_REACH_M).clamp(-1, 1) * known
        axes = ((at[..., 0] - MIDDLE_M) / MIDDLE_M, behind, at[..., 1], at[..., 2])
        flash = (10 * cosine - 9).clamp(min=0)  # a surface that faces the radar
        parts = [octaves(axis, count) for axis, count in zip(axes, ROOM_OCTAVES, strict=True)]
        seen = torch.stack([known, distance / 4, cosine, flash], -1)
        return torch.cat([*parts, seen, surface_values(code.volume, at)], -1)

    def _person_coordinates(self, body: Tensor, at: Tensor) -> Tensor:
        distance, speed, x, _ = body[:, :1].unbind(-1)
        range_m, velocity, cosine_x, cosine_z = at.unbind(-1)
        axes = [(range_m - distance) / REACH[0], (velocity - speed) / REACH[1], (cosine_x - x) / REACH[2], cosine_z]
        parts = [octaves(axis, count) for axis, count in zip(axes, PERSON_OCTAVES, strict=True)]
        place = torch.stack([range_m / 4, cosine_x], -1)
        return torch.cat([*parts, place, self.nearness(body, at)], -1)


def chosen_frames(values: Tensor, frames: Tensor) -> Tensor:
    """Of values (room, frame, size) those at indices (room, chosen)."""
    index = frames.reshape(*frames.shape, *[1] * (values.dim() - 2))
    return values.gather(1, index.expand(-1, -1, *values.shape[2:]))


def _surfaces(view: SceneTensors) -> Tensor:
    """Of each pixel (room, 3, row, column): distance of its surface, cosine of incidence, and whether it is known."""
    point, cosine = seen_surface(view)
    return torch.stack([point.norm(dim=1), cosine, (view.depth_m > 0).float()], 1)


@full_precision
def _looked_up(surface: Tensor, direction: Tensor, camera_from_radar: Tensor, camera: Tensor) -> Tensor:
    """Values (room, 3, place) of the surface in directions (room, place, 2); zeros beyond the picture."""
    ahead = (1 - direction.square().sum(-1)).clamp(min=0.0).sqrt()
    unit = torch.stack([direction[..., 0], ahead, direction[..., 1]], -1)
    seen = unit @ camera_from_radar.transpose(-1, -2)
    depth = seen[..., 2].clamp(min=0.05)
    column, row = pixel_coordinates(seen[..., 0], seen[..., 1], depth, *camera[:, None].unbind(-1))
    rows, columns = surface.shape[-2:]
    grid = torch.stack([(2 * column + 1) / columns - 1, (2 * row + 1) / rows - 1], dim=-1).clamp(-3, 3)
    found = nn.functional.grid_sample(surface, grid[:, None], mode="nearest", align_corners=False)[:, :, 0]
    return found * (seen[..., 2] > 0.05)[:, None]


def _seen(code: PowerEncoding, direction: Tensor) -> Tensor:
    return _looked_up(code.surface, direction, code.view.camera_from_radar, code.view.camera)


def _is_ahead(cells: Tensor) -> Tensor:
    """Whether cells (..., 4) lie where an antenna hears anything."""
    return (cells[..., 2:].square().sum(-1) < WIDEST) & (cells[..., 0] > 0.1)


def _bounded(level: Tensor) -> Tensor:
    return level.clamp(-LARGEST_LOG * 5, LARGEST_LOG)


def _no_echoes(like: Tensor) -> MeanEchoes:
    none = like.new_zeros((len(like), 0))
    return MeanEchoes(
        range_m=none, velocity_mps=none, direction=like.new_zeros((len(like), 0, 2)), cross_section_m2=none
    )
