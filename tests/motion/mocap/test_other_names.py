"""Motions under the names and in the shapes of other programs are the same motion."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mmweaver.core.errors import InputError
from mmweaver.motion.mocap.humanml3d_features import features_from_joints
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases"
FRAMES = 40


def poses() -> tuple[np.ndarray, np.ndarray]:
    """Rotations (frame, 22, 3) of a body that swings its arms, y up, and its path."""
    rotations = np.zeros((FRAMES, 22, 3))
    rotations[:, 16, 2], rotations[:, 17, 2] = -1.3, 1.3
    rotations[:, 18, 1] = 0.4 * np.sin(np.arange(FRAMES) / 5)
    path = np.stack([0.02 * np.arange(FRAMES), np.full(FRAMES, 0.95), np.zeros(FRAMES)], axis=1)
    return rotations, path


def joints() -> np.ndarray:
    return forward(*poses(), MEAN_OFFSET_M)


def same(path: Path, **options) -> None:
    clip = read_motion(path, **options)
    y_up = joints()[-len(clip.joints_m) :]
    assert np.allclose(clip.joints_m, np.stack([y_up[..., 0], -y_up[..., 2], y_up[..., 1]], axis=-1), atol=1e-4)


def test_names_of_smplx(tmp_path: Path):
    rotations, path = poses()
    np.savez(tmp_path / "a.npz", global_orient=rotations[:, 0], body_pose=rotations[:, 1:].reshape(FRAMES, -1),
             transl=path, fps=30)  # fmt: skip
    same(tmp_path / "a.npz")
    matrices = Rotation.from_rotvec(rotations.reshape(-1, 3)).as_matrix().reshape(FRAMES, 22, 3, 3)
    np.savez(tmp_path / "b.npz", global_orient=matrices[:, :1], body_pose=matrices[:, 1:], transl=path, fps=30)
    same(tmp_path / "b.npz")


def test_shapes_of_mdm_smpl_h_and_motion_x(tmp_path: Path):
    np.save(tmp_path / "mdm.npy", joints().transpose(1, 2, 0)[None])
    same(tmp_path / "mdm.npy")
    np.save(tmp_path / "smplh.npy", np.concatenate([joints(), np.zeros((FRAMES, 30, 3))], axis=1))
    same(tmp_path / "smplh.npy", fps=30.0)
    rotations, path = poses()
    row = np.zeros((FRAMES, 322))
    row[:, :66], row[:, 309:312] = rotations.reshape(FRAMES, -1), path
    np.save(tmp_path / "motion_x.npy", row)
    same(tmp_path / "motion_x.npy")


def test_normalised_features_with_their_statistics(tmp_path: Path):
    features = features_from_joints(joints())
    mean, std = features.mean(axis=0), features.std(axis=0) + 0.1
    (tmp_path / "new_joint_vecs").mkdir()
    np.save(tmp_path / "new_joint_vecs" / "a.npy", (features - mean) / std)
    with pytest.raises(InputError, match=r"Mean\.npy"):
        read_motion(tmp_path / "new_joint_vecs" / "a.npy")
    np.save(tmp_path / "Mean.npy", mean)
    np.save(tmp_path / "Std.npy", std)
    np.save(tmp_path / "new_joint_vecs" / "plain.npy", features)
    normalised, plain = (read_motion(tmp_path / "new_joint_vecs" / name) for name in ("a.npy", "plain.npy"))
    assert np.allclose(normalised.joints_m, plain.joints_m, atol=1e-6)


def test_a_pickle_is_named(tmp_path: Path):
    (tmp_path / "wham_output.pkl").write_bytes(b"\x80\x04.")
    with pytest.raises(InputError, match="pickle"):
        read_motion(tmp_path / "wham_output.pkl")


def test_tabs_in_bvh_are_spaces(tmp_path: Path):
    from tests.fuzz.readers import _bvh

    (tmp_path / "spaces.bvh").write_text(_bvh())
    (tmp_path / "tabs.bvh").write_text(_bvh().replace(" ", "\t"))
    assert np.array_equal(read_motion(tmp_path / "tabs.bvh").joints_m, read_motion(tmp_path / "spaces.bvh").joints_m)


@pytest.mark.skipif(not CASES.is_dir(), reason="the made cases are not here")
def test_made_cases():
    assert len(read_motion(CASES / "smplx_names" / "x.npz").joints_m) == 30
    right = read_motion(CASES / "bvh_tab" / "space.bvh").joints_m
    for file in sorted((CASES / "bvh_tab").glob("*.bvh")):
        assert np.allclose(read_motion(file).joints_m, right), file.name
