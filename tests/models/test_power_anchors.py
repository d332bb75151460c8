"""What fields are counted from: areas lie where surfaces are, and bodies are near themselves."""

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.skeleton import joint
from mmweaver.models.power_anchors import (
    FIRST,
    LEAST_M2,
    STEP,
    BodyNearness,
    body_points,
    nearness,
    surface_values,
    surface_volume,
)
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.scene.procedural.procedural_room import make_room


@pytest.fixture(scope="module")
def view() -> SceneTensors:
    return SceneTensors.of(make_room("office", 0, 0).scene(), AWR1843)[None]


def _areas(volume: torch.Tensor) -> torch.Tensor:
    return (4 * volume).exp() * LEAST_M2 - LEAST_M2


def test_a_wall_lies_at_its_distance_and_faces_the_radar_at_its_foot(view: SceneTensors):
    wall = view.map(torch.clone)
    wall.depth_m[:] = 2.0
    wall.plane_half_m[:] = 0.0
    square = _areas(surface_volume(wall))[0, 2]
    node = torch.nonzero(square == square.max())[0]
    place = torch.tensor(FIRST) + node * torch.tensor(STEP)
    axis = torch.linalg.inv(wall.camera_from_radar[0])[:, 2]  # the optical axis, as the radar sees it
    assert torch.allclose(place, torch.stack([torch.tensor(2.0), axis[0], axis[2]]), atol=0.13)
    whole = float(_areas(surface_volume(wall))[0, 0].sum())
    rows, columns = wall.depth_m.shape[-2:]
    assert whole == pytest.approx(float(4.0 * rows * columns / wall.camera[0, :2].prod()), rel=0.02)


def test_faces_that_the_photo_does_not_show_are_there(view: SceneTensors):
    blind = view.map(torch.clone)
    blind.depth_m[:] = 0.0
    volume = _areas(surface_volume(blind))
    assert float(volume[:, 0].sum()) < 1e-3 * float(volume[:, 3].sum())
    at = (torch.tensor(FIRST) + torch.nonzero(volume[0, 3] == volume[0, 3].max()) * torch.tensor(STEP))[None].float()
    assert torch.allclose(surface_values(volume, at)[0, 0, 3], volume[0, 3].max(), rtol=1e-3)


def test_a_body_is_near_where_it_is_and_as_fast():
    generator = torch.Generator().manual_seed(0)
    joints = torch.tensor([0.3, 2.0, -0.5]) + 0.3 * torch.rand(22, 3, generator=generator)
    velocity = torch.zeros(22, 3)
    velocity[joint("left_wrist"), 1] = 2.0
    body = body_points(joints, velocity)
    hand = body[joint("left_wrist")]
    slower = hand - torch.tensor([0.0, 1.0, 0.0, 0.0])
    away = hand + torch.tensor([0.5, 0.0, 0.0, 0.0])
    near = nearness(body, torch.stack([hand, slower, away]))
    assert near[0] == 0
    assert near[1] < -1
    assert near[2] < near[1]
    values = BodyNearness()(body[None], torch.stack([hand, slower, away])[None])[0]
    assert (values[0, :4] > values[1, :4]).all()
    assert (values[1, :4] > values[2, :4]).all()
