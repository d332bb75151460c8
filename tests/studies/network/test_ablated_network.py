"""What stands in for parts that are left out: the same energy, no knowledge; and the network uses it."""

import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.skeleton import NUM_JOINTS
from mmweaver.models.body_anchors import NUM_ANCHORS, body_anchors
from mmweaver.models.frame_motion import FrameMotion
from mmweaver.models.scatterer_network import body_prior
from mmweaver.models.scene_tensors import SceneTensors
from mmweaver.scene.procedural.procedural_room import make_room
from studies.network.ablated_network import (
    FLAT_M2,
    STRENGTH,
    AblatedNetwork,
    flat_body,
    joints_alone,
    uniform_surfaces,
)
from tests.rooms import standing_person


@pytest.fixture(scope="module")
def view() -> SceneTensors:
    return SceneTensors.stack([SceneTensors.of(make_room("office", 0, 0).scene(), AWR1843)])


@pytest.fixture(scope="module")
def motion() -> tuple[torch.Tensor, torch.Tensor]:
    own = FrameMotion.of(standing_person((0.2, 2.2, -1.2), (0.0, -0.5, 0.0)), AWR1843, 3)
    return torch.from_numpy(own.joints_m).float()[None], torch.from_numpy(own.velocity_mps).float()[None]


def test_surfaces_that_are_alike_keep_their_places_and_their_sum(view: SceneTensors):
    known = view.point_cross_section_m2
    expected = torch.log10(known.clamp(min=1e-12)) / 4
    there = known > 0
    assert torch.allclose(view.point_features[..., STRENGTH][there], expected[there], atol=1e-4)
    alike = uniform_surfaces(view)
    assert torch.allclose(alike.point_cross_section_m2.sum(), known.sum(), rtol=1e-4)
    assert len(torch.unique(alike.point_cross_section_m2[there])) == 1
    assert torch.equal(alike.point_m, view.point_m)
    assert not alike.point_features[..., STRENGTH].any()


def test_a_body_without_echoes_between_joints_returns_as_much(view: SceneTensors, motion: tuple[torch.Tensor, ...]):
    body, prior = body_anchors(*motion, view), body_prior(motion[0])
    fewer, given = joints_alone(body, prior)
    assert fewer.share[..., :NUM_JOINTS].all()
    assert not fewer.share[..., NUM_JOINTS:].any()
    assert torch.allclose(given.cross_section_m2.sum(-1), prior.cross_section_m2.sum(-1), rtol=1e-4)
    assert not given.cross_section_m2[..., NUM_JOINTS:].any()
    assert (flat_body(prior).cross_section_m2 == FLAT_M2).all()


@pytest.mark.parametrize(
    ("part", "rests", "moves"),
    [("room prior", True, False), ("body prior", False, True), ("between joints", False, True), ("ghosts", False, True),
     ("faces", True, False)],
)  # fmt: skip
def test_leaving_a_part_out_changes_what_it_is_about(
    view: SceneTensors, motion: tuple[torch.Tensor, ...], part: str, rests: bool, moves: bool
):
    echoes = []
    for without in ((), (part,)):
        torch.manual_seed(0)
        network = AblatedNetwork(without).eval()
        with torch.inference_mode():
            code = network.encode_room(view)
            echoes.append((code.static.cross_section_m2, network.moving(code, *motion).cross_section_m2))
    (rest, moving), (other_rest, other_moving) = echoes
    assert torch.equal(rest, other_rest) is not rests
    assert torch.equal(moving, other_moving) is not moves
    if part == "ghosts":
        assert moving[..., NUM_ANCHORS:].sum() > 0
        assert not other_moving[..., NUM_ANCHORS:].any()
