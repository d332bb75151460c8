"""Fields of power as a method: recipe `paper_power`, in rooms by `FieldRoom`, in `Weaver(method=PowerFields(file))`."""

from pathlib import Path

import torch
from torch import Tensor

from mmweaver.core.board import Board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube, Scene
from mmweaver.models.methods import Learned
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import WeightsCard, load_into, read_card
from mmweaver.propagation.mean_scatterers import CellEchoes, MeanEchoes
from mmweaver.propagation.paths import Paths
from mmweaver.propagation.speckle import place_of, sample_cells
from studies.paper.power_cells import CellSizes
from studies.paper.power_network import RECIPE, PowerEncoding, PowerNetwork


def load_power(file: Path) -> tuple[PowerNetwork, WeightsCard]:
    """Reads weights of recipe `paper_power`. Raises InputError for any other file."""
    network = PowerNetwork(is_anchored=bool(read_card(file).settings.get("is_anchored", True)))
    return network, load_into(network, file, recipe=RECIPE, made_by="python -m studies run train_power")


class FieldRoom(LearnedRoom):
    """A room whose echoes are the cells of a field, read at the radar's own resolution; first order alone."""

    has_others = False

    def _encoded(self, view: SceneTensors) -> PowerEncoding:
        assert isinstance(self.network, PowerNetwork)
        return self.network.encode_room(view, CellSizes.of(self.config))

    def _sampled(self, echoes: MeanEchoes, joints_m: Tensor, subject: int, first_frame: int) -> Paths:
        assert isinstance(echoes, CellEchoes)
        frame_s = (first_frame + torch.arange(len(joints_m)).double()) * self.config.frame_period_s
        time_s = frame_s[:, None] + torch.from_numpy(self.renderer.clock.middle_s)
        return sample_cells(echoes, time_s, self.config, subject)

    def _ends_m(self, echoes: MeanEchoes, joints_m: Tensor) -> Tensor:
        return place_of(echoes).float()


class PowerFields(Learned):
    """The method for `Weaver`; for radars at the camera, from which its coordinates are counted."""

    def __init__(self, weights: Path) -> None:
        super().__init__(weights)
        self._power_network = load_power(weights)[0]

    def _encode(
        self, scene: Scene, config: RadarConfig, background: RadarCube | None, board: Board | None
    ) -> LearnedRoom:
        return FieldRoom(self._power_network, scene, config, background=background, board=board)
