"""Reading recordings in the format of MARS; the tables here are made up."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import BONES, joint
from studies.physics.mars_data import joints_from_kinect, read_mars
from tests.rooms import STANDING_M

KINECT = (
    "pelvis", "spine2", "neck", "head", "left_shoulder", "left_elbow", "left_wrist", "left_wrist", "right_shoulder",
    "right_elbow", "right_wrist", "right_wrist", "left_hip", "left_knee", "left_ankle", "left_foot", "right_hip",
    "right_knee", "right_ankle", "right_foot", "spine3", "left_wrist", "left_wrist", "right_wrist", "right_wrist",
)  # fmt: skip


def standing_kinect() -> np.ndarray:
    """A person 1.9 m ahead with the floor 0.95 m below, as 25 joints, who faces the sensor."""
    place = np.array([STANDING_M[name] for name in KINECT], float) + np.array([0, 1.9, -0.95])
    place[3] = place[2] + np.array([0, 0, 0.16])
    return place


def write_split(folder: Path, split: str, numbers: list[int], moving: float = 0.0) -> None:
    """A point or two a frame near the chest, joints that sway."""
    rng = stream(0, split)
    radar = []
    for number in numbers:
        for _ in range(1 + number % 2):
            place = np.array([0.1, 1.8, 0.3]) + 0.1 * rng.standard_normal(3)
            radar.append([number, 1 + number % 2, *place, 0.356 * (number % 3 - 1), 20 + number % 7, 1.6e9])
    joints = standing_kinect()
    sway = moving * np.sin(2 * np.pi * 0.5 * 0.1 * np.array(numbers))
    kinect = np.stack([(joints + np.array([0, by, 0])).T.ravel() for by in sway])
    np.savetxt(folder / f"radar_data_{split}.csv", radar, delimiter=",", header="names", comments="")
    np.savetxt(folder / f"kinect_data_{split}.csv", kinect, delimiter=",", header="names", comments="")


def test_joints_of_the_kinect_become_ours():
    joints = joints_from_kinect(standing_kinect()[None])
    assert joints.shape == (1, 22, 3)
    # who faces us has the left hand on our right
    assert joints[0, joint("left_wrist"), 0] > 0 > joints[0, joint("right_wrist"), 0]
    length = [np.linalg.norm(joints[0, a] - joints[0, b]) for a, b in BONES]
    assert 0.02 < min(length) < max(length) < 0.6
    assert joints[0, joint("neck"), 2] < joints[0, joint("head"), 2] < standing_kinect()[3, 2]


def test_stretches_end_at_long_gaps(tmp_path: Path):
    write_split(tmp_path, "test", [5, 6, 7, 9, 50, 51, 52, 53, 90])
    stretches = read_mars(tmp_path, "test")
    assert [stretch.frame.tolist() for stretch in stretches] == [[0, 1, 2, 4], [0, 1, 2, 3]]
    assert [len(cloud.x_m) for cloud in stretches[0].clouds] == [2, 1, 2, 2]
    assert stretches[0].clouds[0].intensity[0] == 25


def test_what_is_no_recording_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="MARS subject"):
        read_mars(tmp_path, "test")
    write_split(tmp_path, "test", [1, 2, 3])
    write_split(tmp_path, "validate", [1, 2])
    (tmp_path / "radar_data_validate.csv").write_bytes((tmp_path / "radar_data_test.csv").read_bytes())
    with pytest.raises(InputError, match=r"3 frames .*Kinect 2"):
        read_mars(tmp_path, "validate")
    (tmp_path / "kinect_data_test.csv").write_text("a\nx\n")
    with pytest.raises(InputError, match="no table"):
        read_mars(tmp_path, "test")
    (tmp_path / "kinect_data_test.csv").write_text("a,b\n1,2\n")
    with pytest.raises(InputError, match="2 columns, 75"):
        read_mars(tmp_path, "test")
