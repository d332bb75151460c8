"""The one table of the body: its pose, its hull, and what the motion planner derives from it."""

import numpy as np
import pytest

from mmweaver.core.body_capsules import (
    CAPSULES,
    REFERENCE_HEIGHT_M,
    hull,
    pose_capsules,
    radii_m,
    widths_per_depth,
)
from mmweaver.core.skeleton import BONES, JOINT_NAMES
from mmweaver.motion.planning import body_samples, separation
from tests.rooms import standing_person

JOINTS = standing_person((0.0, 2.0, -1.2)).joints_m[:1]


def test_rotations_are_rotations():
    posed = pose_capsules(JOINTS, REFERENCE_HEIGHT_M)
    assert np.allclose(np.swapaxes(posed.rotation, -1, -2) @ posed.rotation, np.eye(3), atol=1e-9)
    unit = posed.axis_m / np.linalg.norm(posed.axis_m, axis=-1, keepdims=True)
    assert np.allclose(posed.rotation[..., 2], unit)
    assert np.allclose(np.linalg.det(posed.rotation), 1)


def test_the_hull_is_closed_and_within_the_skin():
    vertices, faces = hull(pose_capsules(JOINTS, REFERENCE_HEIGHT_M), REFERENCE_HEIGHT_M)
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert np.all(count == 2)
    corners = vertices[0][faces]
    volume = np.einsum("fi,fi->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert 0.04 < volume < 0.16  # m3; overlaps count twice
    assert len(vertices[0]) == len(CAPSULES) * 14


def test_sizes_follow_the_height():
    assert np.allclose(radii_m(2 * REFERENCE_HEIGHT_M), 2 * radii_m(REFERENCE_HEIGHT_M))
    assert set(widths_per_depth()) == {1.0, 1.25}


def test_left_and_right_mirror_each_other():
    by_ends = {(capsule.start, capsule.end): capsule for capsule in CAPSULES}
    for (start, end), right in by_ends.items():
        if "right_" in start + end:
            left = by_ends[start.replace("right_", "left_"), end.replace("right_", "left_")]
            assert (left.start_radius_m, left.end_radius_m) == (right.start_radius_m, right.end_radius_m)
            assert left.rest == (-right.rest[0], *right.rest[1:])


@pytest.mark.parametrize("bone", BONES, ids=lambda bone: JOINT_NAMES[bone[1]])
def test_the_planner_keeps_people_apart_by_at_least_the_radars_body(bone: tuple[int, int]):
    """Spheres of `separation` and cylinders of `body_samples` are no thinner than the capsules' thinner end."""
    parent, child = (JOINT_NAMES[index] for index in bone)
    capsule = next((one for one in CAPSULES if (one.start, one.end) == (parent, child)), None)
    near, far = separation._bone_radii_m(parent, child)
    limb = next((radius for start, end, radius in body_samples.LIMBS if (start, end) == (parent, child)), None)
    if capsule is None:
        assert child.endswith(("hip", "collar"))
        assert near > 0.1
        return
    assert near >= capsule.start_radius_m - 1e-9
    assert far >= capsule.end_radius_m - 1e-9
    if limb is not None:
        assert capsule.end_radius_m <= limb <= capsule.start_radius_m + 0.025
