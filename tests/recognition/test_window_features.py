"""Features distinguish motions and ignore static points; nearly stationary bodies are known by place and rhythm."""

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.recogniser import recognition_features, window_row
from mmweaver.recognition.window_features import window_features
from tests.recognition.clouds import recording_of

RATE_HZ, FRAMES = 30.0, 60


def swinging(rate_hz: float = 1.0, across_m: float = 0.0, still: int = 0, mirrored: bool = False) -> PointRecording:
    """A body whose velocity oscillates, two points per frame, and static points of a room."""
    frame = np.repeat(np.arange(FRAMES), 2 + still)
    body = np.tile(np.arange(2 + still) < 2, FRAMES)
    velocity = np.where(body, np.rint(3 * np.sin(2 * np.pi * rate_hz * frame / RATE_HZ)) * 0.615, 0.0)
    x = np.where(body, across_m + 0.2 * np.sin(2.3 * frame), 1.5) * (-1 if mirrored else 1)
    return recording_of(
        frame, x_m=x, y_m=np.where(body, 2.0, 4.0), z_m=np.where(body, 0.1 * (frame % 3), 0.5), velocity_mps=velocity,
        rate_hz=RATE_HZ, num_frames=FRAMES,
    )  # fmt: skip


def test_rhythm_shows_in_its_band():
    for rate_hz in (1.0, 1.5, 2.5):
        assert abs(window_features(swinging(rate_hz))["momentum_top_hz"] - rate_hz) < 0.2


def test_static_points_are_ignored():
    one, other = window_features(swinging()), window_features(swinging(still=7))
    for name, value in one.items():
        assert np.isclose(value, other[name], equal_nan=True), name


def test_left_and_right_are_alike():
    one, other = window_features(swinging()), window_features(swinging(mirrored=True))
    for name, value in one.items():
        assert np.isclose(value, other[name], equal_nan=True), name


def test_speeds_are_counted_by_direction():
    row = window_features(swinging())
    assert row["share_away_0"] > 0.05
    assert abs(row["share_away_2"] - row["share_near_2"]) < 0.15
    assert row["balance"] < 0.2


def test_an_empty_window_has_the_same_features_without_values():
    empty = recording_of([], num_frames=FRAMES, rate_hz=RATE_HZ)
    names = tuple(window_row(swinging()))
    matrix = recognition_features([empty, swinging()], names)
    assert set(window_row(empty)) == set(names)
    assert matrix.shape == (2, len(names))
    assert matrix[0, names.index("rate")] == 0
    assert np.isnan(matrix[0, names.index("momentum_top_hz")])
    assert np.isfinite(matrix[1]).sum() > 90
