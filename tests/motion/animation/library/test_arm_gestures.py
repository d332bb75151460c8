"""Where the hands are in gestures of the arms."""

import numpy as np
import pytest
from jaxtyping import Float

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out

SEEDS = range(4)


def hand_m(text: str, seed: int, side: str = "right") -> Float[np.ndarray, "n 3"]:
    """The wrist relative to the neck: ahead, to the person's right, up; in metres."""
    pose = act_out(f"a person {text}", seed=seed).pose
    joints = pose.joints_m[2:-2].astype(float)
    away = joints[:, joint(f"{side}_wrist")] - joints[:, joint("neck")]
    right = (joints[0, joint("right_hip")] - joints[0, joint("left_hip")])[:2]
    right = right / np.hypot(*right)
    ahead = np.array([-right[1], right[0]])
    return np.column_stack([away[:, :2] @ ahead, away[:, :2] @ right, away[:, 2]])


@pytest.mark.parametrize("seed", SEEDS)
def test_a_lifted_arm_stays_above_the_head_and_a_lowered_one_below(seed: int):
    up = hand_m("lifts the right arm straight up and keeps it above the head", seed)
    assert up[0, 2] < -0.3
    assert up[-1, 2] > 0.35
    assert np.ptp(up[-24:], axis=0).max() < 0.05
    down = hand_m("lets the right arm fall straight down", seed)
    assert down[0, 2] > 0.35 > -0.3 > down[-1, 2]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pushed_hand_ends_ahead_and_a_pulled_one_at_the_chest(seed: int):
    push = hand_m("pushes the right hand forward from the chest", seed)
    pull = hand_m("pulls the right hand back to the chest", seed)
    for near, far in ((push[0], push[-1]), (pull[-1], pull[0])):
        assert far[0] > near[0] + 0.2
        assert near[0] > 0.1, "before the chest, not in it"


def test_a_circle_comes_back_and_goes_clockwise_for_the_person():
    drawn = hand_m("draws a large circle with the right arm once", seed=1)
    across, up = drawn[:, 1] - np.ptp(drawn[:, 1]) / 2 - drawn[:, 1].min(), drawn[:, 2] - drawn[:, 2].mean()
    turned = np.unwrap(np.arctan2(up, across))
    assert turned[-1] - turned[0] < -0.9 * 2 * np.pi
    assert np.linalg.norm(drawn[-1] - drawn[0]) < 0.1
    assert np.ptp(drawn[:, 2]) > 0.35


def test_a_z_goes_across_down_and_across():
    drawn = hand_m("draws a large Z with the right arm", seed=1)
    n = len(drawn)
    first, last = drawn[: n // 3], drawn[2 * n // 3 :]
    assert first[:, 2].mean() > last[:, 2].mean() + 0.2
    assert drawn[np.argmax(first[:, 1]), 2] > 0
    assert drawn[-1, 1] > drawn[n // 2 :, 1].min() + 0.15, "the last stroke goes across from the lower corner"


def test_a_yawn_covers_the_mouth():
    hand = hand_m("yawns with the right hand", seed=2)
    assert abs(hand[-1, 1]) < 0.12
    assert -0.05 < hand[-1, 2] < 0.2


def test_a_forearm_is_raised_as_often_as_asked():
    hand = hand_m("raises the right hand from the elbow twice", seed=0)[:, 2]
    high = hand > hand.min() + 0.6 * np.ptp(hand)
    assert (np.diff(high.astype(int)) == 1).sum() == 2


@pytest.mark.parametrize("text", ["leans to the right, then leans to the left", "walks forward, then turns around"])
def test_an_arm_that_is_kept_up_does_not_come_down_between_steps(text: str):
    motion = act_out(f"a person lifts the left arm straight up and keeps it up, {text}", seed=1)
    assert [step.upper for step in motion.plan.steps] == ["raise_hold"] * 3
    over_m = motion.pose.joints_m[:, joint("left_wrist"), 2]
    over_m = over_m - motion.pose.joints_m[:, joint("left_shoulder"), 2]
    assert over_m[round(120 * motion.plan.steps[0].end_s) :].min() > 0.2
