"""A motion at radar frames: as long a history as there is, and no longer."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.skeleton import joint
from mmweaver.models.frame_motion import HISTORY_FRAMES, FrameMotion
from tests.rooms import standing_person

PERIOD_S = AWR1843.frame_period_s
PELVIS = joint("pelvis")


@pytest.mark.parametrize(
    ("begin_s", "first_frame", "history"),
    [(0.0, 0, 0), (0.0, 3, 3), (0.0, 40, HISTORY_FRAMES), (0.55 * PERIOD_S, 8, 7), (5 * PERIOD_S, 8, 3)],
)
def test_history_begins_where_the_motion_is_known(begin_s: float, first_frame: int, history: int):
    pose = standing_person((0.0, 2.0, -1.2), (0.0, 0.5, 0.0), seconds=60 * PERIOD_S)
    known = pose.time_s >= begin_s
    pose = replace(pose, time_s=pose.time_s[known], joints_m=pose.joints_m[known])
    motion = FrameMotion.of(pose, AWR1843, 4, first_frame)
    assert motion.num_before == history
    per_frame = len(motion.joints_m) // (history + 4)
    at_m = motion.joints_m[::per_frame, PELVIS, 1]
    assert len(at_m) == history + 4
    step_m = 0.5 * PERIOD_S
    assert np.diff(at_m) == pytest.approx(np.full(history + 3, step_m), rel=0.02)
    assert at_m[history] == pytest.approx(2.0 + 0.5 * first_frame * PERIOD_S, abs=step_m)
    assert motion.velocity_mps[:, PELVIS, 1] == pytest.approx(0.5, rel=0.02)
