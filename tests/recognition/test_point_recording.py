"""Recordings split into windows."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recording import PointRecording


def recording(frames: list[int], num_frames: int = 10) -> PointRecording:
    values = np.arange(len(frames), dtype=float)
    cloud = PointCloud(
        frame=np.array(frames), x_m=values, y_m=values, z_m=values, radial_velocity_mps=values, snr_db=values
    )
    return PointRecording(name="one", cloud=cloud, num_frames=num_frames, frame_rate_hz=2.0, label="walk")


def test_windows_are_consecutive_and_renumbered():
    windows = recording([0, 3, 3, 4, 9]).windows(2.0)
    assert [window.cloud.frame.tolist() for window in windows] == [[0, 3, 3], [0]]
    assert [window.cloud.x_m.tolist() for window in windows] == [[0.0, 1.0, 2.0], [3.0]]
    assert all(window.num_frames == 4 and window.label == "walk" for window in windows)


def test_windows_may_overlap():
    assert len(recording([0]).windows(2.0, step_s=1.0)) == 4


def test_a_short_recording_has_no_window():
    assert recording([0], num_frames=3).windows(2.0) == []
    assert recording([0]).duration_s == 5.0


def test_points_are_selected_by_mask():
    cloud = recording([0, 1, 2]).cloud
    assert cloud.select(cloud.frame > 0).y_m.tolist() == [1.0, 2.0]
