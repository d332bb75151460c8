"""From photo and motion to the signal by the paper's network: recipe `paper`, a row of `learned_scores`."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid, RadarCube, Scene
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.models.weights import load_into
from mmweaver.scene.reconstruction import reconstruct
from studies.paper.paper_inr import InrField, InrShape
from studies.paper.paper_network import PaperNetwork

RECIPE = "paper"
UNIT_DB = 25.0  # the network's 1.0 above a sample's noise, the median peak; a constant, for it must hold in new rooms
MOTION_SCALE = 2.0  # metres, and metres a second


def load_paper(file: Path) -> PaperNetwork:
    """Reads weights of recipe `paper`. Raises InputError for any other file."""
    network = PaperNetwork()
    load_into(network, file, recipe=RECIPE, made_by="python -m studies run train_paper")
    return network


def paper_method(weights: Path) -> Callable[[Any], RadarCube]:
    """A row of `learned_scores`: the cube of a `Case`, from room.photo, room.config and joints."""
    network = load_paper(weights)

    def method(case: Any) -> RadarCube:
        joints, velocity = case.joints
        return paper_field(network, reconstruct(case.room.photo), case.room.config, joints, velocity).cube()

    return method


def paper_field(
    network: PaperNetwork, scene: Scene, config: RadarConfig, joints_m: np.ndarray, velocity_mps: np.ndarray
) -> InrField:
    """The INR that the network predicts from the photo of a room and one motion. Raises InputError for other joints."""
    if joints_m.shape != velocity_mps.shape or joints_m.shape[1:] != (22, 3):
        raise InputError(f"the network needs joints and velocities (frame, 22, 3), not {joints_m.shape}")
    return field_of_image(network, SceneTensors.of(scene, config).image, config, joints_m, velocity_mps)


def field_of_image(
    network: PaperNetwork, image: Tensor, config: RadarConfig, joints_m: np.ndarray, velocity_mps: np.ndarray
) -> InrField:
    """The same from a picture (5, row, column) of a room; the field is on the CPU wherever the network is."""
    device = next(network.parameters()).device
    motion = motion_of(torch.from_numpy(joints_m).float(), torch.from_numpy(velocity_mps).float())
    with torch.inference_mode():
        theta, gamma, beta = (part[0].float().cpu().clone() for part in network(*_on(device, image, motion)))
    return InrField(
        config=config, grid=CubeGrid.of(config, len(joints_m)), scale=1.0, shape=InrShape(), theta=theta, gamma=gamma,
        beta=beta, amplitude=unit_sqrt_mw(config), is_centred=False,
    )  # fmt: skip


def _on(device: torch.device, *tensors: Tensor) -> list[Tensor]:
    return [tensor[None].to(device) for tensor in tensors]


def motion_of(joints_m: Tensor, velocity_mps: Tensor) -> Tensor:
    """Input of the pose encoder, (..., frame, 22, 6)."""
    return torch.cat([joints_m, velocity_mps], dim=-1) / MOTION_SCALE


def unit_sqrt_mw(config: RadarConfig) -> float:
    """The value of the network's 1.0 in sqrt(mW): about the largest |I| or |Q| of a typical sequence."""
    return float(np.sqrt(config.noise_power_mw)) * 10 ** (UNIT_DB / 20)
