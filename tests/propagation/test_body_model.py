"""The body: skin near the bones, outward normals, the same person every time, a believable cross-section."""

import numpy as np
import pytest

from mmweaver.core.body_capsules import CAPSULES
from mmweaver.propagation.body_model import ScatteringBody
from tests.rooms import standing_person

PERSON = standing_person((0.0, 2.0, -1.2))
JOINTS = PERSON.joints_m[:1]


def distance_to_bones(points: np.ndarray, starts: np.ndarray, axes: np.ndarray) -> np.ndarray:
    along = np.einsum("pi,ci->pc", points, axes) - (starts * axes).sum(-1)
    share = np.clip(along / np.maximum((axes**2).sum(-1), 1e-9), 0, 1)
    nearest = starts[None] + share[..., None] * axes[None]
    return np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)


def test_skin_lies_about_the_bones_and_looks_outwards():
    body = ScatteringBody(0, 1.75)
    skin = body.skin(JOINTS)
    posed = body.posed(JOINTS)
    starts, axes = posed.start_m, posed.axis_m
    distance = distance_to_bones(skin.place_m[0], starts[0], axes[0])
    assert distance.max() < 0.20
    assert np.allclose(np.linalg.norm(skin.normal, axis=-1), 1)
    further = distance_to_bones(skin.place_m[0] + 0.02 * skin.normal[0], starts[0], axes[0])
    assert (further > distance).mean() > 0.85  # joints overlap, so not all


def test_the_person_keeps_the_skin_and_others_have_another():
    assert np.array_equal(ScatteringBody(1, 1.7).micro_phase, ScatteringBody(1, 1.9).micro_phase)
    assert not np.array_equal(ScatteringBody(1, 1.7).micro_phase, ScatteringBody(2, 1.7).micro_phase)


def test_turning_an_arm_spins_no_skin():
    """Raising the arm by 2 mm moves no point of it by more than its lever allows."""
    joints = np.repeat(JOINTS, 2, axis=0)
    joints[1, [20]] += [0.0, 0.0, 0.002]
    body = ScatteringBody(0, 1.75)
    places = body.skin(joints).place_m
    assert np.linalg.norm(places[1] - places[0], axis=-1).max() < 0.005
    assert np.linalg.norm(places[1] - places[0], axis=-1).max() == pytest.approx(0.003, abs=0.0015)


def test_skin_of_a_tapering_limb_faces_its_thin_end():
    """Of a truncated cone normals are square to its flanks, not to its axis."""
    body = ScatteringBody(0, 1.75, 4000)
    skin = body.skin(JOINTS[:1])
    shin = next(k for k, c in enumerate(CAPSULES) if (c.start, c.end) == ("left_knee", "left_ankle"))
    axis = JOINTS[0, 7] - JOINTS[0, 4]
    lean = skin.normal[0][body.part == shin] @ (axis / np.linalg.norm(axis))
    assert np.degrees(np.arcsin(lean)) == pytest.approx(np.degrees(np.arctan((0.055 - 0.038) / 0.4)), abs=0.05)
