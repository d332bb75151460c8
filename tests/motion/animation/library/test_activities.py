"""Every activity, whoever does it: bones, floor, speeds, accelerations, and no velocity that changes at once.

A velocity step keeps its size where the motion is sampled more finely, an acceleration does not: so joints are
composed at four times their usual rate. At that rate the hardest landings change a knee by 0.2 m/s from one sample to
the next.
"""

import numpy as np
import pytest

from mmweaver.core.skeleton import BONES, joint
from mmweaver.motion import continuous
from mmweaver.motion.animation import assemble
from mmweaver.motion.animation.library.activity_registry import GESTURES, POSTURES
from mmweaver.motion.continuous import ContinuousMotion
from mmweaver.motion.empty_floor import RADAR_HEIGHT_M, WINDOW_M, act_out, empty_floor
from mmweaver.motion.language.activities import BODY, HANDS
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.planning.placement import Conditions

FINER = 4
MAX_STEP_MPS = 0.35
FAST = {"jog", "kick", "throw", "golf", "jumping_jacks", "arm_circles", "jump", "leap", "walk"}


@pytest.fixture
def finer_times(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (assemble, continuous):
        monkeypatch.setattr(module, "RATE_HZ", FINER * assemble.RATE_HZ)


def largest_step_mps(pose) -> float:
    velocity = np.diff(pose.joints_m, axis=0) / np.diff(pose.time_s)[:, None, None]
    return float(np.linalg.norm(np.diff(velocity, axis=0), axis=-1).max())


def test_the_table_and_the_library_have_the_same_activities():
    assert set(POSTURES) == {activity.key for activity in BODY}
    assert set(GESTURES) == {activity.key for activity in HANDS}


# sway, breathing and tremor are added to the joints of a result: tests/motion/test_physiology.py
STILL = {"stand", "sit", "kneel", "lie", "lie_on_seat", "plank", "cross_arms", "hips"}


@pytest.mark.parametrize("activity", [*BODY, *HANDS], ids=lambda activity: activity.key)
def test_every_example_is_acted_out_as_a_body_can(activity, finer_times):
    pose = act_out(activity.example, seed=len(activity.key)).pose
    joints = pose.joints_m
    assert np.isfinite(joints).all()
    for parent, child in BONES:
        assert np.ptp(np.linalg.norm(joints[:, child] - joints[:, parent], axis=-1)) < 1e-3
    assert joints[..., 2].min() > -RADAR_HEIGHT_M - 0.015
    assert largest_step_mps(pose) < MAX_STEP_MPS
    joints, time_s = joints[::FINER], pose.time_s[::FINER]
    speed = np.linalg.norm(np.gradient(joints, time_s, axis=0), axis=-1)
    acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 120**2
    assert speed.max() < (8.0 if activity.key in FAST else 6.0)
    # peaks of the toes; low-passed at 12 Hz they are 45 to 58 m/s2, those of six recorded runners 70 to 110
    assert acceleration.max() < (240 if activity.key == "jog" else 160)
    moved_m = np.linalg.norm(np.ptp(joints - joints[:, :1], axis=0), axis=-1).max()
    assert moved_m > 0.004 or activity.key in STILL


@pytest.mark.parametrize(
    "text",
    [
        "does push-ups, takes two steps sideways to the right, then runs to the left",
        "combs the hair, then holds a plank, then sits down",
        "circles the arms twice, then puts the hands on the hips",
        "is boxing, then does a lunge, then crawls to the left",
        "does squats with the hands up, then lies down on the bed",
        "waves, then pedals on an exercise bike, then waves",
    ],
)
def test_no_transition_has_a_velocity_step(text: str, finer_times):
    assert largest_step_mps(act_out(f"a person {text}", seed=2).pose) < MAX_STEP_MPS


def test_a_stream_has_no_velocity_step_across_its_parts(finer_times):
    stream = ContinuousMotion(empty_floor(), Conditions(seed=3), frame_period_s=0.1, range_window_m=WINDOW_M)
    for text in ("runs to the left", "circles the arms", "does push-ups", "sits down", "walks to the right"):
        part = stream.act(parse(f"a person {text}"))
        assert largest_step_mps(part.pose) < MAX_STEP_MPS, text


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
