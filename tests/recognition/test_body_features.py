"""Nearly stationary bodies are distinguished by position and rhythm."""

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.recognition.body_features import BANDS_HZ, body_features, body_points
from mmweaver.recognition.point_recordings import PointRecording

RATE_HZ, FRAMES = 30.0, 60


def resting(range_m: np.ndarray, shown: np.ndarray, wall_m: float | None = None) -> PointRecording:
    """A static spot at `range_m` in the frames `shown`, and optionally a permanent wall."""
    frame, distance_m = np.flatnonzero(shown), range_m[shown]
    if wall_m is not None:
        frame = np.concatenate([frame, np.arange(FRAMES)])
        distance_m = np.concatenate([distance_m, np.full(FRAMES, wall_m)])
    order = np.argsort(frame, kind="stable")
    frame, distance_m = frame[order], distance_m[order]
    zero = np.zeros(len(frame))
    cloud = PointCloud(
        frame=frame, x_m=zero, y_m=distance_m, z_m=zero, radial_velocity_mps=zero, snr_db=np.full(len(frame), 15.0)
    )
    return PointRecording(name="one", cloud=cloud, num_frames=FRAMES, frame_rate_hz=RATE_HZ)


TIME_S = np.arange(FRAMES) / RATE_HZ
ALWAYS = np.ones(FRAMES, bool)


def test_a_flickering_spot_has_power_in_its_band():
    for rate_hz in (1.0, 2.0, 4.0):
        shown = np.sin(2 * np.pi * rate_hz * TIME_S + 0.3) > 0
        row = body_features(resting(np.full(FRAMES, 2.0), shown))
        shares = [row[f"flicker_together_{low:g}_hz"] for low, _ in BANDS_HZ]
        low, high = BANDS_HZ[int(np.argmax(shares))]
        assert low <= rate_hz < high


def test_a_spot_that_returns_has_a_span_and_no_displacement():
    there_and_back = body_features(resting(2.0 + 0.2 * np.sin(np.pi * TIME_S / 2), ALWAYS))
    away = body_features(resting(1.5 + 0.3 * TIME_S, ALWAYS))
    assert abs(there_and_back["body_middle_span"] - 0.18) < 0.05
    assert there_and_back["body_way"] < 0.05
    assert abs(away["body_way"] - 0.3 * 2 * 7 / 8) < 0.05


def test_a_wall_does_not_count_as_body():
    wandering = 2.0 + 0.2 * np.sin(np.pi * TIME_S)
    without = body_features(resting(wandering, ALWAYS))
    with_wall = body_features(resting(wandering, ALWAYS, wall_m=2.6))
    for name, value in without.items():
        assert np.isclose(value, with_wall[name], equal_nan=True), name
    assert not body_points(resting(wandering, np.zeros(FRAMES, bool), wall_m=2.6)).is_static.any()
