"""Work about the house, coughing and breathing."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def _joints(text: str, seed: int = 1) -> np.ndarray:
    return act_out(f"a person {text}", seed=seed).pose.joints_m[2:-2].astype(float)


@pytest.mark.parametrize("text", ["sweeps the floor", "vacuums"])
def test_strokes_keep_the_hands_below_the_shoulders(text: str):
    joints = _joints(text)
    wrists = joints[:, [joint("left_wrist"), joint("right_wrist")]]
    assert (wrists[..., 2].max(axis=0) < joints[:, joint("neck"), 2].min()).all()
    assert np.linalg.norm(np.ptp(wrists, axis=0), axis=-1).max() > 0.15


def test_a_jacket_comes_off_behind_the_back():
    joints = _joints("takes off a jacket")
    left = (joints[:, joint("left_shoulder")] - joints[:, joint("right_shoulder")])[:, :2]
    ahead = np.column_stack([left[:, 1], -left[:, 0]]) / np.linalg.norm(left, axis=1, keepdims=True)
    for side in ("left", "right"):
        hand = ((joints[:, joint(f"{side}_wrist")] - joints[:, joint("spine3")])[:, :2] * ahead).sum(axis=1)
        assert hand.max() > 0.1
        assert hand.min() < -0.08


def test_a_cough_jerks_the_trunk_of_somebody_who_sits():
    joints = _joints("sits and coughs")
    head = joints[:, joint("head"), :2]
    speed = np.linalg.norm(np.diff(head, axis=0), axis=1) * 120
    assert speed.max() > 0.3
    assert np.ptp(joints[:, 0, 2]) < 0.02


def test_a_deep_breath_is_slow_and_small():
    joints = _joints("sits and breathes deeply")
    chest = joints[:, joint("neck")] - joints[:, 0]
    moved = np.linalg.norm(chest - chest[0], axis=1)
    assert 0.01 < moved.max() < 0.12
    assert np.linalg.norm(np.diff(chest, axis=0), axis=1).max() * 120 < 0.2


def test_who_trembles_shakes_several_times_a_second_and_hardly_moves():
    joints = _joints("trembles with cold for four seconds")[60:-120]
    wrist = joints[:, joint("left_wrist")] - joints[:, joint("spine3")]
    fast = wrist - np.apply_along_axis(lambda one: np.convolve(one, np.ones(25) / 25, "same"), 0, wrist)
    power = (np.abs(np.fft.rfft(fast[12:-12] * np.hanning(len(fast) - 24)[:, None], axis=0)) ** 2).sum(axis=1)
    rate_hz = np.fft.rfftfreq(len(fast) - 24, 1 / 120)
    assert 5 < rate_hz[int(power.argmax())] < 11
    assert 1e-3 < fast[12:-12].std(axis=0).max() < 2e-2


def test_a_baby_is_held_before_the_chest_and_rocked():
    joints = _joints("rocks a baby")
    wrists = joints[:, [joint("left_wrist"), joint("right_wrist")]]
    assert (np.linalg.norm(wrists - joints[:, [joint("spine3")]], axis=-1) < 0.45).all()
    assert np.ptp(joints[:, joint("neck"), :2], axis=0).max() > 0.02
