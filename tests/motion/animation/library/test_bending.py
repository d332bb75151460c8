"""Which way the trunk goes."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def _head_relative_to_pelvis(text: str) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2): metres ahead and to the body's left of the pelvis, of somebody who does not turn."""
    joints_m = act_out(f"a person {text}", seed=3, height_m=1.75).pose.joints_m
    left = joints_m[0, joint("left_hip"), :2] - joints_m[0, joint("right_hip"), :2]
    left = left / np.linalg.norm(left)
    offset = joints_m[:, joint("head"), :2] - joints_m[:, joint("pelvis"), :2]
    return offset @ np.array([left[1], -left[0]]), offset @ left


def test_who_leans_to_the_left_has_the_head_left_of_the_pelvis_and_comes_up():
    _, left_m = _head_relative_to_pelvis("leans to the left")
    assert left_m.max() > 0.15
    assert left_m.min() > -0.05
    assert abs(left_m[-1]) < 0.05


def test_who_leans_back_has_the_head_behind_the_pelvis():
    ahead_m, _ = _head_relative_to_pelvis("leans back")
    assert ahead_m.min() < ahead_m[0] - 0.1


def test_who_twists_turns_the_shoulders_both_ways_over_feet_that_stay():
    joints_m = act_out("a person twists the upper body", seed=3, height_m=1.75).pose.joints_m
    across = joints_m[:, joint("left_shoulder"), :2] - joints_m[:, joint("right_shoulder"), :2]
    angle = np.unwrap(np.arctan2(across[:, 1], across[:, 0]))
    assert np.ptp(angle) > 1.2
    assert np.ptp(joints_m[:, joint("left_ankle"), :2], axis=0).max() < 0.05


def test_who_stays_bent_is_down_until_the_end_of_the_step():
    ahead_m, _ = _head_relative_to_pelvis("bends down and stays bent over for four seconds")
    assert (ahead_m > 0.25).mean() > 0.5


def test_who_stays_down_at_the_end_comes_up_only_where_the_sentence_says_so():
    def last_height_m(text: str) -> float:
        return act_out(f"a person {text}", seed=3, height_m=1.75).pose.joints_m[-1, joint("head"), 2]

    down_m, up_m = last_height_m("bends down and stays there"), last_height_m("bends down, pauses, then stands up")
    assert up_m - down_m > 0.4
