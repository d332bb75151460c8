"""The course of a motion does not depend on how long people rest before and after it."""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.course_features import course_features
from mmweaver.recognition.point_recordings import PointRecording


def raised_arm(before: int, after: int, *, back: bool = False) -> PointRecording:
    """A hand that rises by 0.8 m in 12 frames, first nearer and then away; a body that hardly moves all the time."""
    frames = before + 12 + after
    hand = np.repeat(np.arange(12), 2)
    share = (11 - hand if back else hand) / 11
    body = np.repeat(np.arange(frames), 3)
    cloud = PointCloud(
        frame=np.concatenate([before + hand, body]), x_m=np.concatenate([np.full(24, 0.3), np.zeros(len(body))]),
        y_m=np.concatenate([2.0 - 0.4 * np.sin(np.pi * share), np.full(len(body), 2.0)]),
        z_m=np.concatenate([0.8 * share - 0.4, np.tile([-0.1, 0.0, 0.1], frames)]),
        radial_velocity_mps=np.concatenate([np.where(share < 0.5, -1.5, 1.5) * (-1 if back else 1),
                                            np.tile([-0.3, 0.3, 0.3], frames)]),
        snr_db=np.zeros(24 + len(body)),
    )  # fmt: skip
    order = np.argsort(cloud.frame, kind="stable")
    return PointRecording(name="", cloud=cloud.select(order), num_frames=frames, frame_rate_hz=10.0)


def test_rests_change_little():
    brief, long = course_features(raised_arm(2, 2)), course_features(raised_arm(14, 20))
    for name in ("course_up_1", "course_up_4", "course_velocity_1", "course_velocity_4", "course_lasts"):
        assert np.isclose(brief[name], long[name], atol=0.12), name
    assert 1.0 < long["course_lasts"] < 1.5


def test_the_order_of_heights_and_velocities_is_seen():
    up, down = course_features(raised_arm(3, 3)), course_features(raised_arm(3, 3, back=True))
    assert up["course_up_0"] < -0.2 < 0.2 < up["course_up_5"]
    assert down["course_up_0"] > 0.2 > -0.2 > down["course_up_5"]
    assert up["course_velocity_1"] < -1 < 1 < up["course_velocity_4"]
    assert np.isclose(up["course_fastest_away"], 1.5)


def test_without_motion_all_are_unknown_and_have_the_same_names():
    window = raised_arm(1, 1)
    still = replace(window, cloud=replace(window.cloud, radial_velocity_mps=np.zeros(len(window.cloud.frame))))
    found = course_features(still)
    assert set(found) == set(course_features(window))
    assert all(np.isnan(value) for value in found.values())
