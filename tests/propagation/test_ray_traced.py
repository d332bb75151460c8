"""The simulator's own limits: a motion must last as long as the frames that are asked for."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.receiver import IDEAL
from tests.rooms import back_wall, floor, scene_of, side_wall, standing_person

NUM_FRAMES = 3
LAST_S = (NUM_FRAMES - 1) * AWR1843.frame_period_s


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    return Simulator(scene_of((floor(),)), AWR1843, IDEAL)


def _moving(begin_s: float, end_s: float):
    pose = standing_person((0.0, 2.0, -1.2), seconds=1.0)
    return replace(pose, time_s=np.linspace(begin_s, end_s, len(pose.time_s)))


@pytest.mark.parametrize(("begin_s", "end_s"), [(0.0, LAST_S - 0.03), (0.05, LAST_S), (-3.0, -2.0)])
def test_a_motion_that_does_not_cover_the_frames_is_refused(simulator: Simulator, begin_s: float, end_s: float):
    pose = _moving(begin_s, end_s)
    for refused in (simulator.run, simulator.trace):
        with pytest.raises(InputError, match=f"covers {begin_s:.2f} to {end_s:.2f} s.* need 0 to {LAST_S:.2f} s"):
            refused(pose, num_frames=NUM_FRAMES, seed=0)


@pytest.mark.parametrize("part", [1, 4])
def test_frames_are_the_same_bits_in_parts(part: int):
    """Of somebody who walks through the paths of wall and cupboard, each of which is occluded in some frames alone."""
    room = scene_of((floor(), back_wall(), side_wall(1.5, "metal")))
    simulator = Simulator(room, AWR1843)
    pose = standing_person((-0.7, 1.6, -1.2), (1.4, 0.0, 0.0))
    whole = simulator.run(pose, num_frames=12, seed=2).adc.samples
    parts = [
        simulator.run(pose, num_frames=part, first_frame=first, seed=2).adc.samples for first in range(0, 12, part)
    ]
    np.testing.assert_array_equal(np.concatenate(parts), whole)


def test_joints_that_are_no_numbers_are_refused(simulator: Simulator):
    pose = _moving(0.0, LAST_S)
    joints_m = pose.joints_m.copy()
    joints_m[3, 5, 1] = np.nan
    with pytest.raises(InputError, match="not numbers"):
        simulator.trace(replace(pose, joints_m=joints_m), num_frames=NUM_FRAMES, seed=0)
