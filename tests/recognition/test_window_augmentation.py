"""Copies are other performances of the same motion, or what worse boards report: what was varied is recovered."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.window_augmentation import PerformanceVariation, WindowAugmentation, augmented, varied
from tests.recognition.clouds import RADAR, recording_of

STEP_MPS, LARGEST_MPS, FRAMES = 0.25, 2.0, 40
COARSE = replace(RADAR, velocity_step_mps=STEP_MPS, max_velocity_mps=LARGEST_MPS)
AS_IT_WAS = PerformanceVariation(
    tempo=0.0, size=0.0, shift_m=0.0, turn_rad=0.0, cut_share=0.0, most_cut=0.0, hidden_share=0.0
)


def receding() -> PointRecording:
    """Three points per frame ahead of the radar that recede at 1 m/s, with 10 frames per second."""
    frame = np.repeat(np.arange(FRAMES), 3)
    return recording_of(
        frame, y_m=2.0 + 0.1 * frame, z_m=np.tile([-0.1, 0.0, 0.1], FRAMES), velocity_mps=4 * STEP_MPS, snr_db=15.0,
        name="away_0", label="away",
    )  # fmt: skip


def copy_of(how: PerformanceVariation, seed: int = 0, first: int = 5, *, once: bool = False) -> PointRecording:
    rng = np.random.default_rng(seed)
    return varied(receding(), first, 20, rng, COARSE, how, once=once)


@pytest.mark.parametrize("once", [False, True])
def test_without_variation_a_copy_is_the_window(once: bool):
    window, copy = receding().part(5, 20), copy_of(AS_IT_WAS, once=once)
    assert (copy.label, copy.name, copy.num_frames) == (window.label, window.name, 20)
    for name in ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db"):
        assert np.allclose(getattr(copy.cloud, name), getattr(window.cloud, name), atol=1e-9)


def test_a_faster_copy_moves_as_fast_as_its_velocity_says():
    for seed in range(10):
        copy = copy_of(replace(AS_IT_WAS, **{"tempo": 0.3}), seed).cloud
        velocity = copy.radial_velocity_mps[0]
        assert np.array_equal(np.unique(copy.frame), np.arange(20))
        assert np.isclose(velocity / STEP_MPS, round(velocity / STEP_MPS))
        moved_mps = 10 * np.polyfit(copy.frame, copy.y_m, 1)[0]
        assert np.isclose(moved_mps, velocity, atol=STEP_MPS / 2 + 0.05)


def test_a_wider_copy_is_wider_and_folds_where_the_radar_does():
    copy = copy_of(replace(AS_IT_WAS, **{"size": 3.0}), seed=1).cloud
    size = np.ptp(copy.y_m) / np.ptp(receding().part(5, 20).cloud.y_m)
    expected = (size * 1.0 + LARGEST_MPS) % (2 * LARGEST_MPS) - LARGEST_MPS
    assert size > 1.5
    assert np.abs(copy.radial_velocity_mps).max() <= LARGEST_MPS
    assert np.isclose(copy.radial_velocity_mps[0], expected, atol=STEP_MPS / 2 + 1e-9)


def test_a_copy_elsewhere_has_the_same_motion():
    copy = copy_of(replace(AS_IT_WAS, **{"shift_m": 0.5, "turn_rad": 0.5}), seed=2).cloud
    window = receding().part(5, 20).cloud
    farther_m = np.linalg.norm([copy.x_m, copy.y_m, copy.z_m], axis=0) - np.hypot(window.y_m, window.z_m)
    assert 0.01 < abs(farther_m[0]) <= 0.5
    assert np.allclose(farther_m, farther_m[0])
    assert np.ptp(np.arctan2(copy.x_m, copy.y_m)) < 1e-9 < abs(copy.x_m[0])


def test_single_performances_may_lack_their_beginning_or_end_and_what_goes_on_does_not():
    how = replace(AS_IT_WAS, **{"cut_share": 1.0, "most_cut": 0.5})
    lasts = [int(copy_of(how, seed, once=True).cloud.frame[-1]) + 1 for seed in range(20)]
    assert min(lasts) < 15 < max(lasts) <= 20
    assert all(copy_of(how, seed, once=True).cloud.frame[0] == 0 for seed in range(20))
    assert len(copy_of(how, once=False).cloud.frame) == 60


LONG = 60


def window() -> PointRecording:
    frame = np.repeat(np.arange(LONG), 4)
    velocity = np.tile([0.0, 0.0, 0.615, 1.845], LONG)
    return recording_of(
        frame, x_m=0.1, y_m=2.0 + 0.005 * frame, velocity_mps=velocity, snr_db=15.0, rate_hz=30.0, label="walk"
    )


NOTHING = WindowAugmentation(
    least_moving=1.0, least_static=1.0, frames_lost=0.0, slow_to_static=0.0, most_objects=0, false_points=0.0,
    tilt_rad=0.0,
)  # fmt: skip


def test_with_zero_limits_only_time_and_sides_are_reversed():
    seen = set()
    for seed in range(12):
        cloud = augmented(window(), np.random.default_rng(seed), NOTHING).cloud
        backwards, mirrored = cloud.radial_velocity_mps.max() == 0, cloud.x_m.max() < 0
        seen.add((bool(backwards), bool(mirrored)))
        # what goes away, played backwards, comes nearer: range and velocity still agree
        slope = np.polyfit(cloud.frame, cloud.y_m, 1)[0]
        assert np.isclose(slope, -0.005 if backwards else 0.005)
        assert len(cloud.frame) == 4 * LONG
    assert len(seen) == 4


def test_points_are_dropped_and_added_within_limits():
    counts = []
    for seed in range(40):
        copy = augmented(window(), np.random.default_rng(seed))
        cloud = copy.cloud
        assert (np.diff(cloud.frame) >= 0).all()
        assert cloud.frame.min() >= 0
        assert cloud.frame.max() < LONG
        assert copy.label == "walk"
        counts.append(int((np.abs(cloud.radial_velocity_mps) > 1.5).sum()))
    assert min(counts) < 0.5 * LONG
    assert max(counts) > 0.9 * LONG
