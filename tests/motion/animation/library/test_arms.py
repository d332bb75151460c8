"""What hands and arms do, seen from the joints: gestures, work, instruments, boxing, tennis."""

import numpy as np
import pytest
from acted import HANDS, SIDES, acted, away, axes, times

from mmweaver.core.skeleton import joint
from mmweaver.motion.empty_floor import act_out

WRISTS = [joint(name) for name in HANDS]
MAX_MPS2 = 150.0  # of any joint, as in streams; published fists reach 60 to 100


@pytest.mark.parametrize("seed", range(2))
def test_clapping_hands_meet_and_do_not_cross(seed: int):
    joints = acted("claps", seed, 3.0)
    gap = (away(joints, "left_wrist") - away(joints, "right_wrist"))[:, 1]
    assert 0.03 < gap.min() < 0.12
    assert gap.max() > 0.2


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


@pytest.mark.parametrize("seed", range(2))
def test_a_lifted_arm_stays_above_the_head_and_a_lowered_one_below(seed: int):
    up = away(acted("lifts the right arm straight up and keeps it above the head", seed), "right_wrist", "neck")
    assert up[0, 2] < -0.3
    assert up[-1, 2] > 0.35
    assert np.ptp(up[-24:], axis=0).max() < 0.05
    down = away(acted("lets the right arm fall straight down", seed), "right_wrist", "neck")
    assert down[0, 2] > 0.35 > -0.3 > down[-1, 2]


@pytest.mark.parametrize("seed", range(2))
def test_a_pushed_hand_ends_ahead_and_a_pulled_one_at_the_chest(seed: int):
    push = away(acted("pushes the right hand forward from the chest", seed), "right_wrist", "neck")
    pull = away(acted("pulls the right hand back to the chest", seed), "right_wrist", "neck")
    for near, far in ((push[0], push[-1]), (pull[-1], pull[0])):
        assert far[0] > near[0] + 0.2
        assert near[0] > 0.1, "before the chest, not in it"


def test_a_circle_comes_back_and_goes_clockwise_for_the_person():
    drawn = away(acted("draws a large circle with the right arm once", 1), "right_wrist", "neck") * [1, -1, 1]
    across, up = drawn[:, 1] - np.ptp(drawn[:, 1]) / 2 - drawn[:, 1].min(), drawn[:, 2] - drawn[:, 2].mean()
    turned = np.unwrap(np.arctan2(up, across))
    assert turned[-1] - turned[0] < -0.9 * 2 * np.pi
    assert np.linalg.norm(drawn[-1] - drawn[0]) < 0.1
    assert np.ptp(drawn[:, 2]) > 0.35


def test_a_z_goes_across_down_and_across():
    drawn = away(acted("draws a large Z with the right arm", 1), "right_wrist", "neck") * [1, -1, 1]
    n = len(drawn)
    first, last = drawn[: n // 3], drawn[2 * n // 3 :]
    assert first[:, 2].mean() > last[:, 2].mean() + 0.2
    assert drawn[np.argmax(first[:, 1]), 2] > 0
    assert drawn[-1, 1] > drawn[n // 2 :, 1].min() + 0.15, "the last stroke goes across from the lower corner"


def test_a_yawn_covers_the_mouth():
    hand = away(acted("yawns with the right hand", 2), "right_wrist", "neck")
    assert abs(hand[-1, 1]) < 0.12
    assert -0.05 < hand[-1, 2] < 0.2


def test_a_forearm_is_raised_as_often_as_asked():
    hand = away(acted("raises the right hand from the elbow twice"), "right_wrist")[:, 2]
    assert times(hand > hand.min() + 0.6 * np.ptp(hand)) == 2


@pytest.mark.parametrize("text", ["leans to the right, then leans to the left", "walks forward, then turns around"])
def test_an_arm_that_is_kept_up_does_not_come_down_between_steps(text: str):
    motion = act_out(f"a person lifts the left arm straight up and keeps it up, {text}", seed=1)
    over_m = away(motion.pose.joints_m, "left_wrist", "left_shoulder")[:, 2]
    assert over_m[round(120 * motion.plan.steps[0].end_s) :].min() > 0.2


@pytest.mark.parametrize("text", ["sweeps the floor", "vacuums"])
def test_strokes_keep_the_hands_below_the_shoulders(text: str):
    joints = acted(text, 1)
    assert joints[:, WRISTS, 2].max() < joints[:, joint("neck"), 2].min()
    assert np.linalg.norm(np.ptp(joints[:, WRISTS], axis=0), axis=-1).max() > 0.15


@pytest.mark.parametrize("hand", HANDS)
def test_a_jacket_comes_off_behind_the_back(hand: str):
    ahead = away(acted("takes off a jacket", 1), hand, "spine3")[:, 0]
    assert ahead.max() > 0.1
    assert ahead.min() < -0.08


def test_a_cough_jerks_the_trunk_of_somebody_who_sits():
    joints = acted("sits and coughs", 1)
    assert np.linalg.norm(np.diff(joints[:, joint("head"), :2], axis=0), axis=1).max() * 120 > 0.3
    assert np.ptp(joints[:, 0, 2]) < 0.02


def test_a_deep_breath_is_slow_and_small():
    chest = away(acted("sits and breathes deeply", 1), "neck")
    assert 0.01 < np.linalg.norm(chest - chest[0], axis=1).max() < 0.12
    assert np.linalg.norm(np.diff(chest, axis=0), axis=1).max() * 120 < 0.2


def test_who_trembles_shakes_several_times_a_second_and_hardly_moves():
    wrist = away(acted("trembles with cold for four seconds", 1)[60:-120], "left_wrist", "spine3")
    fast = wrist - np.apply_along_axis(lambda one: np.convolve(one, np.ones(25) / 25, "same"), 0, wrist)
    power = (np.abs(np.fft.rfft(fast[12:-12] * np.hanning(len(fast) - 24)[:, None], axis=0)) ** 2).sum(axis=1)
    rate_hz = np.fft.rfftfreq(len(fast) - 24, 1 / 120)
    assert 5 < rate_hz[int(power.argmax())] < 11
    assert 1e-3 < fast[12:-12].std(axis=0).max() < 2e-2


def test_a_baby_is_held_before_the_chest_and_rocked():
    joints = acted("rocks a baby", 1)
    assert np.linalg.norm(joints[:, WRISTS] - joints[:, [joint("spine3")]], axis=-1).max() < 0.45
    assert np.ptp(joints[:, joint("neck"), :2], axis=0).max() > 0.02


def test_who_opens_a_door_steps_back_and_returns():
    feet = acted("opens the door")[:, (7, 8), :2]
    moved_m = np.linalg.norm(feet - feet[0], axis=2).max(axis=0)
    assert moved_m.max() > 0.15 > moved_m.min()
    assert np.linalg.norm(feet[-1] - feet[0], axis=1).max() < 0.03


@pytest.mark.parametrize(("side", "other"), SIDES)
@pytest.mark.parametrize("name", ["jab", "cross", "hook", "uppercut"])
def test_the_named_fist_hits_ahead_and_comes_back_while_the_other_stays(name: str, side: str, other: str):
    joints = acted(f"throws a {side} {name}")
    fist, still = (away(joints, f"{one}_wrist", "spine3") for one in (side, other))
    gone = np.linalg.norm(fist - fist[0], axis=1)
    assert gone.max() > max(0.15, np.linalg.norm(still - still[0], axis=1).max())
    assert fist[:, 0].max() > 0.33
    assert gone[-1] < 0.08


def test_a_hook_goes_around_and_an_uppercut_comes_from_below():
    jab, hook = (away(acted(f"throws a left {name}"), "left_wrist", "spine3") for name in ("jab", "hook"))
    uppercut = away(acted("throws a right uppercut"), "right_wrist", "spine3")
    assert np.ptp(hook[:, 1]) > np.ptp(jab[:, 1]) + 0.05
    assert uppercut[:, 2].min() < uppercut[0, 2] - 0.12


@pytest.mark.parametrize(("name", "acting"), [("jab", 0), ("cross", 1), ("hook", 0)])
def test_the_hand_in_front_jabs_and_hooks_and_the_other_one_crosses(name: str, acting: int):
    joints = acted(f"throws a {name}")
    hands = [away(joints, hand, "spine3") for hand in HANDS]
    gone = [np.linalg.norm(hand - hand[0], axis=1).max() for hand in hands]
    assert gone[acting] > gone[1 - acting]


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("text", ["throws a jab, a cross, a hook and an uppercut", "punches quickly"])
def test_fists_are_as_fast_as_fists(text: str, seed: int):
    joints = acted(text, seed)
    speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * 120
    assert 2.5 < speed[:, WRISTS].max() < 9.0
    assert np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1).max() * 120**2 < MAX_MPS2


def test_a_forehand_starts_behind_at_its_own_side_and_ends_over_the_other_shoulder():
    hand = away(acted("hits a forehand with the right hand"), "right_wrist")
    back, ahead = np.argmin(hand[:, 0]), np.argmax(hand[:, 0])
    assert hand[back, 0] < -0.1
    assert hand[back, 1] < -0.3
    assert ahead > back
    assert hand[ahead:, 1].max() > 0.1


def test_a_backhand_starts_at_the_other_side_and_ends_at_its_own():
    hand = away(acted("hits a backhand with the right hand"), "right_wrist")
    across = np.argmax(hand[:, 1])
    assert hand[across, 1] > 0.15
    assert hand[across:, 1].min() < -0.35


def test_both_hands_stay_together_in_a_two_handed_backhand():
    gap = np.linalg.norm(away(acted("hits a two-handed backhand", 1), "left_wrist", "right_wrist"), axis=1)
    assert gap[len(gap) // 4 : 3 * len(gap) // 4].max() < 0.3


def test_a_serve_hits_over_the_head_after_the_other_hand_has_thrown_the_ball_up():
    joints = acted("serves a tennis ball with the right hand")
    left, right = (away(joints, hand, "head")[:, 2] for hand in HANDS)
    assert left.max() > 0.2
    assert right.max() > 0.25
    assert np.argmax(left) < np.argmax(right)
