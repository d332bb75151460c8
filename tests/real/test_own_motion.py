"""Recorded motion of other people: HumanML3D's sample to 1e-5, all of CMU's clips, in our rooms."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.records import FreeSpace, Scene
from mmweaver.core.skeleton import joint
from mmweaver.motion.mocap.clip import resampled_clip
from mmweaver.motion.mocap.clip_placement import place_clip
from mmweaver.motion.mocap.humanml3d_features import features_from_joints
from mmweaver.motion.mocap.joint_arrays import CONTACTS, clips_of, joints_from_features
from mmweaver.motion.mocap.read_motion import read_motion
from studies.physics.empty_room_cube import empty_room

SAMPLE = Path("motion") / "humanml3d_sample"
CMU = Path("motion") / "cmu" / "cmu_joints_m_120fps.npz"
SMOOTHING_FRAMES = 80  # of the published heading: four times its Gaussian; the sample lacks the recording's last frame


def wide_room() -> Scene:
    """A floor of 24 x 16 m, so that no motion is cut short."""
    x, y = np.arange(-12, 12.01, 0.25), np.arange(0.0, 16.01, 0.25)
    free = np.ones((len(y), len(x)), bool)
    return replace(empty_room(floor_z_m=-1.0), free_space=FreeSpace(x_m=x, y_m=y, is_free=free, is_seen=free))


@pytest.fixture
def sample(real_data: Path) -> tuple[np.ndarray, np.ndarray]:
    folder = real_data / SAMPLE
    return tuple(
        np.load(folder / f"HumanML3D_{name}_012314.npy").astype(float) for name in ("new_joint_vecs", "new_joints")
    )


def test_joints_from_features(sample: tuple[np.ndarray, np.ndarray]):
    features, joints = sample
    assert np.abs(joints_from_features(features) - joints).max() < 1e-5


def test_features_from_joints(sample: tuple[np.ndarray, np.ndarray]):
    """All columns, rotations and the heading's smoothing included; near the end the smoothing misses one frame."""
    features, joints = sample
    made = features_from_joints(joints)
    assert np.abs(made - features[:-1])[:-SMOOTHING_FRAMES].max() < 1e-5
    assert np.abs(made - features[:-1]).max() < 0.015
    assert np.array_equal(made[:, CONTACTS], features[:-1, CONTACTS])
    assert np.abs(joints_from_features(made) - joints[:-1]).max() < 1e-5


@pytest.mark.parametrize("clip", ["walking_1", "basketball_1", "soccer_1"])
def test_bones_of_cmu_are_a_persons_in_metres(real_data: Path, clip: str):
    joints_m = read_motion(real_data / CMU, clip=f"test/{clip.partition('_')[0]}/{clip}.txt").joints_m
    for side in ("left", "right"):
        assert 0.35 < _bone_m(joints_m, f"{side}_hip", f"{side}_knee") < 0.50  # femur
        assert 0.33 < _bone_m(joints_m, f"{side}_knee", f"{side}_ankle") < 0.48  # tibia
        assert 0.24 < _bone_m(joints_m, f"{side}_shoulder", f"{side}_elbow") < 0.38  # humerus
    assert 0.30 < _bone_m(joints_m, "pelvis", "neck") < 0.65  # spine; its skeleton's neck begins low


def _bone_m(joints_m: np.ndarray, start: str, end: str) -> float:
    return float(np.median(np.linalg.norm(joints_m[:, joint(end)] - joints_m[:, joint(start)], axis=-1)))


def test_every_clip_of_cmu_is_read_and_resampled_without_spikes(real_data: Path):
    path = real_data / CMU
    names = clips_of(path)
    assert len(names) == 89
    for name in names[::6]:
        clip = read_motion(path, clip=name)
        assert 1.3 < clip.height_m < 2.0
        _, joints = resampled_clip(clip, min(clip.duration_s, 4.0))
        speed = np.linalg.norm(np.diff(joints, axis=0), axis=-1) * 120
        acceleration = np.linalg.norm(np.diff(joints, 2, axis=0), axis=-1) * 120**2
        assert speed.max() < 12
        assert np.percentile(acceleration, 99.9) < 200


def test_a_recorded_walk_in_a_wide_room(real_data: Path):
    clip = read_motion(real_data / CMU, clip="train/walking/walking_2.txt")
    scene = wide_room()
    motion = place_clip(clip, scene, duration_s=4.0, seed=0, range_window_m=(0.7, 15.0))
    lowest = motion.pose.joints_m[..., 2].min(axis=1) - scene.floor_z_m
    assert lowest.min() > -0.03
    assert np.median(lowest) < 0.05
    assert motion.pose.height_m == clip.height_m
    assert empty_room(floor_z_m=-1.0).floor_z_m == scene.floor_z_m
