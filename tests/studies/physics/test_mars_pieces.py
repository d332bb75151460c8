"""Pieces of MARS: where they begin and end, their motion, and the box that the published clouds end in."""

from pathlib import Path

import numpy as np
import pytest

from studies.physics.mars_data import as_published, body_height_m, cloud_of, cut, pose_of, read_mars
from tests.rooms import STANDING_M
from tests.studies.physics.test_mars_data import write_split


def test_a_stretch_is_a_motion_of_somebody_as_tall(tmp_path: Path):
    write_split(tmp_path, "test", [5, 6, 7, 9])
    (stretch,) = read_mars(tmp_path, "test")
    pose = pose_of(stretch, (0.1, 0.2, 0.3), 1.7)
    assert pose.time_s == pytest.approx([0, 0.1, 0.2, 0.4])
    assert pose.joints_m - stretch.joints_m == pytest.approx(np.broadcast_to((0.1, 0.2, 0.3), (4, 22, 3)))
    assert body_height_m([stretch]) == pytest.approx(STANDING_M["neck"][2] + 0.16 - STANDING_M["left_foot"][2] + 0.11)


def test_pieces_begin_and_end_with_a_measured_pose(tmp_path: Path):
    write_split(tmp_path, "test", [*range(12), *range(13, 31)])
    pieces = cut(read_mars(tmp_path, "test"), 6, 10)
    assert [piece.frame.tolist() for piece in pieces] == [[0, 1, 2, 3, 4, 5]] * 2 + [[0, 1, 2, 3, 4, 5]] * 2
    assert len(cut(read_mars(tmp_path, "test"), 6, 2)) == 2


def test_clouds_are_cut_to_the_recordings_box():
    places = [(0.9, 2.0, 0.9), (1.1, 2.0, 0.0), (0.0, 2.0, 1.1), (0.0, 3.1, 0.0), (-1.0, 3.0, -1.0), (0.0, 2.0, -1.2)]
    rows = np.array([[0, 1, *place, 0.0, 20 + index, 1.6e9] for index, place in enumerate(places)])
    assert as_published(cloud_of(rows)).intensity.tolist() == [20, 24]
