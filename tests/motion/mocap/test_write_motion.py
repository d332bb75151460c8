"""Written motions come back with their joints: BVH through our reader, whose own tests hold it to other writers."""

from pathlib import Path

import numpy as np

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import PARENTS
from mmweaver.motion.empty_floor import act_out
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.motion.mocap.write_motion import write_amass, write_bvh, write_humanml3d


def walk() -> PoseSequence:
    pose = act_out("a person walks to the left, then waves", duration_s=4.0, seed=1).pose
    return PoseSequence(time_s=pose.time_s[::4], joints_m=pose.joints_m[::4], height_m=pose.height_m)


def angles_deg(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Angle between the bones of two bodies, (frame, bone)."""
    bones = [joints[:, 1:] - joints[:, list(PARENTS[1:])] for joints in (one, other)]
    unit = [bone / np.linalg.norm(bone, axis=2, keepdims=True) for bone in bones]
    return np.degrees(np.arccos(np.clip((unit[0] * unit[1]).sum(axis=2), -1, 1)))


def test_bvh_keeps_every_joint(tmp_path: Path):
    pose = walk()
    write_bvh(tmp_path / "walk.bvh", pose)
    clip = read_motion(tmp_path / "walk.bvh")
    assert abs(clip.fps - 30) < 0.01
    error_m = np.linalg.norm(clip.joints_m - pose.joints_m[-len(clip.joints_m) :], axis=2)
    assert error_m.max() < 0.02
    assert np.median(error_m) < 0.003


def test_amass_keeps_path_and_directions_of_bones(tmp_path: Path):
    pose = walk()
    write_amass(tmp_path / "walk.npz", pose)
    with np.load(tmp_path / "walk.npz") as held:
        assert held["poses"].shape == (len(pose.time_s), 156)
    clip = read_motion(tmp_path / "walk.npz")
    joints_m = pose.joints_m[-len(clip.joints_m) :]
    assert np.abs(clip.joints_m[:, 0] - joints_m[:, 0]).max() < 1e-5
    limbs = [child - 1 for child, parent in enumerate(PARENTS) if parent in (1, 2, 4, 5, 16, 17, 18, 19)]
    assert angles_deg(clip.joints_m, joints_m)[:, limbs].max() < 0.01


def test_humanml3d_keeps_the_motion_from_its_own_start(tmp_path: Path):
    pose = walk()
    write_humanml3d(tmp_path / "walk.npy", pose)
    clip = read_motion(tmp_path / "walk.npy")
    assert clip.fps == 20
    length = np.linalg.norm(np.diff(clip.joints_m[:, 0, :2], axis=0), axis=1).sum()
    truth = np.linalg.norm(np.diff(pose.joints_m[:, 0, :2], axis=0), axis=1).sum()
    assert abs(length - truth) < 0.05 * truth
    assert abs(clip.height_m - 1.0 * pose.height_m) < 0.12 * pose.height_m
