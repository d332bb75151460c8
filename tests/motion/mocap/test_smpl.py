"""SMPL poses: at rest the mean body, turned as a body turns; a body model's own bones; what is no pose is refused."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import PARENTS, joint
from mmweaver.motion.mocap.axes import is_reflected, rotate_z_up
from mmweaver.motion.mocap.clip import body_height
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward, read_smpl

HERE = Path("poses.npz")


def poses(frames: int = 5, numbers: int = 156) -> dict[str, np.ndarray]:
    return {"poses": np.zeros((frames, numbers)), "trans": np.zeros((frames, 3)), "mocap_framerate": np.array(100.0)}


def test_at_rest_it_is_the_mean_body_in_a_t_pose():
    raw = read_smpl(poses(), HERE)
    assert raw.fps == 100.0
    at = raw.positions[0]
    assert at[joint("left_wrist"), 0] - at[joint("right_wrist"), 0] == pytest.approx(1.40, abs=0.05)
    assert at[joint("head"), 1] - at[joint("left_ankle"), 1] == pytest.approx(1.45, abs=0.05)
    assert body_height(raw.positions) == pytest.approx(1.71, abs=0.03)
    assert not is_reflected(rotate_z_up(raw.positions, "y"))


def test_rotations_turn_what_is_below_them():
    """A left elbow bent by 90 degrees about the body's up axis brings the forearm forward; nothing else moves."""
    given = poses()
    given["poses"][:, 3 * joint("left_elbow") + 1] = -np.pi / 2
    bent, rest = read_smpl(given, HERE).positions[0], read_smpl(poses(), HERE).positions[0]
    moved = np.linalg.norm(bent - rest, axis=-1) > 1e-9
    assert moved.tolist() == [k == joint("left_wrist") for k in range(22)]
    forearm = bent[joint("left_wrist")] - bent[joint("left_elbow")]
    assert forearm[2] > 0.99 * np.linalg.norm(forearm)


def test_against_products_of_matrices():
    """An independent sum over the chain of each joint, with random rotations."""
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(1)
    angles, trans = rng.normal(0, 0.7, (3, 22, 3)), rng.normal(0, 1, (3, 3))
    positions = forward(angles, trans, MEAN_OFFSET_M)
    for frame in range(3):
        for k in range(22):
            chain, at = [k], trans[frame] + MEAN_OFFSET_M[0]
            while PARENTS[chain[-1]] >= 0:
                chain.append(PARENTS[chain[-1]])
            matrix = np.eye(3)
            for one, after in zip(chain[::-1], [*chain[::-1][1:], None], strict=True):
                matrix = matrix @ Rotation.from_rotvec(angles[frame, one]).as_matrix()
                if after is not None:
                    at = at + matrix @ MEAN_OFFSET_M[after]
            np.testing.assert_allclose(positions[frame, k], at, atol=1e-12)


@pytest.mark.parametrize("keys", ["poses", "pose", "smplx"])
def test_spellings(keys: str):
    rng = np.random.default_rng(0)
    body = rng.normal(0, 0.3, (4, 66))
    trans = rng.normal(0, 1, (4, 3))
    spelt = {
        "poses": {"poses": np.pad(body, ((0, 0), (0, 90))), "trans": trans},
        "pose": {"pose": np.pad(body, ((0, 0), (0, 6))), "root_translation": trans},
        "smplx": {"root_orient": body[:, :3], "pose_body": body[:, 3:], "trans": trans},
    }[keys]
    truth = forward(body.reshape(4, 22, 3), trans, MEAN_OFFSET_M)
    np.testing.assert_allclose(read_smpl(spelt, HERE).positions, truth)


def test_a_body_model_of_ones_own_gives_its_bones(tmp_path: Path):
    """A model of 30 points whose joints are points, and whose first shape stretches it."""
    points = np.random.default_rng(0).normal(0, 1, (30, 3))
    shapes = np.zeros((30, 3, 2))
    shapes[:, :, 0] = points  # betas[0] = 0.1 makes everything 10 % larger
    np.savez(tmp_path / "model.npz", v_template=points, shapedirs=shapes, J_regressor=np.eye(24, 30))
    given = poses() | {"betas": np.array([0.1])}
    at = read_smpl(given, HERE, tmp_path / "model.npz").positions[0]
    np.testing.assert_allclose(at, 1.1 * points[:22], atol=1e-12)
    with pytest.raises(InputError, match="pickles"):
        read_smpl(given, HERE, tmp_path / "SMPL_NEUTRAL.pkl")
    np.savez(tmp_path / "other.npz", v_template=points)
    with pytest.raises(InputError, match="no body model"):
        read_smpl(given, HERE, tmp_path / "other.npz")


def test_what_is_no_pose_is_refused():
    with pytest.raises(InputError, match="at least 66"):
        read_smpl(poses(numbers=48), HERE)
    with pytest.raises(InputError, match="translation"):
        read_smpl(poses() | {"trans": np.zeros((4, 3))}, HERE)
    with pytest.raises(InputError, match="no frames"):
        read_smpl({"poses": np.zeros((0, 72)), "trans": np.zeros((0, 3))}, HERE)
