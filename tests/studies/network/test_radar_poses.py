"""The study of radars elsewhere: at the camera it is the data set, and a turn of the radar turns what it sees."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.radar_pose import RadarPose
from mmweaver.datasets.dataset_store import read_plan, read_rooms
from studies.network.learned_scores import Case
from studies.network.radar_poses import motion_of, simulated

pytest.importorskip("zarr")


@pytest.fixture(scope="module")
def case(tiny_geometry: Path) -> Case:
    room = read_rooms(tiny_geometry)[0]
    return Case(room, 0, room, read_plan(tiny_geometry)["seed"], room.lighting)


def test_a_turn_of_the_radar_turns_the_joints(case: Case):
    level, turned = (motion_of(case, pose, skin=0) for pose in (RadarPose(), RadarPose(yaw_deg=90.0)))
    assert np.allclose(turned.joints_m[..., 0], -level.joints_m[..., 1])
    assert motion_of(case, RadarPose(), skin=7).subject == level.subject + 7


@pytest.mark.slow  # the joints above are where the signal comes from
def test_at_the_camera_the_truth_is_that_of_the_data_set(case: Case):
    made, stored = simulated(case.true_scene, case, RadarPose(), other=0).values, case.room.cube(0).values
    agreement = np.vdot(made, stored) / (np.linalg.norm(made) * np.linalg.norm(stored))
    assert abs(agreement) > 0.98
