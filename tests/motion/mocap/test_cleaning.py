"""Gaps, zeros, T-poses and joints that are mixed up."""

import re

import numpy as np
import pytest
from mocap_files import walk

from mmweaver.core.errors import InputError
from mmweaver.core.skeleton import joint
from mmweaver.motion.mocap.cleaning import check_bones, cut_t_pose, fill_gaps, is_t_pose
from mmweaver.motion.mocap.smpl import MEAN_OFFSET_M, forward

FPS = 60.0


def t_pose(frames: int) -> np.ndarray:
    at = forward(np.zeros((frames, 22, 3)), np.tile([0.0, 1.0, 0.0], (frames, 1)), MEAN_OFFSET_M)
    return np.stack([at[..., 0], -at[..., 2], at[..., 1]], axis=-1)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_short_gaps_are_bridged_smoothly(value: float):
    holed = walk().copy()
    holed[40:48, joint("left_wrist")] = value
    holed[70, :] = 0.0  # a frame that was dropped
    filled, notes = fill_gaps(holed, FPS, "walk")
    assert np.abs(filled - walk()).max() < 0.02
    assert "9 frames of walk" in notes[0]
    untouched = np.delete(np.arange(len(filled)), [70, *range(40, 48)])
    np.testing.assert_array_equal(filled[untouched], walk()[untouched])


@pytest.mark.parametrize(
    ("frames", "message"),
    [
        (slice(30, 60), r"walk: left_knee is missing for 30 frames \(0.50 s\) from frame 30"),
        (slice(0, 3), "from frame 0"),
        (slice(-2, None), "missing"),
    ],
)
def test_long_gaps_and_gaps_at_an_end_are_refused(frames: slice, message: str):
    holed = walk().copy()
    holed[frames, joint("left_knee")] = np.nan
    with pytest.raises(InputError, match=message):
        fill_gaps(holed, FPS, "walk")


@pytest.mark.parametrize(
    "joints", [np.zeros((30, 22, 3)), np.full((30, 22, 3), np.nan), np.ones((30, 22, 3)), np.zeros((0, 22, 3))]
)
def test_no_motion_at_all_is_refused(joints: np.ndarray):
    with pytest.raises(InputError, match="no motion"):
        fill_gaps(joints, FPS, "walk")


def test_a_t_pose_in_front_is_cut_off_where_the_motion_jumps():
    assert is_t_pose(t_pose(2)).all()
    assert not is_t_pose(walk()).any()
    joints, notes = cut_t_pose(np.concatenate([t_pose(4), walk()]), FPS, "walk")
    np.testing.assert_array_equal(joints, walk())
    (note,) = notes
    assert re.search("4 frames .*walk", note)


def test_joints_in_another_order_are_noticed():
    check_bones(walk(), "walk")
    with pytest.raises(InputError, match="not those"):
        check_bones(walk()[:, np.random.default_rng(0).permutation(22)], "walk")
