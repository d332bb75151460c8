"""Ghosts: where a body's images in a room's faces lie, and what of a wave gets there."""

import numpy as np
import pytest
import torch

from mmweaver.core.boards import PRESETS
from mmweaver.core.records import Plane
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.models.body_anchors import MIRRORED, NUM_REFLECTORS, Anchors, ghost_anchors
from mmweaver.models.scene_tensors import SceneTensors
from tests.rooms import STANDING_M, back_wall, floor, scene_of, side_wall

SPINE = 1  # of MIRRORED
STANDING = torch.tensor([STANDING_M[name] for name in JOINT_NAMES]) + torch.tensor([0.0, 2.0, -1.2])


def _ghosts(*planes: Plane) -> Anchors:
    """Of one person who stands still, (face, joint)."""
    view = SceneTensors.stack([SceneTensors.of(scene_of((floor(), *planes)), PRESETS["awr1843"])])
    joints = STANDING.float()[None, None]
    return ghost_anchors(joints, torch.zeros_like(joints), view)


def _by_face(values: torch.Tensor) -> torch.Tensor:
    return values[0, 0].unflatten(0, (NUM_REFLECTORS, len(MIRRORED)))


def test_a_ghost_lies_between_the_body_and_its_image():
    found = _by_face(_ghosts(side_wall(0.95)).range_m)
    place = STANDING[MIRRORED[SPINE]].numpy()
    image = place * [-1, 1, 1] + [2 * 0.95, 0, 0]
    assert float(found[1, SPINE]) == pytest.approx((np.linalg.norm(place) + np.linalg.norm(image)) / 2, abs=1e-3)


def test_metal_throws_back_more_than_wood_and_a_missing_face_nothing():
    share = {name: _by_face(_ghosts(side_wall(0.95, name)).share) for name in ("metal", "wood")}
    assert float(share["metal"][1, SPINE]) > 5 * float(share["wood"][1, SPINE]) > 0
    assert float(share["metal"][2:].sum()) == 0


def test_who_stands_before_a_wall_is_hardly_seen_in_it():
    """Skin that faces the radar does not face the wall behind."""
    beside, behind = _by_face(_ghosts(side_wall(0.95, "metal")).share), _by_face(_ghosts(back_wall(3.0, "metal")).share)
    assert float(beside[1, SPINE]) > 10 * float(behind[1, SPINE])
