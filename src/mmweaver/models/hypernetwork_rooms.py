"""Rooms whose signal comes from a hypernetwork: of target power (`FieldRoom`) or target signal (`SignalRoom`)."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube, Scene
from mmweaver.core.seeding import stream
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.hypernetwork import HyperNetwork
from mmweaver.models.neural_path_solver import LearnedRoom
from mmweaver.models.power_cells import CellSizes
from mmweaver.models.power_network import CellEchoes, PowerEncoding, PowerNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import SIGNAL, WeightsCard, load_into, read_card
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.propagation.paths import Paths
from mmweaver.propagation.radar_equation import carrier, points_of
from mmweaver.propagation.speckle import place_of, radial_scatterers
from mmweaver.signal.cube import adc_from_cube
from mmweaver.signal.point_response import PointResponse


def load_hypernetwork(file: Path) -> tuple[HyperNetwork | PowerNetwork, WeightsCard]:
    """Loads weights of `mmweaver train hypernetwork` of either target.

    Raises:
        InputError: For any other file.
    """
    card = read_card(file)
    if card.target is None:
        raise InputError(f"{file} holds weights of recipe {card.recipe!r}; give those of: mmweaver train hypernetwork")
    network = HyperNetwork() if card.target == SIGNAL else PowerNetwork()
    load_into(network, file)
    return network, card


class FieldRoom(LearnedRoom):
    """A room whose echoes are the cells of a field, read at the radar's own resolution; first order alone."""

    has_anchors = has_others = False

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


class SignalRoom:
    """A room whose complex signal a hypernetwork writes as an INR, the paper's system: one person, no board, no noise.

    Args:
        network: The hypernetwork.
        scene: The room.
        config: The radar.

    Raises:
        InputError: For a radar elsewhere than at the camera.
    """

    background = None

    def __init__(self, network: HyperNetwork, scene: Scene, config: RadarConfig) -> None:
        if not scene.radar_pose.is_at_camera:
            raise InputError("a hypernetwork of target signal knows radars at the camera alone; take target power")
        self.network, self.config = network.eval(), config
        self.image = SceneTensors.of(scene, config).image

    def signal(
        self, motions: Sequence[FrameMotion], *, seed: int, keep_adc: bool, first_frame: int = 0,
        num_frames: int | None = None,
    ) -> tuple[RadarCube, AdcCube | None]:  # fmt: skip
        """The cube, and optionally samples with that cube; see `LearnedRoom.signal`.

        Raises:
            InputError: For no person, or several.
        """
        if len(motions) != 1:
            raise InputError(f"a hypernetwork of target signal knows one person, not {len(motions)}; take target power")
        own = motions[0]
        middle = slice(own.num_segments // 2, None, own.num_segments)
        joints_m, velocity_mps = own.joints_m[middle], own.velocity_mps[middle]
        field = self.network.field(self.image, self.config, joints_m, velocity_mps)
        shown = slice(own.num_before, None)
        grid = CubeGrid.of(self.config, len(joints_m) - own.num_before, first_frame)
        cube = RadarCube(values=field.cube().values[shown], grid=grid, config=self.config, scale=1.0)
        return cube, adc_from_cube(cube) if keep_adc else None


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
