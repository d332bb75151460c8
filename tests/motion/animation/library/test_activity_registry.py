"""Every activity, whoever does it: bones, floor, speeds and accelerations of a person."""

import numpy as np
import pytest

from mmweaver.core.skeleton import BONES, joint
from mmweaver.motion.animation.library.activity_registry import GESTURES, POSTURES
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, act_out
from mmweaver.motion.language.activities import BODY, BY_KEY, HANDS
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import natural_s

FAST = {"jog", "kick", "throw", "golf", "jumping_jacks", "arm_circles", "jump", "leap", "walk"}


def test_the_table_and_the_library_have_the_same_activities():
    assert set(POSTURES) == {activity.key for activity in BODY}
    assert set(GESTURES) == {activity.key for activity in HANDS}
    assert len(BY_KEY) == len(BODY) + len(HANDS) >= 30


@pytest.mark.parametrize("activity", [*BODY, *HANDS], ids=lambda activity: activity.key)
def test_every_example_is_acted_out_as_a_body_can(activity):
    seconds = max(1.5 * activity.natural_s, 1.1 * natural_s(parse(activity.example)))
    motion = act_out(activity.example, duration_s=seconds, seed=len(activity.key))
    joints = motion.pose.joints_m
    assert np.isfinite(joints).all()
    for parent, child in BONES:
        assert np.ptp(np.linalg.norm(joints[:, child] - joints[:, parent], axis=-1)) < 1e-3
    assert joints[..., 2].min() > -RADAR_HEIGHT_M - 0.015
    speed = np.linalg.norm(np.gradient(joints, motion.pose.time_s, axis=0), axis=-1)
    acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 120**2
    assert speed.max() < (8.0 if activity.key in FAST else 6.0)
    # peaks of the toes; low-passed at 12 Hz they are 45 to 58 m/s2, those of six recorded runners 70 to 110
    assert acceleration.max() < (240 if activity.key == "jog" else 160)
    assert np.linalg.norm(np.ptp(joints - joints[:, :1], axis=0), axis=-1).max() > 0.004


@pytest.mark.parametrize("text", ["a person walks", "a person waves", "a person sits down", "a person is boxing"])
def test_people_of_two_seeds_differ(text: str):
    one, other = (act_out(text, duration_s=3.0, seed=seed).pose.joints_m for seed in range(2))
    assert not np.allclose(one, other)


def test_the_other_hand_does_what_is_beside():
    """Arm by arm as each activity alone would move it; the head goes with the first."""
    motion = act_out("a person waves with the right hand while drinking with the left", seed=3, height_m=1.75)
    alone = act_out("a person drinks with the left hand", duration_s=motion.plan.duration_s, seed=3, height_m=1.75)
    joints, drinking = motion.pose.joints_m, alone.pose.joints_m
    height = joints[:, joint("right_wrist"), 2] - joints[:, joint("neck"), 2]
    assert np.median(height) > 0.0  # a waving hand is up
    to_head = np.linalg.norm(joints[:, joint("left_wrist")] - joints[:, joint("head")], axis=1)
    as_alone = np.linalg.norm(drinking[:, joint("left_wrist")] - drinking[:, joint("head")], axis=1)
    assert to_head.min() == pytest.approx(as_alone.min(), abs=0.04)
