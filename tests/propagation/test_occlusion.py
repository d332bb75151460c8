"""A person occludes what stands behind."""

import numpy as np
import pytest
import torch

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.propagation.body_model import average_body
from mmweaver.propagation.occlusion import occluded
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.visible_body import occluded_by
from tests.rooms import STANDING_M


def _standing(x: float, y: float, radar_height_m: float) -> torch.Tensor:
    joints = np.array([STANDING_M[name] for name in JOINT_NAMES]) + np.array([x, y, -radar_height_m])
    return torch.from_numpy(joints).float()


def _by_capsules(places_m: np.ndarray, joints: torch.Tensor) -> np.ndarray:
    return occluded(torch.from_numpy(places_m).float(), joints)[0].numpy()


def _by_rays(places_m: np.ndarray, joints: torch.Tensor) -> np.ndarray:
    """As the ray tracer asks of static paths that depart to these places and come back from there."""
    vertices, faces = average_body().hull(joints.double().numpy())
    length_m = 2 * np.linalg.norm(places_m, axis=1)[:, None, None]
    paths = StaticPaths.of(np.ones(len(places_m), complex), length_m, places_m, places_m, Interaction.DIFFUSE)
    found = occluded_by(RayCaster(vertices[0], faces), paths, np.arange(len(places_m)))
    return np.isin(np.arange(len(places_m)), found)


@pytest.mark.parametrize("decide", [_by_capsules, _by_rays], ids=["capsules", "rays"])
@pytest.mark.parametrize("away_m", [1.5, 2.0, 4.0])
def test_what_stands_in_front_of_a_body_is_not_occluded_and_what_stands_behind_is(decide, away_m: float):
    """Along the line through the chest, whose flesh ends 0.25 m before and behind its joints at most."""
    joints = _standing(0.0, away_m, 1.2)[None]
    chest_m = np.array([0.0, away_m, 0.05])
    before, behind = np.linspace(0.3, away_m - 0.25, 12), np.linspace(away_m + 0.35, 7.0, 12)
    assert not decide(before[:, None] * chest_m / away_m, joints).any()
    assert decide(behind[:, None] * chest_m / away_m, joints).all()


def test_thighs_occlude_all_along_and_not_about_joints_alone():
    """A wall's foot, the strongest echo of a room, shone between hip and knee."""
    heights = [0.52 + 0.02 * step for step in range(16)]
    behind = [(0.095 * 2, 4.0, 2 * (height - 0.7)) for height in heights]  # seen past a leg 2 m away
    assert all(occluded(torch.tensor(behind), _standing(0.0, 2.0, 0.7)[None])[0].tolist())


def test_places_may_differ_from_frame_to_frame():
    """Another person walks behind the one who stands."""
    joints = torch.stack([_standing(0.0, 2.0, 1.2)] * 2)
    places = torch.tensor([[(0.0, 4.0, 0.1), (1.0, 4.0, 0.1)], [(1.0, 4.0, 0.1), (0.1, 4.0, 0.1)]])
    assert occluded(places, joints).tolist() == [[True, False], [False, True]]


def test_agrees_with_the_rays_by_which_the_ray_tracer_decides():
    """Capsules in the network, rays at the hull of the same capsules in the ray tracer."""
    joints = _standing(0.1, 2.0, 1.0)[None]
    across, up = np.meshgrid(np.linspace(-1.0, 1.4, 61), np.linspace(-2.2, 1.8, 101), indexing="ij")
    places = np.stack([across, np.full(across.shape, 4.0), up], axis=-1).reshape(-1, 3)
    vertices, faces = average_body().hull(joints.double().numpy())
    by_rays = ~RayCaster(vertices[0], faces).is_clear(np.zeros_like(places), places)
    by_capsules = occluded(torch.from_numpy(places), joints)[0].numpy()
    assert by_rays.sum() > 300
    assert (by_rays != by_capsules).sum() < 0.1 * by_rays.sum()  # at its rim
