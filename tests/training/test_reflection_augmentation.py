"""Left-right reflection, once and twice."""

from dataclasses import fields

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.skeleton import joint
from mmweaver.models.scatterer_network import WeaverNetwork
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.propagation.mean_power import MeanPower
from mmweaver.propagation.radar_equation import points_of
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.training.network_examples import reflected_joints, reflected_scene


@pytest.fixture(scope="module")
def view() -> SceneTensors:
    return SceneTensors.stack([SceneTensors.of(reconstruct(make_room("office").photo()), AWR1843)])


def test_reflecting_twice_changes_nothing(view: SceneTensors):
    again = reflected_scene(reflected_scene(view))
    for field in fields(SceneTensors):
        torch.testing.assert_close(getattr(again, field.name), getattr(view, field.name), msg=field.name)
    joints = torch.from_numpy(np.random.default_rng(0).standard_normal((2, 22, 3))).float()
    assert torch.equal(reflected_joints(reflected_joints(joints)), joints)


def test_a_raised_right_hand_is_a_raised_left_hand():
    joints = torch.zeros(22, 3)
    joints[joint("right_wrist")] = torch.tensor([0.4, 2.0, 0.7])
    assert reflected_joints(joints)[joint("left_wrist")].tolist() == torch.tensor([-0.4, 2.0, 0.7]).tolist()


def test_the_network_s_static_map_is_reflected(view: SceneTensors):
    """Before training the network equals physics, which is symmetric under reflection."""
    torch.manual_seed(0)
    network, radar = WeaverNetwork().eval(), MeanPower(AWR1843)
    with torch.inference_mode():
        maps = [
            radar.maps(points_of(network.encode_room(one).static, radar.response)).range_azimuth
            for one in (view, reflected_scene(view))
        ]
    gap_db = 10 * torch.log10(maps[1].flip(-1) / maps[0])
    assert gap_db.abs().max() < 0.5
    assert (10 * torch.log10(maps[1] / maps[0])).abs().max() > 3
