"""Room and motion -> signal by the network: what `method="weaver"` runs."""

from dataclasses import fields, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube, Scene
from mmweaver.core.skeleton import joint
from mmweaver.fields.scatterers.scatterer_field import ScattererField
from mmweaver.models.body_anchors import facing
from mmweaver.models.drawing import draw_moving, draw_static, field_of
from mmweaver.models.mean_power import MeanPower
from mmweaver.models.room_view import RoomView
from mmweaver.models.weaver_network import Echoes, RoomCode, WeaverNetwork


class WovenRoom:
    """A room that the network has encoded for one radar; `field` may then be asked for many motions."""

    def __init__(self, network: WeaverNetwork, scene: Scene, config: RadarConfig, *, room_seed: int = 0):
        self.network, self.config = network, config
        self.radar = MeanPower(config)
        with torch.inference_mode():
            self.code: RoomCode = network.encode_room(RoomView.stacked([RoomView.of(scene)]))
            self.static = draw_static(_first(self.code.resting), self.radar.response, room_seed)

    def field(self, joints_m: np.ndarray, velocity_mps: np.ndarray, *, subject: int) -> ScattererField:
        """The field of one motion: joints (frame, 22, 3) at the middle of each radar frame, and their velocities."""
        joints, velocity = torch.from_numpy(joints_m).float(), torch.from_numpy(velocity_mps).float()
        with torch.inference_mode():
            moving = _first(self.network.moving(self.code, joints[None], velocity[None]))
            points = draw_moving(moving, aspect(joints), self.radar.response, subject)
            noise = self.radar.noise * float(self.network.noise_level.exp())
        return field_of(self.static, points, self.config, len(joints_m), noise)

    def cube(self, joints_m: np.ndarray, velocity_mps: np.ndarray, *, subject: int, seed: int) -> RadarCube:
        """The signal of one motion with the receiver's noise, in sqrt(mW)."""
        field = self.field(joints_m, velocity_mps, subject=subject)
        cube = RadarCube(values=field.native(), grid=field.grid, config=self.config, scale=1.0)
        return replace(field.with_noise(cube, seed), scale=1.0)


def aspect(joints_m: Tensor) -> Tensor:
    """Twice the line of sight as the body sees it (front, side, up), (frame, 3): what turns the phase of its skin."""
    front = facing(joints_m)
    up = torch.tensor([0.0, 0.0, 1.0], device=joints_m.device).expand_as(front)
    side = torch.linalg.cross(up, front)
    sight = torch.nn.functional.normalize(joints_m[:, joint("pelvis")], dim=-1)
    return 2 * torch.stack([(sight * front).sum(-1), (sight * side).sum(-1), sight[:, 2]], dim=-1)


def _first(echoes: Echoes) -> Echoes:
    return Echoes(**{field.name: getattr(echoes, field.name)[0] for field in fields(Echoes)})
