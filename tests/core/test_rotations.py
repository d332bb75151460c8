"""The level frame."""

import numpy as np
import pytest

from mmweaver.core.rotations import level_from_camera, pitch_and_roll_rad


@pytest.mark.parametrize(("pitch_deg", "roll_deg"), [(0, 0), (30, 0), (-12, 4), (20, -7)])
def test_pitch_and_roll_come_back(pitch_deg: int, roll_deg: int):
    pitch, roll = np.deg2rad([pitch_deg, roll_deg])
    up = np.array([-np.sin(roll) * np.cos(pitch), -np.cos(roll) * np.cos(pitch), -np.sin(pitch)])
    rotation = level_from_camera(up)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)
    np.testing.assert_allclose(rotation @ up, [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(pitch_and_roll_rad(rotation), (pitch, roll), atol=1e-12)


def test_y_is_the_horizontal_direction_of_the_optical_axis():
    forward = level_from_camera(np.array([0.0, -np.cos(0.5), -np.sin(0.5)])) @ np.array([0.0, 0, 1])
    assert forward[0] == pytest.approx(0)
    assert forward[1] == pytest.approx(np.cos(0.5))
    assert forward[2] == pytest.approx(-np.sin(0.5))
