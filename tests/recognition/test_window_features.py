"""Features distinguish motions and ignore static points; nearly stationary bodies are known by place and rhythm."""

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.recogniser import recognition_features, window_row
from mmweaver.recognition.window_features import BANDS_HZ, body_features, window_features
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


def resting(range_m: np.ndarray, shown: np.ndarray, wall_m: float | None = None) -> PointRecording:
    """A static spot at `range_m` in the frames `shown`, and optionally a permanent wall."""
    frame, distance_m = np.flatnonzero(shown), range_m[shown]
    if wall_m is not None:
        frame = np.concatenate([frame, np.arange(FRAMES)])
        distance_m = np.concatenate([distance_m, np.full(FRAMES, wall_m)])
    return recording_of(frame, y_m=distance_m, num_frames=FRAMES, rate_hz=RATE_HZ)


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
    alone = body_features(resting(wandering, np.zeros(FRAMES, bool), wall_m=2.6))
    assert alone["rest_rate"] == alone["body_segments"] == 0
