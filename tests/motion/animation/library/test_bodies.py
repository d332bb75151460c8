"""What legs and trunk do, seen from the joints: gait, kicks, jumps, lunges, bending, the floor, seats."""

import numpy as np
import pytest
from acted import HANDS, acted, axes, times

from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.assemble import dense_times
from mmweaver.motion.animation.carry_over import ControlsState
from mmweaver.motion.animation.controls import Controls
from mmweaver.motion.compose import compose
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.timing import plan_motion
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct

ANKLES, HEAD, NECK, PELVIS = [joint("left_ankle"), joint("right_ankle")], joint("head"), joint("neck"), 0
WRISTS = [joint(name) for name in HANDS]


@pytest.mark.parametrize("count", [2, 4])
def test_hops_are_counted_and_about_two_a_second(count: int):
    low = acted(f"hops {count} times", 0, 0.6 + 0.5 * count)[:, ANKLES, 2].min(axis=1)
    assert times(low > low.min() + 0.03) == count


@pytest.mark.parametrize("seed", range(3))
def test_a_jump_falls_freely(seed: int):
    joints = acted("jumps once", seed, 2.5)
    air = joints[:, [10, 11], 2].min(axis=1) > 0.05
    assert 0.15 < air.sum() / 120 < 0.5
    acceleration = np.gradient(np.gradient(joints[:, PELVIS, 2], 1 / 120), 1 / 120)
    assert acceleration[air].mean() == pytest.approx(-9.81, abs=0.5)


@pytest.mark.parametrize("count", [1, 2, 4])
def test_jumps_are_counted(count: int):
    assert times(acted(f"jumps {count} times", 0, 6.0)[:, [10, 11], 2].min(axis=1) > 0.05) == count


@pytest.mark.parametrize("seed", range(2))
def test_squats_are_two_at_least_and_who_remains_in_one_stays_down(seed: int):
    pelvis_m = acted("is doing squats", seed)[:, PELVIS, 2]
    assert times(pelvis_m < (pelvis_m.min() + pelvis_m.max()) / 2) >= 2
    pelvis_m = acted("squats down and remains in that position", seed, 4.0)[:, PELVIS, 2]
    assert pelvis_m[-1] < pelvis_m[0] - 0.25
    assert np.ptp(pelvis_m[-100:]) < 0.03


def test_hands_are_held_up_all_through_a_squat():
    joints = acted("does squats with the hands up")
    assert (joints[:, WRISTS, 2] - joints[:, [joint("spine3")], 2]).min() > -0.1


@pytest.mark.parametrize("text", ["lies down", "falls", "falls forward"])
@pytest.mark.parametrize("seed", range(2))
def test_who_is_down_lies_level_near_the_floor(text: str, seed: int):
    z = acted(text, seed, 5.0)[..., 2]
    assert z[0, HEAD] > 1.4
    trunk = z[-1, [joint(name) for name in ("pelvis", "spine1", "spine2", "spine3", "neck", "head")]]
    assert trunk.max() < 0.35
    assert trunk.min() > 0.02, "a body is thick"


@pytest.mark.parametrize("seed", range(2))
def test_a_fall_is_over_within_two_seconds_and_lying_down_is_not(seed: int):
    fast, slow = (acted(text, seed, 6.0)[:, PELVIS, 2] for text in ("falls", "lies down"))
    assert (fast > 0.4).sum() / 120 < 1.2
    assert (slow > 0.4).sum() > max(0.9 * 120, (fast > 0.4).sum())
    assert np.abs(np.gradient(fast, 1 / 120)).max() > 1.2


def test_forwards_is_on_the_belly_and_otherwise_on_the_back():
    for text, low, high in (("falls forward", 0.8, 9.0), ("falls", -9.0, -0.4)):
        joints = acted(text, 1, 5.0)
        assert low < (joints[-1, HEAD] - joints[0, PELVIS]) @ axes(joints)[0] < high


def test_a_forward_roll_goes_over_hands_and_back_and_stands_up_ahead():
    joints = acted("does a forward roll", 1)
    trunk, ahead = joints[:, NECK] - joints[:, PELVIS], joints[-1, PELVIS, :2] - joints[0, PELVIS, :2]
    assert 1.6 < np.hypot(*ahead) < 2.1
    turned = np.unwrap(np.arctan2(trunk[:, :2] @ (ahead / np.hypot(*ahead)), trunk[:, 2]))
    assert np.degrees(turned[-1] - turned[0]) == pytest.approx(360, abs=8)
    on_floor = joints[:, WRISTS, 2].max(axis=1) < 0.12
    assert 0.1 < on_floor.mean() < 0.5
    assert np.ptp(joints[:, WRISTS][on_floor][:10, :, :2], axis=0).max() < 0.06
    assert joints[:, HEAD, 2].min() < 0.3
    assert joints[:, ANKLES, 2].max() > 0.8
    assert joints[..., 2].min() > -0.005


def test_whoever_has_rolled_does_not_turn_back_afterwards():
    joints = acted("does two forward rolls, then waves")
    assert (joints[:, NECK] - joints[:, PELVIS])[-int(2.0 * 120) :, 2].min() > 0.3


def test_a_state_within_the_instant_where_a_whole_turn_is_taken_out_has_no_jump():
    time_s, standing = dense_times(2.0), act_out("a person stands", duration_s=2.0).controls
    assert standing is not None
    controls = Controls(**{name: np.zeros_like(values) for name, values in vars(standing).items()})
    controls.pelvis_rad[:, 1] = np.where(time_s < 1.0, 2 * np.pi, 0.0)
    assert abs(ControlsState.at(controls, time_s, 1.05).rate.pelvis_rad).max() < 1e-6


def test_a_cartwheel_is_refused_and_says_why():
    with pytest.raises(Exception, match="cartwheel"):
        parse("a person does a cartwheel")


def test_somebody_lies_on_the_couch_of_the_room_and_gets_up():
    scene = reconstruct(sample_photo()[0])
    plan = plan_motion("a person lies on the sofa, then gets up")
    motion = compose(plan, scene, seed=0, range_window_m=(0.7, 3.48))
    height_m = motion.pose.joints_m[..., 2] - scene.floor_z_m
    lying, standing = height_m[2], height_m[-3]
    couch_m = min(float(np.hypot(*(seat.position_m[:2] - motion.pose.joints_m[2, 0, :2]))) for seat in scene.seats)
    assert couch_m < 0.5
    assert 0.4 < lying[PELVIS] < 0.8
    assert abs(lying[NECK] - lying[PELVIS]) < 0.15
    assert standing[NECK] > 1.2
