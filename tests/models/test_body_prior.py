"""The prior of a body's parts against the simulator's own skin."""

import numpy as np
import pytest
import torch

from mmweaver.core.skeleton import JOINT_NAMES, joint
from mmweaver.models.body_anchors import NUM_GHOSTS, NUM_REFLECTORS
from mmweaver.models.scatterer_network import BOTH_WAYS, body_prior, ghost_section
from mmweaver.propagation.body_model import ScatteringBody
from tests.rooms import STANDING_M


def _standing(y: float, turn_deg: float = 0.0) -> np.ndarray:
    """A person ahead of a radar at chest height, who looks at it or is turned."""
    joints = np.array([STANDING_M[name] for name in JOINT_NAMES])
    turn = np.deg2rad(turn_deg)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return joints @ rotation.T + np.array([0.0, y, -1.2])


def _prior(joints: np.ndarray):
    return body_prior(torch.from_numpy(joints).float()[None, None])


def test_its_sum_is_that_of_a_simulated_person():
    """Of many skins, for one skin's few facing points scatter."""
    for turn_deg in (0.0, 30.0, 180.0):
        joints = _standing(2.0, turn_deg)
        totals = []
        for subject in range(20):
            body = ScatteringBody(subject, 1.75)
            skin = body.skin(joints[None])
            cos = -(skin.normal * skin.place_m).sum(-1) / np.linalg.norm(skin.place_m, axis=-1)
            totals.append((body.echo.monostatic(cos) * body.area_m2 * body.brightness).sum())
        total = float(_prior(joints).cross_section_m2.sum())
        assert abs(10 * np.log10(total / np.mean(totals))) < 4


def test_skin_lies_before_the_bones():
    prior = _prior(_standing(2.0))
    share = prior.cross_section_m2 / prior.cross_section_m2.sum()
    assert -0.25 < float((share * prior.offset_m).sum()) < -0.02
    assert float(prior.offset_m.abs().max()) <= 0.3


def test_an_arm_square_to_the_line_of_sight_returns_more_than_one_that_points_at_the_radar():
    down, ahead = _standing(2.0), _standing(2.0)
    for part, reach in (("elbow", 0.26), ("wrist", 0.5)):
        ahead[joint(f"right_{part}")] = ahead[joint("right_shoulder")] + np.array([0.0, -reach, 0.0])
    arm = [joint("right_elbow"), joint("right_wrist")]
    assert float(_prior(down).cross_section_m2[0, 0, arm].sum()) > float(
        _prior(ahead).cross_section_m2[0, 0, arm].sum()
    )


def test_ghosts_share_out_what_the_body_returns():
    joints = torch.from_numpy(_standing(2.0)).float()[None, None]
    prior = body_prior(joints)
    ghosts = ghost_section(joints, prior)
    assert ghosts.shape == (1, 1, NUM_GHOSTS)
    of_each_face = ghosts.unflatten(-1, (NUM_REFLECTORS, -1)).sum(-1)
    whole = float(BOTH_WAYS * prior.cross_section_m2.sum())
    assert of_each_face.flatten().tolist() == pytest.approx([whole] * NUM_REFLECTORS, rel=1e-4)
