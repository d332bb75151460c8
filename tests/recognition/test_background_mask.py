"""What moves persistently and is nobody is left out; people, what they pass through, and what is at rest stay."""

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.recognition.background_mask import (
    CELL_M,
    NO_CELLS,
    background_cells,
    moves_inside,
    persistent_motion_cells,
)
from mmweaver.recognition.point_recordings import PointRecording
from tests.recognition.clouds import in_all_frames, recording_of, with_others

FRAMES = 100
FAN, BOX, SOMEBODY = (-1.1, 3.1, 0.5), (-1.1, 3.1, 0.0), (0.6, 2.0, -0.5)
Way = tuple[float | np.ndarray, float | np.ndarray]


def left(window: PointRecording, cells: np.ndarray) -> PointCloud:
    return window.cloud.select(~moves_inside(window, cells))


def moving(*ways: Way) -> PointRecording:
    """Movers right and ahead of the radar, (frame,) each: their velocities are those of their ranges, or 0.5 m/s."""
    x, y = (np.stack([np.broadcast_to(way[axis], FRAMES) for way in ways]) for axis in (0, 1))
    velocity = 10.0 * np.gradient(np.hypot(x, y), axis=1)
    velocity = np.where(np.ptp(velocity, axis=1, keepdims=True) < 1e-9, 0.5, velocity)
    frame = np.tile(np.arange(FRAMES), len(ways))
    return recording_of(frame, x_m=x.ravel(), y_m=y.ravel(), velocity_mps=velocity.ravel())


def walker(number: int) -> Way:
    """Somebody who walks to and fro between 1 and 3.5 m."""
    return 0.6 + 0.05 * number, 1 + 2.5 * np.abs(1 - np.arange(FRAMES) / 25 % 2)


def test_what_moves_on_while_people_walk_elsewhere_is_not_the_subject():
    fan = persistent_motion_cells([moving(FAN[:2], walker(number)) for number in range(12)])
    assert any(np.array_equal(cell, np.floor(np.array(FAN[:2]) / CELL_M)) for cell in fan)


def test_whoever_gestures_in_one_place_stays_with_multipath_and_noise_elsewhere():
    rng = np.random.default_rng(0)
    recordings = []
    for _ in range(12):
        # a hand to and fro; behind it multipath that moves as the hand does; noise anywhere at any velocity
        swing = 0.4 * np.sin(np.arange(FRAMES) * 0.6)
        person, ghost = (0.1, 2.4 + 0.2 * swing), (0.9, 4.6 + swing)
        noise = rng.uniform([-2, 0.5, -1], [2, 7, 1], (2 * FRAMES, 3))
        one = moving(person, ghost).cloud
        cloud = recording_of(np.arange(2 * FRAMES) // 2, x_m=noise[:, 0], y_m=noise[:, 1], velocity_mps=noise[:, 2])
        recordings.append(with_others(cloud, one))
    assert len(persistent_motion_cells(recordings)) == 0


def test_a_fan_of_the_empty_place_is_left_out_and_nothing_else():
    cells = background_cells([in_all_frames([FAN, BOX], FRAMES)])
    cloud = left(in_all_frames([FAN, BOX, SOMEBODY], FRAMES), cells)
    assert sorted(set(cloud.radial_velocity_mps)) == [SOMEBODY[2], BOX[2]]
    assert len(cloud.frame) == 2 * FRAMES
    beside, far = (-1.3, 3.3, 1.0), (-1.9, 3.3, 1.0)
    assert set(left(in_all_frames([beside, far], FRAMES), cells).x_m) == {far[0]}


def test_whoever_walks_through_the_empty_place_masks_nothing():
    walked = recording_of(np.arange(FRAMES), y_m=1 + 0.15 * np.arange(FRAMES), velocity_mps=1.5)
    assert background_cells([walked]).shape == background_cells([]).shape == (0, 2)
    assert not moves_inside(walked, NO_CELLS).any()


@pytest.mark.parametrize(
    "recordings",
    [
        [moving((0.1, 2.1), (0.3, 4.1))] * 12,  # an echo moves along
        [moving((0.1, 2.1), walker(0)), *[moving((0.1, 2.1))] * 11],  # somebody passes once
        [moving((0.1, np.maximum(4.0 - 0.04 * np.arange(FRAMES), 2.1)))] * 12,  # walks there first
        [moving(walker(0)), *[moving(FAN[:2])] * 11],  # stops while somebody walks: may be that person
    ],
)
def test_whoever_exercises_in_one_place_is_somebody(recordings: list[PointRecording]):
    assert len(persistent_motion_cells(recordings)) == 0
