"""Poses of scans: each format's axes, and which frames show the most."""

import json
from pathlib import Path

import numpy as np
import pytest

from mmweaver.scene.scan_folders import scan_pose, spread_out

# a camera 1 m along x that looks along -x, upright; y is up in the worlds of phones, z in those of data sets
PLACE = (1.0, 0.0, 0.0)
Y_UP = np.array([[0.0, 0, -1], [0, -1, 0], [-1, 0, 0]])
Z_UP = np.array([[0.0, 0, -1], [1, 0, 0], [0, -1, 0]])


def quaternion(rotation: np.ndarray) -> list[float]:
    from scipy.spatial.transform import Rotation

    return Rotation.from_matrix(rotation).as_quat().tolist()


def test_every_format_gives_the_same_camera(tmp_path: Path):
    arkit = Y_UP @ np.diag([1.0, -1, -1])  # x right, y up, z backward
    words = " ".join(map(str, (*PLACE, *quaternion(Z_UP))))
    (tmp_path / "groundtruth.txt").write_text(f"# time place turn\n5.00 {words}\n9.0 0 0 0 0 0 0 1\n")
    row = ", ".join(map(str, (*PLACE, *quaternion(Y_UP))))
    (tmp_path / "odometry.csv").write_text(f"timestamp, frame, x, y, z, qx, qy, qz, qw\n0.1, 000007, {row}\n")
    (tmp_path / "metadata").write_text(json.dumps({"poses": [[*quaternion(arkit), *PLACE]]}))
    (tmp_path / "keyframes" / "cameras").mkdir(parents=True)
    said = {f"t_{i}{j}": float(np.column_stack([arkit, PLACE])[i, j]) for i in range(3) for j in range(4)}
    (tmp_path / "keyframes" / "cameras" / "3.json").write_text(json.dumps(said))
    frames = {"TUM RGB-D": ("5.01.png", Z_UP), "Stray Scanner": ("000007.png", Y_UP), "Record3D": ("0.jpg", Y_UP),
              "Polycam": ("keyframes/images/3.jpg", Y_UP)}  # fmt: skip
    for kind, (name, rotation) in frames.items():
        pose = scan_pose(tmp_path, kind, tmp_path / name)
        assert pose is not None
        assert np.allclose(pose[:3, :3], rotation, atol=1e-6)
        assert np.allclose(pose[:3, 3], PLACE)
    assert scan_pose(tmp_path, "TUM RGB-D", tmp_path / "6.0.png") is None


def test_frames_that_show_the_most_are_chosen():
    def looking(degrees: float) -> np.ndarray:
        turned, angle = np.eye(4), np.deg2rad(degrees)
        turned[:3, :3] = [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
        return turned

    poses = [looking(degrees) for degrees in range(0, 360, 10)]
    chosen = spread_out(poses, 0, most=3)
    assert sorted(10 * index for index in chosen) == pytest.approx([90, 180, 270], abs=21)
    assert spread_out(poses[:2], 0) == []
