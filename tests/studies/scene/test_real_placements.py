import dataclasses

import numpy as np
import pytest
from scipy.spatial import KDTree

from mmweaver.core.pinhole import project
from studies.scene.real_placements import deepest_m, floor_error_m, measured_m
from tests.motion.rooms import FLOOR_Z_M, room
from tests.rooms import standing_person


def test_a_point_within_a_limb_counts_and_one_beside_it_does_not():
    pose = standing_person((0.0, 2.0, FLOOR_Z_M), seconds=0.3)
    shin = pose.joints_m[0, [4, 7]].mean(axis=0).astype(float)
    inside, _ = deepest_m(KDTree(shin[None]), pose, None)
    assert 0.0 < inside < 0.05
    assert deepest_m(KDTree(shin[None] + np.array([0.3, 0.4, 0.0])), pose, None) == (0.0, 0.0)


def test_trunk_and_thighs_may_sink_into_a_seat():
    pose = standing_person((0.0, 2.0, FLOOR_Z_M), seconds=0.3)
    pelvis = pose.joints_m[0, 0].astype(float)
    assert deepest_m(KDTree(pelvis[None]), pose, None)[0] > 0.05
    assert deepest_m(KDTree(pelvis[None]), pose, pelvis[:2])[0] == 0.0


def test_the_floor_is_held_against_marked_places():
    scene = room()
    lens = scene.photo.intrinsics
    rows, _ = np.mgrid[0 : lens.height, 0 : lens.width]
    below = np.maximum(rows - lens.cy, 0.5) / lens.fy
    photo = dataclasses.replace(scene.photo, depth_m=np.minimum(-(FLOOR_Z_M + 0.02) / below, 9.0))
    pixels, _ = project(np.array([[0.0, 2.5, FLOOR_Z_M]]) @ scene.radar_from_camera, lens)
    mark = [float(pixels[0, 0] / lens.width), float(pixels[0, 1] / lens.height)]
    error_m, num_marks = floor_error_m(scene, photo, [mark, [mark[0] + 0.1, mark[1]]])
    assert num_marks == 2
    assert error_m == pytest.approx(0.02, abs=0.003)
    assert (measured_m(scene, photo)[:, 2] > FLOOR_Z_M + 0.05).all()
