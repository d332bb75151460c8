"""A log of points as the page plays it."""

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.viz.points_playback import point_log_playback


def cloud(frame: list[int], xyz_m: list[tuple[float, float, float]], velocity: list[float], snr_db: list[float]):
    x, y, z = np.array(xyz_m, float).reshape(-1, 3).T
    return PointCloud(
        frame=np.array(frame, int), x_m=x, y_m=y, z_m=z, radial_velocity_mps=np.array(velocity, float),
        snr_db=np.array(snr_db, float),
    )  # fmt: skip


def test_a_point_lies_in_its_cell():
    points = cloud([0, 2], [(1.0, 1.0, 0.0), (0.0, 3.0, 0.0)], [-0.4, 0.0], [20.0, float("nan")])
    shown = point_log_playback(points, 0.05, "board", {})
    low, high = shown.header["range_m"]
    count = shown.arrays["range_azimuth"].shape[1]
    row, column = np.argwhere(shown.arrays["range_azimuth"][0] == 255)[0]
    assert low + (row + 0.5) / count * (high - low) == pytest.approx(np.sqrt(2), abs=(high - low) / count)
    left, right = shown.header["azimuth_rad"]
    columns = shown.arrays["range_azimuth"].shape[2]
    assert left + (column + 0.5) / columns * (right - left) == pytest.approx(np.pi / 4, abs=0.06)
    assert not shown.arrays["range_doppler"][1].any()  # nothing in the frame between
    assert shown.arrays["range_doppler"][2].any()  # a point without SNR shows, too
    assert not shown.arrays["range_doppler_moving"][2].any()  # and one at rest is clutter
    assert shown.header["time_s"] == pytest.approx([0.0, 0.05, 0.1])
