"""Strokes of a racket: where the hand comes from and where it goes."""

import numpy as np

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out


def _right_hand(text: str) -> np.ndarray:
    """The right wrist (n, 3) ahead, to the left and up of the pelvis, in the frame of the hips at the start."""
    joints = act_out(f"a person {text} with the right hand", seed=0, height_m=1.75).pose.joints_m.astype(float)
    across = (joints[0, joint("left_hip")] - joints[0, joint("right_hip")])[:2]
    left = np.append(across / np.hypot(*across), 0.0)
    frame = np.stack([np.cross(left, [0.0, 0.0, 1.0]), left, [0.0, 0.0, 1.0]])
    return (joints[:, joint("right_wrist")] - joints[:, 0]) @ frame.T


def test_a_forehand_starts_behind_at_its_own_side_and_ends_over_the_other_shoulder():
    hand = _right_hand("hits a forehand")
    back, ahead = np.argmin(hand[:, 0]), np.argmax(hand[:, 0])
    assert hand[back, 0] < -0.1
    assert hand[back, 1] < -0.3
    assert ahead > back
    assert hand[ahead:, 1].max() > 0.1


def test_a_backhand_starts_at_the_other_side_and_ends_at_its_own():
    hand = _right_hand("hits a backhand")
    across = np.argmax(hand[:, 1])
    assert hand[across, 1] > 0.15
    assert hand[across:, 1].min() < -0.35


def test_both_hands_stay_together_in_a_two_handed_backhand():
    joints = act_out("a person hits a two-handed backhand", seed=1, height_m=1.75).pose.joints_m
    gap = np.linalg.norm(joints[:, joint("left_wrist")] - joints[:, joint("right_wrist")], axis=1)
    middle = slice(len(gap) // 4, 3 * len(gap) // 4)
    assert gap[middle].max() < 0.3


def test_a_serve_hits_over_the_head_after_the_other_hand_has_thrown_the_ball_up():
    joints = act_out("a person serves a tennis ball with the right hand", seed=0, height_m=1.75).pose.joints_m
    left, right = (joints[:, joint(f"{side}_wrist"), 2] - joints[:, joint("head"), 2] for side in ("left", "right"))
    assert left.max() > 0.2
    assert right.max() > 0.25
    assert np.argmax(left) < np.argmax(right)
