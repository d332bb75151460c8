"""A sentence in a Scene: the right way, the right hands, nothing through furniture, floor and limits kept."""

from itertools import pairwise

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.core.skeleton import joint
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.planning.floor_map import FloorMap
from rooms import FLOOR_Z_M, WINDOW_M, furnished, room, sofa_room


def motion(text: str, scene: Scene | None = None, seed: int = 0, duration_s: float = 2.0, **more) -> Motion:
    return compose(plan_motion(text, duration_s), scene or room(), seed=seed, range_window_m=WINDOW_M, **more)


def speeds(made: Motion) -> np.ndarray:
    pose = made.pose
    return np.linalg.norm(np.gradient(pose.joints_m, pose.time_s, axis=0), axis=-1)


def test_the_same_seed_gives_the_same_bits_and_another_seed_another_motion():
    for text, duration_s in (("sits and drinks", 2.0), ("walks to the left, then sits down", 5.0)):
        one, same, other = (motion(text, seed=seed, duration_s=duration_s).pose for seed in (3, 3, 4))
        assert np.array_equal(one.joints_m, same.joints_m)
        assert not np.allclose(one.joints_m, other.joints_m)
        assert one.height_m == same.height_m != other.height_m


def test_heights():
    made = motion("stands", height_m=1.7)
    head = made.pose.joints_m[:, joint("head"), 2] - FLOOR_Z_M
    assert made.pose.height_m == 1.7
    assert np.all((head > 0.87 * 1.7) & (head < 0.93 * 1.7)), "the head joint is at the base of the skull"
    with pytest.raises(InputError, match="height"):
        motion("stands", height_m=3.0)


@pytest.mark.parametrize("seed", range(2))
def test_directions_are_the_viewers(seed: int):
    def way(text: str) -> tuple[np.ndarray, np.ndarray]:
        pelvis = motion(text, seed=seed).pose.joints_m[:, 0]
        return pelvis[0], pelvis[-1]

    start, end = way("walks to the left")
    assert end[0] - start[0] < -0.9
    assert abs(end[1] - start[1]) < 0.35
    start, end = way("walks to the right")
    assert end[0] - start[0] > 0.9
    start, end = way("walks towards the radar")
    assert np.hypot(*start[:2]) - np.hypot(*end[:2]) > 0.9
    start, end = way("walks away from the camera")
    assert np.hypot(*end[:2]) - np.hypot(*start[:2]) > 0.7


@pytest.mark.parametrize("side", ["left", "right"])
def test_the_hand_that_is_named_acts(side: str):
    other = "right" if side == "left" else "left"
    for text in (f"waves with the {side} hand", f"raises the {side} hand"):
        made = motion(text, seed=2)
        reach = made.pose.joints_m[:, joint(f"{side}_wrist"), 2].max() - made.pose.joints_m[:, joint("head"), 2].mean()
        idle = (
            made.pose.joints_m[:, joint(f"{other}_wrist"), 2].max() - made.pose.joints_m[:, joint("pelvis"), 2].mean()
        )
        assert reach > -0.15
        assert idle < 0.1
    strikes = np.ptp(motion(f"punches with the {side} hand").pose.joints_m, axis=0)
    assert np.linalg.norm(strikes[joint(f"{side}_wrist")]) > 1.5 * np.linalg.norm(strikes[joint(f"{other}_wrist")])


def planted(joints: np.ndarray, foot: str, toe: str) -> list[np.ndarray]:
    """Runs of frames in which the sole is flat on the floor: places of the ankle."""
    ankle, ball = joints[:, joint(foot)], joints[:, joint(toe)]
    flat = (ball[:, 2] - FLOOR_Z_M < 0.024) & (np.abs(ankle[:, 2] - ball[:, 2] - 0.034 * 1.75) < 0.012)
    runs = np.split(np.arange(len(flat)), np.flatnonzero(np.diff(flat.astype(int))) + 1)
    return [ball[run] for run in runs if flat[run[0]] and len(run) > 8]


@pytest.mark.parametrize("seed", range(2))
def test_feet_do_not_slide(seed: int):
    for text in ("walks", "walks quickly to the left", "walks, then claps", "walks in a circle", "turns around"):
        joints = motion(text, seed=seed, duration_s=3.0, height_m=1.75).pose.joints_m
        runs = planted(joints, "left_ankle", "left_foot") + planted(joints, "right_ankle", "right_foot")
        assert len(runs) >= 2
        for run in runs:
            assert np.linalg.norm(np.ptp(run[:, :2], axis=0)) < 0.03


@pytest.mark.parametrize("num_seeds", [10, pytest.param(100, marks=pytest.mark.slow)])
def test_collision_free_over_many_seeds(num_seeds: int):
    """A body never overlaps a box, whatever the seed; nor leaves the radar's window."""
    scene = furnished()
    texts = (
        "walks",
        "walks to the left",
        "walks towards the radar, then waves",
        "jumping jacks",
        "walks, then sits down",
    )
    for seed in range(num_seeds):
        made = motion(texts[seed % len(texts)], scene, seed=seed, duration_s=2.5)
        floor = FloorMap(scene, WINDOW_M, made.pose.height_m)
        standing = [step for step in made.plan.steps if step.lower != "sit_down"]
        end = standing[-1].end_s
        pelvis = made.pose.joints_m[made.pose.time_s <= end, 0]
        assert floor.clearance_at(pelvis[:, :2]).min() > 0.2
        slant = np.linalg.norm(made.pose.joints_m, axis=-1)
        inside = (slant > WINDOW_M[0]) & (slant < WINDOW_M[1] + 0.15)
        assert inside.mean() > 0.95
        assert np.degrees(np.abs(np.arctan2(pelvis[:, 0], pelvis[:, 1]))).max() < 42


def test_sitting_on_the_seat_of_the_scene():
    for text in ("user seated on couch drinking water", "walks to the sofa and sits down"):
        made = motion(text, sofa_room(), seed=1, duration_s=3.0)
        pelvis = made.pose.joints_m[-1, 0]
        assert np.hypot(pelvis[0] - 0.0, pelvis[1] - 2.6) < 0.12
        assert 0.05 < pelvis[2] - (FLOOR_Z_M + 0.45) < 0.2
        knees = made.pose.joints_m[-1, [4, 5], 1]
        assert np.all(knees < pelvis[1] - 0.25), "the sitter looks at the radar, as the sofa does"
        feet = made.pose.joints_m[-1, [10, 11], 2] - FLOOR_Z_M
        assert np.all(feet < 0.04)
        assert not any("stool" in sentence for sentence in made.assumptions)


def test_without_a_seat_a_stool_is_assumed_and_said():
    for text in ("sits", "walks to the left, then sits down"):
        made = motion(text, seed=1, duration_s=3.0)
        assert any("stool 0.45 m" in sentence for sentence in made.assumptions)
        assert abs(made.pose.joints_m[-1, 0, 2] - FLOOR_Z_M - 0.45) < 0.2


def test_a_start_that_is_asked_for_is_kept_or_refused():
    for text in ("walks", "waves", "walks to the left, then claps"):
        made = motion(text, start_m=(0.4, 2.0))
        index = int(np.argmin(np.abs(made.pose.time_s)))
        assert np.hypot(*(made.pose.joints_m[index, 0, :2] - [0.4, 2.0])) < 0.06
    with pytest.raises(InputError, match=r"not free.*nearest"):
        motion("waves", furnished(), start_m=(1.2, 1.8))
    with pytest.raises(InputError, match=r"outside .*nearest"):
        motion("waves", start_m=(0.0, 9.0))


def test_no_room_is_an_error_that_says_so():
    full = room(boxes=((-3.0, 3.0, 0.0, 6.0),))
    with pytest.raises(InputError, match="no room"):
        motion("waves", full)
    cell = room(boxes=((-3.0, -0.4, 0.0, 6.0), (0.4, 3.0, 0.0, 6.0), (-3.0, 3.0, 0.0, 1.6), (-3.0, 3.0, 2.4, 6.0)))
    assert motion("waves", cell).pose.joints_m.shape[1:] == (22, 3)
    assert any("no room" in note for note in motion("lies on the floor", cell).assumptions)


def test_a_walk_longer_than_the_room_ends_early_and_says_so_or_goes_to_and_fro():
    made = motion("walks to the left", duration_s=8.0)
    assert any("stands still" in sentence for sentence in made.assumptions)
    still = made.pose.time_s > 7.0
    assert speeds(made)[still].max() < 0.15, "standing, not stepping on the spot"
    pelvis = motion("walks", duration_s=12.0).pose.joints_m[:, 0, :2]
    assert np.linalg.norm(np.diff(pelvis, axis=0), axis=1).sum() > 7.0


def test_steps_share_the_time_and_too_many_are_an_error():
    made = motion("claps, then waves, then jumps", duration_s=6.0)
    assert made.plan.steps[0].start_s == 0.0
    assert made.plan.steps[-1].end_s == pytest.approx(6.0)
    assert all(a.end_s == b.start_s for a, b in pairwise(made.plan.steps))
    cut = motion("claps, waves, jumps, squats, punches, turns around, sits down, stands up", duration_s=2.0)
    assert [clause.status for clause in cut.clauses][:2] == ["done", "done"]
    assert cut.clauses[-1].status == "not done"
    for bad in (0.0, -1.0, float("nan"), 1e6):
        with pytest.raises(InputError, match="duration"):
            motion("walks", duration_s=bad)


def test_jogging_without_a_direction_is_on_the_spot_and_said():
    made = motion("jogs")
    assert any("on the spot" in sentence for sentence in made.assumptions)
    assert np.ptp(made.pose.joints_m[:, 0, :2], axis=0).max() < 0.15
    assert np.hypot(*np.ptp(motion("jogs to the left").pose.joints_m[:, 0, :2], axis=0)) > 1.5


@pytest.mark.parametrize(
    ("text", "seed", "least_mps"), [("runs", 0, 2.6), ("runs to the left", 3, 2.6), ("jogs to and fro", 2, 2.0)]
)
def test_running_is_no_slow_jog_where_the_way_is_short(text: str, seed: int, least_mps: float):
    scene = room(width_m=8.0, depth_m=7.0)
    made = compose(plan_motion(text, 2.0), scene, seed=seed, range_window_m=(0.8, 7.0))
    flat = made.pose.joints_m[:, 0, :2]
    over_100_ms = np.linalg.norm(flat[12:] - flat[:-12], axis=1) / 0.1
    assert over_100_ms.max() > least_mps
    if over_100_ms[-36:].max() < 0.3:
        assert any("stands still" in note for note in made.assumptions)


def test_body_proportions():
    for height in (1.63, 1.96):
        body = SkeletonProportions(height)
        assert body.leg_m / height == pytest.approx(0.474, abs=0.01)
        assert body.pelvis_height_m(1.0) / height == pytest.approx(0.565, abs=0.01)
