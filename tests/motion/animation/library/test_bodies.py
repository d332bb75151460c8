"""What legs and trunk do, seen from the joints: gait, kicks, jumps, lunges, bending, the floor, seats."""

import numpy as np
import pytest
from acted import HANDS, SIDES, acted, away, axes, bend_deg, times

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


@pytest.mark.parametrize(("side", "other"), SIDES)
@pytest.mark.parametrize("text", ["kicks with the {} foot", "raises the {} leg", "stamps with the {} foot"])
def test_the_leg_that_is_said_acts(text: str, side: str, other: str):
    joints = acted(text.format(side), 3, 3.0)
    assert joints[:, joint(f"{side}_ankle"), 2].max() > 0.2
    assert joints[:, joint(f"{other}_ankle"), 2].max() < 0.12, "the other one stands"


@pytest.mark.parametrize("text", ["stands on the left leg", "hops on the left leg"])
def test_on_the_left_leg_the_right_one_is_lifted(text: str):
    left, right = np.split(acted(text, 0, 3.0)[:, ANKLES, 2], 2, axis=1)
    middle = slice(len(left) // 3, 2 * len(left) // 3)
    assert right[middle].min() > left[middle].max()


def test_a_high_kick_is_higher():
    high, low = (
        [acted(text, seed, 3.0)[:, ANKLES, 2].max() for seed in range(4)] for text in ("performs a high kick", "kicks")
    )
    assert min(high) > max(low)


@pytest.mark.parametrize(("direction", "sign"), [("back", -1.0), ("forwards", 1.0)])
def test_a_leg_is_kicked_to_the_side_that_is_said(direction: str, sign: float):
    way_m = away(acted(f"kicks the right leg {direction}"), "right_ankle")[:, 0]
    assert sign * way_m[np.argmax(np.abs(way_m))] > 0.3


@pytest.mark.parametrize(("side", "other"), SIDES)
@pytest.mark.parametrize(("kick", "axis", "high_m"), [("roundhouse", 0, 0.5), ("side", 1, 0.4)])
def test_a_turned_kick_hits_its_way_over_a_foot_that_stays(kick: str, axis: int, high_m: float, side: str, other: str):
    joints = acted(f"does a {kick} kick with the {side} leg")
    out = 1 if side == "left" else -1
    foot = (joints[:, joint(f"{side}_ankle")] - joints[0, joint(f"{side}_ankle")]) @ axes(joints).T * [1, out, 1]
    hit = np.argmax(foot[:, axis])
    assert foot[hit, axis] > 0.5
    assert foot[hit, 2] > high_m
    still = joints[:, joint(f"{other}_ankle")]
    assert np.linalg.norm(still - still[0], axis=1).max() < 0.04
    if kick == "roundhouse":
        across = joints[:, joint("left_hip")] - joints[:, joint("right_hip")]
        turn = np.unwrap(np.arctan2(across[:, 1], across[:, 0]))
        assert foot[:hit, 1].max() > 0.3
        assert np.degrees(((turn - turn[0]) * -out).max()) > 55
        assert np.linalg.norm(foot[-1]) < 0.05


@pytest.mark.parametrize("count", [2, 4])
def test_hops_are_counted_and_about_two_a_second(count: int):
    low = acted(f"hops {count} times", 0, 0.6 + 0.5 * count)[:, ANKLES, 2].min(axis=1)
    assert times(low > low.min() + 0.03) == count


@pytest.mark.parametrize("text", ["hops on one leg in a circle", "hops forward five times on the right leg"])
def test_hops_carry_the_body_and_the_foot_stays_where_it_lands(text: str) -> None:
    joints = acted(text, 1)
    assert np.hypot(*np.diff(joints[::12, 0, :2], axis=0).T).sum() > 1.2
    foot = joints[:, ANKLES[int(np.argmin(joints[60:-60, ANKLES, 2].mean(axis=0)))]]
    speed_mps = np.hypot(*(np.diff(foot[:, :2], axis=0) * 120).T)
    assert np.median(speed_mps[foot[1:, 2] < foot[:, 2].min() + 0.005]) < 0.1


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


@pytest.mark.parametrize("seed", range(3))
def test_a_squat_bends_the_knees_on_wide_feet(seed: int):
    """As the first subject of MARS does it: 122 degrees, feet 0.49 m apart."""
    joints = acted("squats", seed, 2.0)
    for side in ("left", "right"):
        assert 100 < bend_deg(joints, f"{side}_hip", f"{side}_knee", f"{side}_ankle").max() < 138
    assert 0.28 < np.linalg.norm((joints[:, ANKLES[0]] - joints[:, ANKLES[1]])[:, :2], axis=1).max() < 0.62


@pytest.mark.parametrize("seed", range(2))
def test_jacks_spread_arms_and_legs_together(seed: int):
    joints = acted("does three jumping jacks", seed, 4.0)
    feet = np.linalg.norm(joints[:, ANKLES[0]] - joints[:, ANKLES[1]], axis=1)
    hands = joints[:, WRISTS, 2].mean(axis=1)
    assert feet.max() > feet.min() + 0.3
    assert hands.max() > joints[:, HEAD, 2].max() + 0.1
    assert np.corrcoef(feet, hands)[0, 1] > 0.8
    assert times(feet > (feet.min() + feet.max()) / 2) == 3


@pytest.mark.parametrize("seed", range(2))
def test_squats_are_two_at_least_and_who_remains_in_one_stays_down(seed: int):
    pelvis_m = acted("is doing squats", seed)[:, PELVIS, 2]
    assert times(pelvis_m < (pelvis_m.min() + pelvis_m.max()) / 2) >= 2
    pelvis_m = acted("squats down and remains in that position", seed, 4.0)[:, PELVIS, 2]
    assert pelvis_m[-1] < pelvis_m[0] - 0.25
    assert np.ptp(pelvis_m[-100:]) < 0.03


def test_stepping_up_lifts_the_body_by_a_stair_and_returns():
    height_m = acted("steps up and down twice", 1)[:, PELVIS, 2]
    assert 0.12 < np.ptp(height_m) < 0.25
    assert abs(height_m[-1] - height_m[0]) < 0.03


@pytest.mark.parametrize(("side", "sign"), [("left", 1.0), ("right", -1.0)])
def test_a_side_lunge_goes_over_the_bent_leg_from_a_wide_stance_with_the_arms_out(side: str, sign: float):
    joints = acted(f"does side lunges with the {side} leg", 1)
    aside = joints @ axes(joints)[1]
    deepest = np.argmin(joints[:, PELVIS, 2])
    assert 0.1 < sign * (aside[deepest, PELVIS] - aside[0, PELVIS]) < 0.6
    assert 0.05 < joints[0, PELVIS, 2] - joints[deepest, PELVIS, 2] < 0.4
    assert (aside[:, ANKLES[0]] - aside[:, ANKLES[1]]).min() > 0.38
    assert (aside[:, WRISTS[0]] - aside[:, WRISTS[1]]).min() > 1.0


@pytest.mark.parametrize(("side", "other"), SIDES)
def test_a_limb_extension_raises_leg_and_arm_of_one_side(side: str, other: str):
    rise = np.ptp(acted(f"extends the {side} arm and leg to the side", 1)[:, :, 2], axis=0)
    assert rise[joint(f"{side}_wrist")] > 0.8
    assert rise[joint(f"{side}_ankle")] > 0.05
    assert rise[joint(f"{other}_ankle")] < 0.03
    assert rise[joint(f"{other}_wrist")] < 0.3


def test_an_arm_extension_is_repeated_above_the_shoulder():
    high = away(acted("extends the right arm up at the side three times"), "right_wrist", "right_shoulder")[:, 2]
    assert times(high > 0.25) == 3
    assert high.min() < -0.4


def test_hands_are_held_up_all_through_a_squat():
    joints = acted("does squats with the hands up")
    assert (joints[:, WRISTS, 2] - joints[:, [joint("spine3")], 2]).min() > -0.1


def test_a_front_lunge_leaves_the_leg_behind_straight():
    joints = acted("does front lunges with the left leg")
    bend = bend_deg(joints, "right_hip", "right_knee", "right_ankle")
    assert bend[np.argmin(joints[:, PELVIS, 2])] < 35


def test_some_keep_both_feet_where_they_are_between_front_lunges():
    ways = [acted("does three front lunges with the left leg", seed)[:, ANKLES[0], :2] for seed in range(8)]
    steps = [np.ptp(way[len(way) // 4 : 3 * len(way) // 4], axis=0).max() for way in ways]
    assert min(steps) < 0.02
    assert max(steps) > 0.3


def test_poses_of_yoga_are_as_their_names_say():
    tree, warrior, dog = (
        joints[len(joints) // 2]
        for joints in map(acted, ("does the tree pose", "holds the warrior pose", "does the downward dog"), (2, 2, 2))
    )
    low, high = sorted(tree[ANKLES, 2])
    assert low < 0.15
    assert high > 0.4
    assert tree[WRISTS, 2].min() > tree[HEAD, 2]
    assert np.linalg.norm(warrior[ANKLES[0], :2] - warrior[ANKLES[1], :2]) > 0.75
    assert np.linalg.norm(warrior[WRISTS[0]] - warrior[WRISTS[1]]) > 1.2
    assert dog[:, 2].argmax() in (PELVIS, joint("left_hip"), joint("right_hip"), joint("spine1"))
    assert dog[WRISTS, 2].max() < 0.25


def test_who_leans_comes_up_and_who_leans_back_has_the_head_behind_the_pelvis():
    left_m, ahead_m = away(acted("leans to the left", 3), "head")[:, 1], away(acted("leans back", 3), "head")[:, 0]
    assert left_m.max() > 0.15
    assert left_m.min() > -0.05
    assert abs(left_m[-1]) < 0.05
    assert ahead_m.min() < ahead_m[0] - 0.1


def test_who_twists_turns_the_shoulders_both_ways_over_feet_that_stay():
    joints = acted("twists the upper body", 3)
    across = joints[:, joint("left_shoulder"), :2] - joints[:, joint("right_shoulder"), :2]
    assert np.ptp(np.unwrap(np.arctan2(across[:, 1], across[:, 0]))) > 1.2
    assert np.ptp(joints[:, ANKLES[0], :2], axis=0).max() < 0.05


def test_who_stays_bent_is_down_until_the_end_unless_the_sentence_says_otherwise():
    assert (away(acted("bends down and stays bent over for four seconds", 3), "head")[:, 0] > 0.25).mean() > 0.5
    down, up = (acted(text, 3) for text in ("bends down and stays there", "bends down, pauses, then stands up"))
    assert up[-1, HEAD, 2] - down[-1, HEAD, 2] > 0.4


def test_hula_hooping_hips_go_round_while_feet_and_head_stay():
    joints = acted("hula hoops", 2, 4.0)
    hips = joints[:, PELVIS, :2] - joints[:, PELVIS, :2].mean(axis=0)
    angle = np.unwrap(np.arctan2(hips[:, 1], hips[:, 0]))
    assert 3 < abs(angle[-1] - angle[0]) / (2 * np.pi) < 9
    assert np.hypot(*hips.T).min() > 0.02
    assert np.ptp(joints[:, ANKLES[0], :2], axis=0).max() < 0.01
    assert np.ptp(joints[:, HEAD, :2], axis=0).max() < 2 * np.ptp(hips, axis=0).max()


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("side", "sign"), [("left", -1.0), ("right", 1.0)])
def test_sidesteps_go_to_the_side_that_is_said_facing_as_before_and_never_cross(side: str, sign: float, seed: int):
    joints = acted(f"takes two steps sideways to the {side}", seed, 3.0)
    assert sign * (joints[-1, PELVIS, 0] - joints[0, PELVIS, 0]) > 0.25
    across = joints[:, joint("left_hip"), :2] - joints[:, joint("right_hip"), :2]
    assert np.ptp(np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))) < 0.4
    assert np.sum((joints[:, ANKLES[0], :2] - joints[:, ANKLES[1], :2]) * across, axis=1).min() > 0


@pytest.mark.parametrize(
    ("text", "way"),
    [("to the left", (-1, 0)), ("from the left", (1, 0)), ("from behind", (0, -1)), ("from the front", (0, 1))],
)
def test_a_push_moves_the_body_its_way(text: str, way: tuple[int, int]):
    """Who is pushed faces the radar: forwards is towards it, to smaller y."""
    pelvis = acted(f"is pushed {text}", 1, 2.5)[:, PELVIS, :2]
    assert (pelvis[-1] - pelvis[0]) @ np.array(way) > 0.15


@pytest.mark.parametrize("seed", range(2))
def test_a_limp_is_uneven(seed: int):
    """The sound foot stands longer than the lame one; the same person limping on either side is compared."""

    def longer_on_the_left(lame: str) -> float:
        feet_m = acted(f"limps on the {lame} leg", seed, 6.0)[240:-120, ANKLES, :2]
        step_m = np.linalg.norm(np.diff(feet_m, axis=0), axis=-1)
        left, right = (step_m * 120 < 0.25).mean(axis=0)
        return float(left - right)

    assert longer_on_the_left("right") - longer_on_the_left("left") > 0.1


def test_walking_lunges_go_ahead_and_down_with_every_step():
    joints = acted("does four walking lunges to the left")
    high = joints[:, PELVIS, 2]
    lowest = (high[1:-1] < high[:-2]) & (high[1:-1] <= high[2:]) & (high[1:-1] < high.max() - 0.15)
    assert 3 <= lowest.sum() <= 6
    assert np.linalg.norm(joints[:, ANKLES[0], :2] - joints[:, ANKLES[1], :2], axis=1).max() > 0.5
    assert np.linalg.norm(joints[-1, PELVIS, :2] - joints[0, PELVIS, :2]) > 1.5


def test_who_trips_and_falls_does_not_stand_up_in_between():
    def upright_s(text: str) -> float:
        """How long the trunk is within 4 degrees of upright from the last catching step to the fall."""
        motion = act_out(text, seed=1)
        trunk_m, time_s = motion.pose.joints_m[:, NECK] - motion.pose.joints_m[:, PELVIS], motion.pose.time_s
        lean_rad = np.arctan2(np.linalg.norm(trunk_m[:, :2], axis=1), trunk_m[:, 2])
        between = (time_s > 0.9) & (time_s < motion.plan.steps[0].end_s + 0.6)
        return float((lean_rad[between] < np.radians(4)).sum() / 120)

    assert upright_s("trips and falls") < 0.1 < 0.3 < upright_s("trips, then falls backwards")


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


def test_kneeling_stands_on_knees_and_toes():
    z = acted("kneels down", 0, 4.0)[-1, :, 2]
    knees = z[[joint("left_knee"), joint("right_knee")]]
    assert np.all((knees > 0.02) & (knees < 0.15))
    assert 0.45 < z[PELVIS] < 0.65
    assert z[HEAD] > 1.0


@pytest.mark.parametrize(("side", "other"), SIDES)
def test_one_knee_is_on_the_floor_where_one_is_named(side: str, other: str):
    z = acted(f"kneels down on the {side} knee", 0, 3.0)[-1, :, 2]
    assert z[joint(f"{side}_knee")] < 0.12
    assert z[joint(f"{other}_knee")] > 0.35
    assert z[joint(f"{other}_ankle")] < 0.2


@pytest.mark.parametrize("text", ["lies down, then gets up", "kneels down, then stands up", "falls, gets up"])
def test_what_goes_down_comes_up_to_where_it_was(text: str):
    head = acted(text, 0, 9.0)[:, HEAD, 2]
    assert abs(head[-1] - head[0]) < 0.03
    assert head.min() < 1.25


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


def test_push_ups_keep_the_body_straight_and_the_hands_on_the_floor():
    joints = acted("does three push-ups", 1)
    shoulder = joints[:, joint("left_shoulder"), 2]
    assert times(shoulder < shoulder.min() + 0.4 * np.ptp(shoulder)) == 3
    assert np.ptp(shoulder) > 0.15
    assert joints[:, WRISTS[0], 2].max() < 0.3
    assert bend_deg(joints, "neck", "pelvis", "left_ankle").max() < 25
    assert joints[..., 2].min() > -0.08


def test_crawling_goes_on_with_the_trunk_level_and_low():
    joints = acted("crawls to the left", 1)
    gone = joints[-1, PELVIS, :2] - joints[0, PELVIS, :2]
    assert gone[0] < -0.4
    assert joints[:, NECK, 2].max() < 0.9
    assert joints[:, joint("left_knee"), 2].max() < 0.25
    stride = (joints[:, ANKLES[0], :2] - joints[:, PELVIS, :2]) @ (gone / np.hypot(*gone))
    assert np.ptp(stride) > 0.15


def test_sit_ups_raise_the_trunk_as_often_as_said_and_leave_the_feet_where_they_are():
    joints = acted("does three sit-ups", 1)
    neck = joints[:, NECK, 2]
    assert times(neck > neck.min() + 0.6 * np.ptp(neck)) == 3
    assert neck.min() < 0.25
    assert neck.max() > 0.45
    assert np.ptp(joints[:, ANKLES[0]], axis=0).max() < 0.05
    assert np.ptp(joints[:, PELVIS], axis=0).max() < 0.1
    assert joints[..., 2].min() > -0.05


def test_feet_on_pedals_go_round_half_a_turn_apart_while_the_pelvis_stays():
    joints = acted("pedals on an exercise bike", 1)
    left, right = (joints[:, joint(f"{side}_foot"), 2] for side in ("left", "right"))
    assert np.corrcoef(left, right)[0, 1] < -0.9
    assert 0.25 < np.ptp(left) < 0.45
    assert min(left.min(), right.min()) > 0.05
    assert np.ptp(joints[:, PELVIS], axis=0).max() < 0.06
    assert np.linalg.norm(joints[:, joint("left_hip")] - joints[:, ANKLES[0]], axis=-1).max() < 0.485 * 1.75


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


def test_a_fall_off_a_chair_ends_on_the_floor_on_the_side_that_is_named():
    z = acted("falls off the chair to the left", 1)[..., 2]
    assert z[0, PELVIS] > 0.45
    assert z[-1, PELVIS] < 0.25
    assert z[-1, joint("left_shoulder")] < z[-1, joint("right_shoulder")] - 0.2
