"""Multipath, neighbours and fans are left out; a body with wide arms, who walks alone, and what is at rest stay."""

import numpy as np

from mmweaver.recognition.background_mask import WindowFilter, background_cells, remove_multipath
from mmweaver.recognition.point_recordings import PointRecording
from tests.recognition.clouds import RADAR, in_all_frames, recording_of

FRAMES = 20
Group = tuple[float, float, float, int]  # right, ahead, velocity, points per frame within 0.2 m


def recording(*groups: Group) -> PointRecording:
    rows = np.repeat(np.array([group[:3] for group in groups]), [group[3] for group in groups], axis=0)
    rows = np.repeat(rows, FRAMES, axis=0)
    noise = np.random.default_rng(0).uniform(-0.1, 0.1, (2, len(rows)))
    frame = np.tile(np.arange(FRAMES), len(rows) // FRAMES)
    return recording_of(frame, x_m=rows[:, 0] + noise[0], y_m=rows[:, 1] + noise[1], velocity_mps=rows[:, 2])


def test_an_echo_behind_the_person_is_left_out():
    found = remove_multipath(recording((0.0, 2.0, 0.5, 4), (1.2, 2.8, 0.5, 2))).cloud
    assert len(found.frame) == 4 * FRAMES
    assert found.x_m.max() < 0.5


def test_a_runner_is_not_an_echo_of_where_they_were():
    frame = np.repeat(np.arange(FRAMES), 4)
    one = recording_of(frame, y_m=1.0 + 0.3 * frame, velocity_mps=3.0)
    assert remove_multipath(one) is one


def test_something_farther_counts_while_the_person_is_away():
    both = recording((0.0, 2.0, 0.5, 3), (1.5, 4.0, 0.5, 2))
    away = PointRecording(**vars(both) | {"cloud": both.cloud.select((both.cloud.y_m > 3) | (both.cloud.frame < 10))})
    found = remove_multipath(away).cloud
    assert set(found.frame[found.y_m > 3.0]) == set(range(11, FRAMES))


def test_of_a_person_with_all_disturbances_one_point_per_frame_stays():
    person, flank, echo, fan = (0.0, 2.0, 0.36), (0.0, 2.0, 0.48), (1.5, 3.5, 0.36), (-2.0, 1.0, 0.6)
    snr_db = np.repeat([20.0, 10.0, 20.0, 10.0], FRAMES)
    window = in_all_frames([person, flank, echo, fan], FRAMES, snr_db=snr_db)
    busy = background_cells([in_all_frames([fan], FRAMES)])
    for points, left in ((WindowFilter(busy=busy, radar=RADAR), 1), (WindowFilter(busy=busy), 3), (WindowFilter(), 4)):
        assert len(points(window).cloud.frame) == left * FRAMES
