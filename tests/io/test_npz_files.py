"""The project's own files: restored as written, reproducible byte by byte, and never pickled."""

import time
import zipfile
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, MMMESH
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, PointCloud, PoseSequence, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import JOINT_NAMES
from mmweaver.io.npz_files import (
    read_npz,
    read_points_npz,
    read_poses_npz,
    read_radar_npz,
    write_points_npz,
    write_pose_npz,
    write_radar_npz,
)


def make_cube(num_frames: int = 2) -> RadarCube:
    grid = CubeGrid.of(AWR1843, num_frames)
    random = stream(3, "test")
    values = random.normal(size=grid.shape) + 1j * random.normal(size=grid.shape)
    return RadarCube(values=values.astype(np.complex64), grid=grid, config=AWR1843, scale=0.5)


def test_radar_npz_has_the_documented_keys_and_is_restored(tmp_path: Path):
    cube = make_cube()
    write_radar_npz(tmp_path / "radar.npz", cube)
    arrays = read_npz(tmp_path / "radar.npz")
    assert arrays["cube"].dtype == np.complex64
    assert arrays["cube"].shape == (2, 64, 32, 12)
    assert arrays["antenna_position_m"].shape == (12, 3)
    assert arrays["axes"].tolist() == ["frame", "range", "doppler", "antenna"]
    assert {"frame_time_s", "range_m", "radial_velocity_mps", "wavelength_m", "scale", "units"} <= set(arrays)
    (tmp_path / "radar.json").write_text(AWR1843.to_json())
    again = read_radar_npz(tmp_path / "radar.npz")
    assert np.array_equal(again.values, cube.values)
    assert (again.config, again.scale, again.grid.wavelength_m) == (AWR1843, 0.5, AWR1843.wavelength_m)


def test_a_cube_needs_its_own_radar(tmp_path: Path):
    write_radar_npz(tmp_path / "radar.npz", make_cube())
    with pytest.raises(InputError, match=r"radar\.json"):
        read_radar_npz(tmp_path / "radar.npz")
    with pytest.raises(InputError, match="mmmesh"):
        read_radar_npz(tmp_path / "radar.npz", MMMESH)


def test_a_pose_file_of_nobody(tmp_path: Path):
    write_pose_npz(tmp_path / "pose.npz", time_s=np.arange(4) / 10)
    arrays = read_npz(tmp_path / "pose.npz")
    assert (arrays["joints_m"].shape, arrays["height_m"].shape) == ((0, 4, 22, 3), (0,))
    assert arrays["frame_time_s"].tolist() == [0.0, 0.1, 0.2, 0.3]
    assert read_poses_npz(tmp_path / "pose.npz") == ()
    write_pose_npz(tmp_path / "pose.npz", time_s=np.zeros(0))
    with pytest.raises(InputError, match=r"pose\.npz"):
        read_poses_npz(tmp_path / "pose.npz")


def test_pose_and_points_are_restored(tmp_path: Path):
    joints = stream(0, "test").normal(size=(4, 22, 3)).astype(np.float32)
    write_pose_npz(tmp_path / "pose.npz", PoseSequence(time_s=np.arange(4) / 10, joints_m=joints, height_m=1.7))
    pose = read_poses_npz(tmp_path / "pose.npz")[0]
    assert np.array_equal(pose.joints_m, joints)
    assert pose.height_m == 1.7
    assert tuple(read_npz(tmp_path / "pose.npz")["joint_names"].tolist()) == JOINT_NAMES

    column = np.arange(3.0)
    cloud = PointCloud(
        frame=np.array([0, 0, 1]), x_m=column, y_m=column, z_m=column, radial_velocity_mps=column, snr_db=column
    )
    write_points_npz(tmp_path / "points.npz", cloud)
    again = read_points_npz(tmp_path / "points.npz")
    assert again.frame.tolist() == [0, 0, 1]
    assert np.array_equal(again.snr_db, column)


def test_the_same_arrays_give_the_same_bytes_at_any_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    write_radar_npz(tmp_path / "a.npz", make_cube())
    later = time.localtime(2_000_000_000)
    monkeypatch.setattr(time, "localtime", lambda *_: later)
    monkeypatch.setattr(time, "time", lambda: 2_000_000_000.0)
    write_radar_npz(tmp_path / "b.npz", make_cube())
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    with zipfile.ZipFile(tmp_path / "b.npz") as archive:
        assert {entry.date_time[0] for entry in archive.infolist()} == {1980}
