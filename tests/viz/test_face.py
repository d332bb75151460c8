"""A face looks where the head does: to both sides of a shaken head, down in a nod, ahead otherwise."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out
from mmweaver.viz.body_rasteriser import face_capsules, head_axes


def angles_rad(sentence: str) -> tuple[np.ndarray, np.ndarray]:
    """Yaw to the left and pitch down of the head relative to the hips, over a sentence."""
    joints_m = act_out(sentence, duration_s=3.0, seed=1).pose.joints_m.astype(float)
    ahead, _ = head_axes(joints_m)
    left = (joints_m[:, joint("left_hip")] - joints_m[:, joint("right_hip")])[:, :2]
    front = np.stack([left[:, 1], -left[:, 0]], axis=1)
    yaw = np.arctan2(ahead[:, 1], ahead[:, 0]) - np.arctan2(front[:, 1], front[:, 0])
    return (yaw + np.pi) % (2 * np.pi) - np.pi, -np.arcsin(ahead[:, 2])


def test_a_shaken_head_looks_to_both_sides_and_a_nod_down():
    yaw, _ = angles_rad("a person shakes the head")
    assert yaw.max() > 0.25
    assert yaw.min() < -0.25
    still, down = angles_rad("a person nods")
    assert np.abs(still).max() < 0.2
    assert np.ptp(down) > 0.14


def test_who_looks_around_turns_the_head_further():
    yaw, _ = angles_rad("a person looks around")
    assert np.ptp(yaw) == pytest.approx(1.8, abs=0.7)


def test_the_nose_is_ahead_of_the_face():
    joints_m = act_out("a person stands still", duration_s=1.0, seed=1).pose.joints_m[:1].astype(float)
    ahead, _ = head_axes(joints_m)
    ends_m, radii_m = face_capsules(joints_m, 1.75)
    tip_m = (ends_m[0, 1, 1] - ends_m[0, 0, 0]) @ ahead[0] + radii_m[1, 1]
    assert tip_m > radii_m[0].max() + 0.02
