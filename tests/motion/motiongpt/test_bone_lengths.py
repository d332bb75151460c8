"""Bones that stretch get one length; what was steady stays as it is."""

import numpy as np
from mocap_files import walk

from mmweaver.core.skeleton import BONES
from mmweaver.motion.motiongpt.motiongpt import fix_bone_lengths


def test_stretching_goes_and_directions_stay():
    joints = walk()
    noisy = joints + np.random.default_rng(0).normal(0, 0.01, joints.shape)
    steady = fix_bone_lengths(noisy)
    for parent, child in BONES:
        length = np.linalg.norm(steady[:, child] - steady[:, parent], axis=-1)
        assert np.ptp(length) < 1e-9
        along = np.sum((steady - noisy)[:, child] - (steady - noisy)[:, parent], axis=-1)
        assert np.isfinite(along).all()
    assert np.abs(steady[..., 2].min(axis=1) - noisy[..., 2].min(axis=1)).max() < 1e-9
    assert np.linalg.norm(steady - joints, axis=-1).mean() < 0.03


def test_a_body_of_steady_bones_is_left_alone():
    np.testing.assert_allclose(fix_bone_lengths(walk()), walk(), atol=1e-9)
