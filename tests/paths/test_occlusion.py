"""A person hides what stands behind."""

import numpy as np
import torch

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.paths.mean_paths import Echoes
from mmweaver.paths.occlusion import hidden
from tests.rooms import STANDING_M


def _echoes(places: list[tuple[float, float, float]]) -> Echoes:
    place = torch.tensor(places)
    distance = place.norm(dim=-1)
    return Echoes(
        range_m=distance, velocity_mps=0 * distance, direction=(place / distance[:, None])[:, [0, 2]],
        cross_section_m2=torch.ones_like(distance),
    )  # fmt: skip


def _standing(x: float, y: float, radar_height_m: float) -> torch.Tensor:
    joints = np.array([STANDING_M[name] for name in JOINT_NAMES]) + np.array([x, y, -radar_height_m])
    return torch.from_numpy(joints).float()


def test_behind_the_chest_is_hidden_and_the_rest_is_not():
    behind, before, beside, above = (0.0, 4.0, 0.1), (0.0, 1.0, 0.0), (0.9, 4.0, 0.1), (0.0, 4.0, 1.6)
    echoes = _echoes([behind, before, beside, above])
    assert hidden(echoes, _standing(0.0, 2.0, 1.2)[None]).tolist() == [[True, False, False, False]]


def test_the_shadow_moves_with_the_person():
    echoes = _echoes([(0.0, 4.0, 0.1), (1.0, 4.0, 0.1)])
    joints = torch.stack([_standing(0.0, 2.0, 1.2), _standing(0.5, 2.0, 1.2)])
    assert hidden(echoes, joints).tolist() == [[True, False], [False, True]]


def test_thighs_hide_all_along_and_not_about_joints_alone():
    """A wall's foot, the strongest echo of a room, shone between hip and knee."""
    heights = [0.52 + 0.02 * step for step in range(16)]
    behind = [(0.095 * 2, 4.0, 2 * (height - 0.7)) for height in heights]  # seen past a leg 2 m away
    assert all(hidden(_echoes(behind), _standing(0.0, 2.0, 0.7)[None])[0].tolist())
