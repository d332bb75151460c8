"""What hands and arms do, seen from the joints: gestures, work, instruments, boxing, tennis."""

import numpy as np
import pytest
from acted import HANDS, acted, away, axes, times

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out

WRISTS = [joint(name) for name in HANDS]
MAX_MPS2 = 150.0  # of any joint, as in streams; published fists reach 60 to 100


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("text", ["drinks with the right hand", "sits and drinks with the left hand"])
def test_the_cup_reaches_the_mouth(text: str, seed: int):
    joints = acted(text, seed, 3.0)
    mouth = joints[:, joint("head")] + 0.058 * 1.75 * axes(joints)[0]
    distance = np.linalg.norm(joints[:, WRISTS["right" in text]] - mouth, axis=1)
    assert distance.min() < 0.12
    assert distance.max() > 0.25


@pytest.mark.parametrize(
    "text", ["waves", "claps", "drinks", "punches", "raises both hands", "walks", "does jumping jacks", "squats"]
)
def test_hands_stay_out_of_the_trunk(text: str):
    """A trunk of 9 cm about the spine (11 cm about the pelvis is where hanging hands come closest)."""
    joints = acted(text, 0, 3.0)
    trunk = [joint(name) for name in ("pelvis", "spine1", "spine2", "spine3", "neck", "head")]
    assert np.linalg.norm(joints[:, WRISTS, None] - joints[:, None, trunk], axis=-1).min() > 0.09


@pytest.mark.parametrize(("text", "count"), [("claps twice", 2), ("claps four times", 4)])
def test_claps_are_counted(text: str, count: int):
    joints = acted(text, 1, 4.0)
    assert times(np.linalg.norm(joints[:, WRISTS[0]] - joints[:, WRISTS[1]], axis=1) < 0.15) == count


def test_punches_are_counted():
    joints = acted("punches three times", 1, 4.0)
    reach = np.linalg.norm(joints[:, WRISTS] - joints[:, [joint("spine3")]], axis=-1).max(axis=1)
    assert times(reach > reach.min() + 0.7 * np.ptp(reach)) == 3


def test_a_waving_hand_also_comes_and_goes():
    """Square to the line of sight alone it would have no Doppler: a tenth to two thirds of its speed is ahead."""
    shares = []
    for seed in range(6):
        speed = np.diff(away(acted("waves with the right hand", seed, 3.0), "right_wrist", "right_shoulder"), axis=0)
        shares.append(np.std(speed[60:-60, 0]) / np.linalg.norm(np.std(speed[60:-60], axis=0)))
    assert min(shares) > 0.1
    assert max(shares) < 0.67
    assert np.median(shares) > 0.2


def test_who_has_turned_points_to_the_side_that_is_named():
    """Left in the photo is x < 0; what counts is the heading of the pointing step, not that of the walk before."""
    joints = acted("walks away for five seconds, turns around and points to the left")[-int(1.6 * 120) :]
    across = joints[:, WRISTS, 0] - joints[:, [joint("neck")], 0]
    assert across.min() < -0.4
    assert across.max() < 0.4


@pytest.mark.parametrize(
    ("text", "is_ahead"),
    [
        ("walks forward with the arms out to the sides", False),
        ("walks with the arms stretched out in front of him", True),
        ("holds the arms out to the sides", False),
        ("holds the arms out in front", True),
    ],
)
def test_arms_are_held_out_where_the_sentence_says_whichever_way_the_walk_goes(text: str, is_ahead: bool) -> None:
    joints = acted(text, 3)
    ahead_m, aside_m, _ = away(joints[int(0.55 * len(joints)) :], "left_wrist", "left_shoulder")[0]
    assert (ahead_m > 0.3) == is_ahead
    assert (aside_m > 0.3) != is_ahead


def test_a_forearm_is_raised_as_often_as_asked():
    hand = away(acted("raises the right hand from the elbow twice"), "right_wrist")[:, 2]
    assert times(hand > hand.min() + 0.6 * np.ptp(hand)) == 2


@pytest.mark.parametrize("text", ["leans to the right, then leans to the left", "walks forward, then turns around"])
def test_an_arm_that_is_kept_up_does_not_come_down_between_steps(text: str):
    motion = act_out(f"a person lifts the left arm straight up and keeps it up, {text}", seed=1)
    over_m = away(motion.pose.joints_m, "left_wrist", "left_shoulder")[:, 2]
    assert over_m[round(120 * motion.plan.steps[0].end_s) :].min() > 0.2


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("text", ["throws a jab, a cross, a hook and an uppercut", "punches quickly"])
def test_fists_are_as_fast_as_fists(text: str, seed: int):
    joints = acted(text, seed)
    speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * 120
    assert 2.5 < speed[:, WRISTS].max() < 9.0
    assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * 120**2 < MAX_MPS2


def test_both_hands_stay_together_in_a_two_handed_backhand():
    gap = np.linalg.norm(away(acted("hits a two-handed backhand", 1), "left_wrist", "right_wrist"), axis=1)
    assert gap[len(gap) // 4 : 3 * len(gap) // 4].max() < 0.3
