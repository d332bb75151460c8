"""The classifier of boards left out, on made units."""

import numpy as np

from mmweaver.evaluation.compare_signals import FEATURES
from studies.physics.board_left_out import (
    accuracy,
    alone,
    chances,
    ranking,
    verdicts,
    walkers,
)
from tests.rooms import back_wall, floor, scene_of

BOARDS = ("one", "two", "three")


def units(offset: float, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    return {name: rng.normal(offset, 1.0, (12, len(FEATURES))) for name in BOARDS}


def test_what_differs_is_found_and_what_is_alike_is_not():
    of_apart, of_alike = (chances(units(0.0, 0), units(offset, 1), "two") for offset in (5.0, 0.0))
    apart, alike = accuracy(verdicts(*of_apart)), accuracy(verdicts(*of_alike))
    assert ranking(*of_apart)["value"] > 0.99
    assert 0.2 < ranking(*of_alike)["value"] < 0.8
    assert apart["value"] > 0.95
    assert alike["value"] < 0.8
    low, high = alike["interval_95"]
    assert low <= alike["value"] <= high


def test_each_feature_ranks_alone_where_both_show_it():
    recorded, made = (units(0.0, seed)["one"] for seed in (0, 1))
    names = [feature.name for feature in FEATURES]
    recorded[:, names.index("points_width")] += 9.0
    made[:, names.index("drift")] = np.nan
    found = alone(recorded, made)
    assert found["by_points_width"]["value"] == 1.0
    assert 0.2 < found["by_points_depth"]["value"] < 0.8
    assert "by_drift" not in found


def test_two_people_walk_through_the_recorded_places():
    scene = scene_of((floor(), back_wall(5.2)))
    for pose, degrees in zip(walkers(scene, 0), (-15.0, 8.0), strict=True):
        at = np.array([np.interp(0.0, pose.time_s, pose.joints_m[:, 0, axis]) for axis in range(2)])
        assert abs(np.linalg.norm(at) - 2.93) < 0.05
        assert abs(np.degrees(np.arctan2(at[0], at[1])) - degrees) < 1.0
        assert abs(float(pose.joints_m[..., 2].min()) - scene.floor_z_m) < 1e-5


def test_nobody_walks_behind_a_wall():
    for pose in walkers(scene_of((floor(), back_wall(2.5))), 0):
        at = [np.interp(0.0, pose.time_s, pose.joints_m[:, 0, axis]) for axis in range(2)]
        assert 1.9 < at[1] < 2.1


def test_other_moments_of_the_walk_are_other_poses_at_the_same_places():
    scene = scene_of((floor(), back_wall(5.2)))
    first, other = (walkers(scene, 0, moment_s)[0] for moment_s in (0.0, 0.2))
    now = [
        np.stack([np.interp(0.0, one.time_s, one.joints_m[:, joint, 1]) for joint in range(22)])
        for one in (first, other)
    ]
    assert abs(now[0][0] - now[1][0]) < 0.02
    assert np.abs(now[0] - now[1]).max() > 0.1
