"""Fields of power as a method: recipe `paper_power`, in rooms by `FieldRoom`, in `Weaver(method=PowerFields(file))`."""

import math
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.board import Board
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.models.methods import Learned
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import WeightsCard, load_into, read_card
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.propagation.paths import Paths
from mmweaver.propagation.radar_equation import carrier, points_of
from mmweaver.propagation.speckle import place_of, radial_scatterers
from mmweaver.signal.point_response import PointResponse
from studies.paper.power_cells import CellSizes
from studies.paper.power_network import RECIPE, CellEchoes, PowerEncoding, PowerNetwork


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


def sample_cells(cells: CellEchoes, time_s: Tensor, config: RadarConfig, subject: int) -> Paths:
    """Cells with sampled phases.

    A cell is one scatterer at its place that moves with its velocity. It has one random phase, which turns with that
    velocity from frame to frame as it does from chirp to chirp; at rest it stays.

    Args:
        cells: (frame, segment, cell).
        time_s: (frame, segment).
        config: the radar.
        subject: whose phases they are.

    Returns:
        Paths (frame * segment, cell).
    """
    amplitude = points_of(cells, PointResponse(config)).amplitude
    turned = carrier(cells.velocity_mps.double() * time_s[..., None], config)
    place = radial_scatterers(cells, cells.range_m, cells.velocity_mps, 0 * cells.range_m)
    return Paths.direct(amplitude * turned * _cell_phases(cells.cell, subject), place).map(
        lambda tensor: tensor.flatten(0, 1)
    )


def _cell_phases(cell: Tensor, subject: int) -> Tensor:
    """exp(j phase) of each cell's number; a hash, for most cells of a room are never looked at (splitmix64)."""
    mixed = cell.numpy().astype(np.uint64) + stream(subject, "power field", "cells").integers(2**63, dtype=np.uint64)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    share = torch.from_numpy(((mixed ^ (mixed >> np.uint64(31))) >> np.uint64(40)).astype(np.float32) / 2**24)
    return torch.polar(torch.ones_like(share), 2 * math.pi * share)
