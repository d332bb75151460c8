"""A forward roll: hands on the floor, over the back, and up on the feet again ahead."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import dense_times
from mmweaver.motion.animation.carry_over import ControlsState
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out
from mmweaver.motion.language.sentence import parse


def _rolled(text: str, seed: int) -> np.ndarray:
    """Joints (n, 22, 3), z from the floor."""
    joints = act_out(text, seed=seed, height_m=1.75).pose.joints_m.astype(float)
    return joints + np.array([0.0, 0.0, RADAR_HEIGHT_M])


@pytest.mark.parametrize("seed", range(3))
def test_the_body_goes_over_its_hands_and_back_and_stands_up_ahead(seed: int):
    joints = _rolled("a person does a forward roll", seed)
    trunk = joints[:, joint("neck")] - joints[:, 0]
    ahead = joints[-1, 0, :2] - joints[0, 0, :2]
    assert 1.6 < np.hypot(*ahead) < 2.1
    turned = np.unwrap(np.arctan2(trunk[:, :2] @ (ahead / np.hypot(*ahead)), trunk[:, 2]))
    assert np.degrees(turned[-1] - turned[0]) == pytest.approx(360, abs=8)
    wrists = joints[:, (joint("left_wrist"), joint("right_wrist"))]
    on_floor = wrists[..., 2].max(axis=1) < 0.12
    assert 0.1 < on_floor.mean() < 0.5
    still = wrists[on_floor][:10, :, :2]
    assert np.ptp(still, axis=0).max() < 0.06
    assert joints[:, joint("head"), 2].min() < 0.3
    assert joints[:, (joint("left_ankle"), joint("right_ankle")), 2].max() > 0.8
    assert joints[..., 2].min() > -0.005


def test_whoever_has_rolled_does_not_turn_back_afterwards():
    joints = _rolled("a person does two forward rolls, then waves", 0)
    trunk = joints[:, joint("neck")] - joints[:, 0]
    last = trunk[-int(2.0 * 120) :, 2]
    assert last.min() > 0.3
    acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 120**2
    assert acceleration.max() < 150


def test_a_state_within_the_instant_where_a_whole_turn_is_taken_out_has_no_jump():
    from mmweaver.motion.animation.controls import Controls

    time_s = dense_times(2.0)
    n = len(time_s)
    turned = np.where(time_s < 1.0, 2 * np.pi, 0.0)
    zeros = {
        "pelvis_m": (n, 3), "heading_rad": (n,), "pelvis_rad": (n, 3), "spine_rad": (n, 3), "head_rad": (n, 2),
        "arm_rad": (n, 2, 4), "foot_m": (n, 2, 3), "foot_rad": (n, 2, 2), "knee_out_rad": (n, 2), "knee_up_rad": (n,),
        "roll_over_rad": (n,), "knee_room": (n,), "contact": (n, 2),
    }  # fmt: skip
    controls = Controls(**{name: np.zeros(shape) for name, shape in zeros.items()})
    controls.pelvis_rad[:, 1] = turned
    assert abs(ControlsState.at(controls, time_s, 1.05).rate.pelvis_rad).max() < 1e-6


def test_a_cartwheel_is_refused_and_says_why():
    with pytest.raises(Exception, match="upside down on stretched arms"):
        parse("a person does a cartwheel")
