"""A recorded walk in a room: feet on its floor, start and heading as asked, nothing through furniture."""

import math

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_placement import facing_of, floor_under, place_clip
from mmweaver.motion.planning.floor_map import FloorMap
from rooms import FLOOR_Z_M, WINDOW_M, furnished, room

SECONDS = 1.9


def clip(lifted_m: float = 0.0) -> MotionClip:
    """A walk that was recorded far away, on a floor of another height."""
    return MotionClip(joints_m=walk(60.0, 2.0) + np.array([40.0, -7.0, lifted_m]), fps=60.0, label="walk")


def placed(scene: Scene, recorded: MotionClip | None = None, seed: int = 0, **options) -> np.ndarray:
    motion = place_clip(recorded or clip(), scene, duration_s=SECONDS, seed=seed, range_window_m=WINDOW_M, **options)
    time_s, joints_m = motion.pose.time_s, motion.pose.joints_m
    return joints_m[(time_s >= -1e-9) & (time_s <= SECONDS + 1e-9)]


@pytest.mark.parametrize("lifted_m", [0.63, -2.0])
def test_feet_are_on_the_floor_of_the_room(lifted_m: float):
    joints = placed(room(), clip(lifted_m))
    lowest = joints[..., 2].min(axis=1) - FLOOR_Z_M
    assert lowest.min() > -0.01
    assert lowest.max() < 0.06


def test_the_floor_of_a_jump_is_where_it_stood():
    jump = walk(60.0, 2.0, "a person jumps")
    assert floor_under(jump, 1.75) == pytest.approx(0.0, abs=0.02)


def test_start_and_heading_are_as_asked():
    for heading_deg in (-90.0, 20.0, 180.0):
        joints = placed(room(), start_m=(0.3, 2.2), heading_rad=math.radians(heading_deg), recorded=still())
        np.testing.assert_allclose(joints[0, 0, :2], [0.3, 2.2], atol=1e-3)
        gap = facing_of(joints[0]) - math.radians(heading_deg)
        assert abs(math.remainder(gap, 2 * math.pi)) < 0.02


def still() -> MotionClip:
    return MotionClip(joints_m=walk(60.0, 2.0, "a person waves"), fps=60.0, label="wave")


def test_who_stays_in_place_faces_the_radar():
    for seed in range(2):
        joints = placed(room(), still(), seed)
        to_radar = math.atan2(-joints[0, 0, 1], -joints[0, 0, 0])
        assert abs(math.remainder(facing_of(joints[0]) - to_radar, 2 * math.pi)) < 0.6


def test_nothing_goes_through_furniture_and_the_motion_is_only_turned_and_moved():
    scene = furnished()
    floor = FloorMap(scene, WINDOW_M, 1.75)
    starts = []
    for seed in range(6):
        joints = placed(scene, seed=seed)
        assert floor.clearance_at(joints[:, 0, :2]).min() > 0.2
        assert bool(floor.sees(joints[:, 0, :2]).all())
        recorded = walk(60.0, 2.0)
        gone = np.linalg.norm(recorded[round(SECONDS * 60), 0] - recorded[0, 0])
        assert np.linalg.norm(joints[-1, 0] - joints[0, 0]) == pytest.approx(gone, abs=0.01)
        starts.append(tuple(joints[0, 0, :2]))
    assert len(set(starts)) > 2
    np.testing.assert_array_equal(placed(scene, seed=3), placed(scene, seed=3))


def test_no_room_is_said_with_what_there_is():
    far = MotionClip(joints_m=walk(60.0, 2.0) * np.array([4.0, 4.0, 1.0]), fps=60.0, label="leaps")
    with pytest.raises(InputError, match=r"leaps: .*\d\.\d m across, \d+\.\d m2 .*--as-recorded"):
        placed(room(), far)
    with pytest.raises(InputError, match=r"0\.3,9 is outside .* nearest"):
        placed(room(), start_m=(0.3, 9.0))
    with pytest.raises(InputError, match=r"0,1\.2 .* heading"):
        placed(room(), start_m=(0.0, 1.2), heading_rad=-math.pi / 2)
    with pytest.raises(InputError, match="no free floor"):
        placed(room(boxes=((-9.0, 9.0, 0.0, 9.0),)))


def test_as_recorded_moves_nothing():
    recorded = MotionClip(
        joints_m=walk(60.0, 2.0) + np.array([0.0, 2.0, -1.1]), fps=60.0, label="walk", has_jitter=False
    )
    motion = place_clip(recorded, room(), duration_s=1.0, seed=0, range_window_m=WINDOW_M, as_recorded=True)
    k = int(np.argmin(np.abs(motion.pose.time_s)))
    np.testing.assert_allclose(motion.pose.joints_m[k], recorded.joints_m[0], atol=1e-9)
    assert "used unchanged" in motion.assumptions[-1]
