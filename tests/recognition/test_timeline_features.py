"""What happens first and what last, whatever the place of the radar."""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.timeline_features import timeline_features


def arm(*, rising: bool, shift_m: float = 0.0) -> PointRecording:
    frame = np.repeat(np.arange(20), 3)
    share = frame / 19 if rising else 1 - frame / 19
    cloud = PointCloud(
        frame=frame, x_m=np.full(60, 0.2 + shift_m), y_m=2.0 + 0.1 * share, z_m=0.5 * share + shift_m,
        radial_velocity_mps=np.where(share < 0.5, -0.4, 0.4), snr_db=np.zeros(60),
    )  # fmt: skip
    return PointRecording(name="", cloud=cloud, num_frames=20, frame_rate_hz=10.0)


def test_up_and_down_differ_in_their_order():
    up, down = timeline_features(arm(rising=True)), timeline_features(arm(rising=False))
    assert up["order_up_0"] < 0 < up["order_up_5"]
    assert down["order_up_0"] > 0 > down["order_up_5"]
    assert up["order_away_less_near"] > 0.3 > -0.3 > down["order_away_less_near"]
    assert up["turns"] == 1


def test_the_place_of_the_radar_does_not_matter_sideways_and_up():
    here, there = timeline_features(arm(rising=True)), timeline_features(arm(rising=True, shift_m=0.4))
    for name in ("order_up_0", "order_aside_3", "reach_up_above", "fast_up", "order_lasts"):
        assert np.isclose(here[name], there[name], atol=1e-6)


def test_without_motion_all_are_unknown_and_have_the_same_names():
    window = arm(rising=True)
    still = replace(window, cloud=replace(window.cloud, radial_velocity_mps=np.zeros(60)))
    found = timeline_features(still)
    assert set(found) == set(timeline_features(window))
    assert all(np.isnan(value) for value in found.values())
