"""What every network that solves for paths is: rooms and motions in, mean echoes out."""

from typing import Any

from torch import Tensor, nn

from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.paths.mean_scatterers import MeanEchoes


class ScattererNetwork(nn.Module):
    """`encode_room` once a room, then `moving` for each motion. The room's code is the network's own record.

    Its `view` (SceneTensors) and `static` (MeanEchoes) are for everybody.
    """

    def encode_room(self, view: SceneTensors) -> Any:
        """Rooms (room, ...) -> their code, with static echoes (room, echo)."""
        raise NotImplementedError

    def moving(self, code: Any, joints_m: Tensor, velocity_mps: Tensor, frames: Tensor | None = None) -> MeanEchoes:
        """Joints and velocities (room, frame, 22, 3), one motion for each room -> echoes (room, frame, echo)."""
        raise NotImplementedError
