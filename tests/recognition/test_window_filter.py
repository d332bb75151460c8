"""Multipath, neighbours and fans are left out; a body with wide arms, who walks alone, and what is at rest stay."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.recognition.background_mask import background_cells
from mmweaver.recognition.guard_report import removed_lines, removed_points, write_pictures
from mmweaver.recognition.guards import GUARDS, WindowFilter, guard_names
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


MULTIPATH = WindowFilter(radar=RADAR, off=frozenset(GUARDS) - {"multipath"})


def test_an_echo_behind_the_person_is_left_out():
    found = MULTIPATH(recording((0.0, 2.0, 0.5, 4), (1.2, 2.8, 0.5, 2))).cloud
    assert len(found.frame) == 4 * FRAMES
    assert found.x_m.max() < 0.5


def test_a_runner_is_not_an_echo_of_where_they_were():
    frame = np.repeat(np.arange(FRAMES), 4)
    one = recording_of(frame, y_m=1.0 + 0.3 * frame, velocity_mps=3.0)
    assert MULTIPATH(one) is one


def test_something_farther_counts_while_the_person_is_away():
    both = recording((0.0, 2.0, 0.5, 3), (1.5, 4.0, 0.5, 2))
    away = PointRecording(**vars(both) | {"cloud": both.cloud.select((both.cloud.y_m > 3) | (both.cloud.frame < 10))})
    found = MULTIPATH(away).cloud
    assert set(found.frame[found.y_m > 3.0]) == set(range(11, FRAMES))


def disturbed() -> tuple[PointRecording, WindowFilter]:
    """A person with a flank, multipath, a fan and damaged velocities, one point each per frame, and all guards."""
    person, flank, echo, fan = (0.0, 2.0, 0.36), (0.0, 2.0, 0.48), (1.5, 3.5, 0.36), (-2.0, 1.0, 0.6)
    snr_db = np.repeat([20.0, 10.0, 20.0, 10.0, 30.0], FRAMES)
    window = in_all_frames([person, flank, echo, fan, (0.0, 2.0, 11_666.0)], FRAMES, snr_db=snr_db)
    cells = background_cells([in_all_frames([fan], FRAMES)])
    return window, WindowFilter(background=cells, radar=RADAR)


def test_of_a_person_with_all_disturbances_one_point_per_frame_stays():
    window, points = disturbed()
    assert len(points(window).cloud.frame) == FRAMES
    assert {name: mask.sum() for name, mask in points.removed(window).items()} == dict.fromkeys(
        ("impossible", "background", "neighbours", "multipath"), FRAMES
    )
    assert len(WindowFilter(background=points.background)(window).cloud.frame) == 3 * FRAMES


@pytest.mark.parametrize("name", ["impossible", "background", "neighbours", "multipath"])
def test_each_guard_can_be_switched_off(name: str):
    window, points = disturbed()
    assert name not in points.without(frozenset([name])).removed(window)
    assert points.without(guard_names("all"))(window) is window


def test_unknown_guards_are_refused():
    with pytest.raises(InputError, match="multipaths"):
        guard_names("neighbours, multipaths")


def test_what_was_removed_is_reported_and_drawn_for_each_recording(tmp_path: Path):
    window, points = disturbed()
    clean = recording((0.0, 2.0, 0.5, 1))
    row, other = removed_points(points, [window, clean])
    assert (row["points"], row["moving_removed"], row["removed"]["multipath"]) == (5 * FRAMES, 4 * FRAMES, FRAMES)
    assert other["removed"] == {}
    assert any("more than half" in line and "of 1 recordings" in line for line in removed_lines([row, other]))
    (file,) = write_pictures(tmp_path, points, [window, clean])
    assert file.read_bytes()[:4] == b"\x89PNG"
