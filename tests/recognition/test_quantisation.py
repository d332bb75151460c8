"""Firmware that groups and firmware that does not give about the same points once neighbours are grouped here."""

from dataclasses import replace

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.quantisation import Quantisation, group_neighbours
from tests.recognition.clouds import RADAR, recording_of

STEP_M, STEP_MPS = RADAR.range_step_m, RADAR.velocity_step_mps


def window(cells: list[tuple[int, int, int, float]]) -> PointRecording:
    """Points of (frame, range bin, velocity bin, SNR), straight ahead."""
    frame, row, column, snr_db = np.array(cells).T
    return recording_of(frame, y_m=row * STEP_M, velocity_mps=column * STEP_MPS, snr_db=snr_db, num_frames=3)


def cells_of(recording: PointRecording) -> list[tuple[int, int, int]]:
    cloud = recording.cloud
    row, column = np.round(cloud.y_m / STEP_M), np.round(cloud.radial_velocity_mps / STEP_MPS)
    return [(int(a), int(b), int(c)) for a, b, c in zip(cloud.frame, row, column, strict=True)]


def block(frame: int, row: int, column: int, snr_db: float) -> list[tuple[int, int, int, float]]:
    """An echo that was not grouped: three velocities of equal ratio, three ranges of which the middle is strongest."""
    return [(frame, row + one, column + other, snr_db - 6.0 * abs(one)) for one in (-1, 0, 1) for other in (-1, 0, 1)]


def test_of_each_echo_its_middle_stays():
    found = group_neighbours(window([*block(0, 40, 0, 30.0), *block(0, 60, 3, 20.0), *block(2, 41, 0, 30.0)]), RADAR)
    assert cells_of(found) == [(0, 40, 0), (0, 60, 3), (2, 41, 0)]


def test_without_strengths_the_middle_is_that_of_the_occupied_cells():
    found = group_neighbours(window([*block(0, 40, 0, np.nan), *block(1, 60, 3, np.nan)]), RADAR)
    assert cells_of(found) == [(0, 40, 0), (1, 60, 3)]


def test_what_is_grouped_already_keeps_every_point_in_order():
    one = window([(0, 60, 3, 20.0), (0, 40, 0, 30.0), (0, 60, 3, 20.0), (1, 41, 1, 9.0), (1, 41, 3, 9.0)])
    assert group_neighbours(one, RADAR) is one  # two directions of one cell are two objects


def test_velocities_are_cyclic():
    found = group_neighbours(window([(0, 40, 7, 20.0), (0, 40, -8, 20.0), (0, 40, 6, 20.0)]), RADAR)
    assert cells_of(found) == [(0, 40, 7)]


def test_only_the_directions_that_the_firmware_groups():
    both = window(block(0, 40, 3, 30.0))
    range_alone = replace(RADAR, groups_velocity=False)
    neither = replace(range_alone, groups_range=False)
    assert cells_of(group_neighbours(both, range_alone)) == [(0, 40, 2), (0, 40, 3), (0, 40, 4)]
    assert group_neighbours(both, neither) is both


def test_values_of_meta_files_are_checked_and_older_models_have_none():
    assert Quantisation.read(vars(RADAR)) == RADAR
    for values in (None, {"velocity_step_mps": 0.1}, vars(RADAR) | {"velocity_step_mps": 0.0}, [1]):
        assert Quantisation.read(values) is None
