"""HumanML3D features: there and back, and each column by its meaning. The real sample: tests/real."""

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.humanml3d_features import features_from_joints, y_up
from mmweaver.motion.mocap.joint_arrays import CONTACTS, ROTATIONS, VELOCITIES, joints_from_features


def test_joints_come_back():
    """Up to where the format puts them: origin, floor, first frame towards +z."""
    joints = y_up(walk(20.0, 3.0))
    again = joints_from_features(features_from_joints(joints))
    assert again.shape == (59, 22, 3)
    for k in (0, 30, 58):
        gaps = np.linalg.norm(joints[k, :, None] - joints[k, None], axis=-1)
        np.testing.assert_allclose(np.linalg.norm(again[k, :, None] - again[k, None], axis=-1), gaps, atol=1e-9)
    way = np.linalg.norm(joints[-2, 0] - joints[0, 0])
    assert np.linalg.norm(again[-1, 0] - again[0, 0]) == pytest.approx(way, abs=1e-9)
    assert abs(again[0, 0, [0, 2]]).max() < 1e-12
    assert again[..., 1].min() == pytest.approx(0.0, abs=1e-5)
    across = again[0, 1] - again[0, 2] + again[0, 16] - again[0, 17]  # to the left: +x, for it looks along +z
    assert across[0] > 0.99 * np.linalg.norm(across[[0, 2]])


def test_turning_and_moving_the_recording_changes_nothing():
    joints = y_up(walk(20.0, 3.0))
    angle = 1.1
    matrix = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    moved = joints @ matrix.T + np.array([3.0, 0.7, -2.0])
    np.testing.assert_allclose(features_from_joints(moved), features_from_joints(joints), atol=1e-9)


def test_columns_mean_what_they_say():
    """A body that only glides along its own facing at 1 m/s: 0.05 m ahead each frame, no turn, feet that never rest."""
    joints = np.repeat(y_up(walk(20.0, 1.0))[:1], 10, axis=0)
    facing = np.cross([0.0, 1.0, 0.0], joints[0, 2] - joints[0, 1] + joints[0, 17] - joints[0, 16])
    facing /= np.linalg.norm(facing)
    features = features_from_joints(joints + 0.05 * np.arange(10)[:, None, None] * facing)
    np.testing.assert_allclose(features[1:, 0], 0, atol=1e-9)
    ways = features[1:, VELOCITIES].reshape(-1, 22, 3)
    np.testing.assert_allclose(np.linalg.norm(ways[..., [0, 2]], axis=-1), 0.05, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(features[1:, 1:3], axis=-1), 0.05, atol=1e-9)
    assert features[:, 2].min() > 0.045  # ahead is +z
    assert (features[:, CONTACTS] == 0).all()
    assert (features_from_joints(joints)[:, CONTACTS] == 1).all()
    columns = features[:, ROTATIONS].reshape(-1, 21, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(columns, axis=-1), 1, atol=1e-9)
    np.testing.assert_allclose(np.sum(columns[:, :, 0] * columns[:, :, 1], axis=-1), 0, atol=1e-9)


def test_one_frame_has_no_features():
    with pytest.raises(InputError, match="two frames"):
        features_from_joints(np.zeros((1, 22, 3)))
