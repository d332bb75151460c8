""".npy and .npz: shapes that are known, CMU's collection, and every other thing refused by name."""

from pathlib import Path

import numpy as np
import pytest
from mocap_files import walk, y_up

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import JOINT_NAMES, joint
from mmweaver.motion.mocap.humanml3d_features import features_from_joints
from mmweaver.motion.mocap.joint_arrays import CMU_NAMES, clips_of, read_npy, read_npz


@pytest.mark.parametrize("shape", ["22x3", "66", "24x3", "1x22x3"])
def test_joints(tmp_path: Path, shape: str):
    joints = walk()
    saved = {
        "22x3": joints,
        "66": joints.reshape(-1, 66),
        "24x3": np.concatenate([joints, joints[:, -2:]], axis=1),
        "1x22x3": joints[None],
    }
    np.save(tmp_path / "walk.npy", saved[shape].astype(np.float64))
    raw = read_npy(tmp_path / "walk.npy")
    np.testing.assert_array_equal(raw.positions, joints)
    assert (raw.fps, raw.unit_m, raw.up) == (None, None, None)


def test_features(tmp_path: Path):
    features = features_from_joints(y_up(walk(20.0)))
    np.save(tmp_path / "walk.npy", features)
    raw = read_npy(tmp_path / "walk.npy")
    assert (raw.fps, raw.up, raw.positions.shape) == (20.0, "y", (39, 22, 3))
    np.save(tmp_path / "normal.npy", (features - features.mean(0)) / (features.std(0) + 0.1))
    with pytest.raises(InputError, match="normalised"):
        read_npy(tmp_path / "normal.npy")


def test_own_pose_file_and_named_joints(tmp_path: Path):
    order = np.random.default_rng(0).permutation(22)
    names = np.array([JOINT_NAMES[k] for k in order])
    time_s = np.arange(120) / 60
    np.savez(tmp_path / "pose.npz", joints_m=walk()[:, order], joint_names=names, frame_time_s=time_s)
    raw = read_npz(tmp_path / "pose.npz")
    assert raw.fps == pytest.approx(60.0)
    assert (raw.unit_m, raw.up, raw.names[0]) == (1.0, "z", names[0])
    np.savez(tmp_path / "bare.npz", joints=walk(), fps=np.float32(30))
    assert read_npz(tmp_path / "bare.npz").fps == 30.0


def cmu(path: Path) -> None:
    positions = np.zeros((70, 38, 3), np.float16)
    index = {name: k for k, name in CMU_NAMES.items()}
    positions[30:70, index["left_hand"]] = y_up(walk())[:40, joint("left_wrist")]
    np.savez(
        path, names=np.array(["a/walk/walk_1.txt", "a/run/run_1.txt"]), lengths=np.array([30, 40]), pos=positions,
        parents=np.zeros(38, int),
    )  # fmt: skip


def test_a_collection_of_clips(tmp_path: Path):
    cmu(tmp_path / "cmu.npz")
    assert clips_of(tmp_path / "cmu.npz") == ("a/walk/walk_1.txt", "a/run/run_1.txt")
    for said in ("a/run/run_1.txt", "run_1"):
        raw = read_npz(tmp_path / "cmu.npz", said)
        assert (len(raw.positions), raw.fps, raw.up) == (40, 120.0, "y")
        hand = raw.positions[:, raw.names.index("left_hand")]
        np.testing.assert_allclose(hand, y_up(walk())[:40, joint("left_wrist")], atol=2e-3)
    with pytest.raises(InputError, match="--motion-set clip=a/walk"):
        read_npz(tmp_path / "cmu.npz")
    for said, count in (("_1", 2), ("swim", 0)):
        with pytest.raises(InputError, match=f"names {count} of its 2"):
            read_npz(tmp_path / "cmu.npz", said)


def test_everything_else_is_refused_by_name(tmp_path: Path):
    np.save(tmp_path / "kit.npy", np.zeros((50, 21, 3)))
    with pytest.raises(InputError, match=r"\(50, 21, 3\)"):
        read_npy(tmp_path / "kit.npy")
    np.save(tmp_path / "words.npy", np.array(["walk"]))
    np.save(tmp_path / "objects.npy", np.array([{"a": 1}], dtype=object), allow_pickle=True)
    np.save(tmp_path / "complex.npy", np.zeros((5, 22, 3), complex))
    (tmp_path / "text.npy").write_text("walk")
    for name in ("words", "objects", "complex", "text"):
        with pytest.raises(InputError, match="number"):
            read_npy(tmp_path / f"{name}.npy")
    np.savez(tmp_path / "radar.npz", cube=np.zeros(4))
    with pytest.raises(InputError, match="holds cube; neither"):
        read_npz(tmp_path / "radar.npz")
    (tmp_path / "text.npz").write_text("walk")
    with pytest.raises(InputError, match=r"no plain \.npz"):
        read_npz(tmp_path / "text.npz")
    np.savez(tmp_path / "names.npz", joints=np.zeros((5, 4, 3)), joint_names=np.array(["a", "b"]))
    with pytest.raises(InputError, match="2 joint names"):
        read_npz(tmp_path / "names.npz")
    np.savez(tmp_path / "one.npz", joints=walk())
    with pytest.raises(InputError, match="single motion"):
        read_npz(tmp_path / "one.npz", "walk")
