"""What moves persistently and is nobody is left out; people, what they pass through, and what is at rest stay."""

import numpy as np
import pytest

from mmweaver.recognition.background_mask import (
    NO_CELLS,
    background_cells,
    persistent_motion_cells,
    remove_motion,
)
from mmweaver.recognition.point_recordings import PointRecording
from tests.recognition.clouds import in_all_frames, recording_of

FRAMES = 100
FAN, BOX, SOMEBODY = (-1.1, 3.1, 0.5), (-1.1, 3.1, 0.0), (0.6, 2.0, -0.5)
Way = tuple[float | np.ndarray, float | np.ndarray]


def moving(*ways: Way) -> PointRecording:
    """Movers right and ahead of the radar, (frame,) each."""
    x, y = (np.stack([np.broadcast_to(way[axis], FRAMES) for way in ways]).ravel() for axis in (0, 1))
    return recording_of(np.tile(np.arange(FRAMES), len(ways)), x_m=x, y_m=y, velocity_mps=0.5)


def walker(number: int) -> Way:
    return 0.6 + 0.05 * number, 1 + np.linspace(0, 2.5, FRAMES)


def test_a_fan_of_the_empty_place_is_left_out_and_nothing_else():
    cells = background_cells([in_all_frames([FAN, BOX], FRAMES)])
    cloud = remove_motion(in_all_frames([FAN, BOX, SOMEBODY], FRAMES), cells).cloud
    assert sorted(set(cloud.radial_velocity_mps)) == [SOMEBODY[2], BOX[2]]
    assert len(cloud.frame) == 2 * FRAMES
    beside, far = (-1.3, 3.3, 1.0), (-1.9, 3.3, 1.0)
    assert set(remove_motion(in_all_frames([beside, far], FRAMES), cells).cloud.x_m) == {far[0]}


def test_whoever_walks_through_the_empty_place_masks_nothing():
    walked = recording_of(np.arange(FRAMES), y_m=1 + 0.15 * np.arange(FRAMES), velocity_mps=1.5)
    assert background_cells([walked]).shape == background_cells([]).shape == (0, 2)
    assert remove_motion(walked, NO_CELLS) is walked


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
