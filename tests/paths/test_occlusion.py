"""A person occludes what stands behind."""

import math

import numpy as np
import pytest
import torch

from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.geometry.ray_caster import RayCaster
from mmweaver.paths import occlusion
from mmweaver.paths.body_model import average_body
from mmweaver.paths.occlusion import occluded
from tests.rooms import STANDING_M


def _standing(x: float, y: float, radar_height_m: float) -> torch.Tensor:
    joints = np.array([STANDING_M[name] for name in JOINT_NAMES]) + np.array([x, y, -radar_height_m])
    return torch.from_numpy(joints).float()


def test_behind_the_chest_is_occluded_and_the_rest_is_not():
    behind, before, beside, above = (0.0, 4.0, 0.1), (0.0, 1.0, 0.0), (0.9, 4.0, 0.1), (0.0, 4.0, 1.6)
    places = torch.tensor([behind, before, beside, above])
    assert occluded(places, _standing(0.0, 2.0, 1.2)[None]).tolist() == [[True, False, False, False]]


def test_occlusion_moves_with_the_person():
    places = torch.tensor([(0.0, 4.0, 0.1), (1.0, 4.0, 0.1)])
    joints = torch.stack([_standing(0.0, 2.0, 1.2), _standing(0.5, 2.0, 1.2)])
    assert occluded(places, joints).tolist() == [[True, False], [False, True]]


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


def test_no_ray_that_meets_a_body_is_left_out(monkeypatch: pytest.MonkeyPatch):
    """Bodies anywhere about the radar, over and under it too: the same as with every ray asked."""
    rng = np.random.default_rng(0)
    places = torch.from_numpy(rng.normal(0.0, 5.0, (3000, 3))).float()
    bearing, away = rng.uniform(0, 2 * math.pi, 40), rng.uniform(0.0, 3.0, 40)
    joints = torch.stack(
        [_standing(r * math.cos(angle), r * math.sin(angle), 1.0) for angle, r in zip(bearing, away, strict=True)]
    )
    joints[::3, :, 2] += 2.0
    found = occluded(places, joints)
    monkeypatch.setattr(occlusion, "_towards", lambda rays, *_: torch.ones(rays.shape[:2], dtype=torch.bool))
    assert torch.equal(found, occluded(places, joints))
    assert 0.02 < found.float().mean() < 0.3
