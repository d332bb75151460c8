"""Errors of skeletons: what an alignment removes is gone, and nothing else."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import joint
from mmweaver.evaluation.pose_errors import GROUPS, SCORED, joint_errors_cm

TRUE_M = stream(0, "skeletons").normal(size=(5, 22, 3))
SHIFT_M = np.array([1.0, 2.0, 3.0])


def test_each_alignment_removes_its_own():
    turned = 1.3 * TRUE_M @ Rotation.from_euler("xyz", [20, 50, -30], degrees=True).as_matrix() + SHIFT_M
    assert joint_errors_cm(turned, TRUE_M, "procrustes")["all"] < 1e-9
    assert joint_errors_cm(turned, TRUE_M, "centroid")["all"] > 10
    for alignment in ("root", "centroid", "procrustes"):
        assert joint_errors_cm(TRUE_M + SHIFT_M, TRUE_M, alignment)["all"] == pytest.approx(0, abs=1e-6)
    mirrored = TRUE_M * [-1, 1, 1]
    assert joint_errors_cm(mirrored, TRUE_M, "procrustes")["all"] > 10  # no reflection makes left right


def test_groups_and_frames_without_truth():
    wrong, known = TRUE_M.copy(), TRUE_M.copy()
    wrong[:, joint("left_wrist"), 2] += 0.4
    known[2] = np.nan
    found = joint_errors_cm(wrong, known, "root")
    assert found["arms"] == pytest.approx(10)
    assert found["legs"] == found["head"] == found["torso"] == 0
    assert found["all"] == pytest.approx(40 / len(SCORED))
    assert sorted(len(names) for names in GROUPS.values()) == [2, 4, 6, 6]
