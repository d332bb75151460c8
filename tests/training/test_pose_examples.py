"""Windows of points with joints: disturbances move both alike, and what is far from the person is left out."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.models.point_frames import MAX_POINTS, middle_m, near, point_frames
from mmweaver.recognition.train_pose import posed_frames
from mmweaver.training.pose_training import Disturbance, disturbed
from tests.training.moving_arm import moving_arm

STILL = Disturbance(
    mirrored=0.0,
    backwards=0.0,
    shift_m=(0.0, 0.0, 0.0),
    tilt_deg=0.0,
    point_m=0.0,
    strength_db=0.0,
    thinned=0.0,
    with_gaps=0.0,
)


def test_points_follow_the_joints():
    """A point lies at every joint: so it does after a shift, in a mirror, and backwards in time."""
    one = posed_frames(moving_arm(0))
    cloud = moving_arm(0).cloud
    assert one.frames.is_there.sum() == len(cloud.frame)
    for how in ({"mirrored": 1.0}, {"backwards": 1.0}, {"shift_m": (0.3, 0.2, 0.1)}):
        frames, joints = disturbed(
            one.frames, one.joints_m, Disturbance(**{**vars(STILL), **how}), np.random.default_rng(1)
        )
        for frame in (0, 15):
            points = frames.values[frame][frames.is_there[frame]][:, :3]
            away = np.linalg.norm(points[:, None] - joints[frame][None], axis=-1)
            assert away.min(axis=0).max() < 0.12
    assert frames.values[..., 3].max() == pytest.approx(0.3)
    how = Disturbance(**{**vars(STILL), "mirrored": 1.0})
    _, mirrored_m = disturbed(one.frames, one.joints_m, how, np.random.default_rng(1))
    reach = mirrored_m[15] - mirrored_m[0]
    assert abs(reach[joint("right_wrist"), 2]) > 0.9 > abs(reach[joint("left_wrist"), 2])


def test_the_wall_is_no_part_of_the_person():
    frames = point_frames(moving_arm(0).cloud, 45)
    assert frames.values.shape == (45, MAX_POINTS, 5)
    assert not frames.is_there[40:].any()
    middle = middle_m(frames)
    assert middle[1] == pytest.approx(2.0, abs=0.3)
    assert near(frames, middle).is_there.sum(axis=1)[:40].tolist() == [22] * 40
