"""Copies are other performances of the same motion: what was varied is recovered from their points."""

import numpy as np
import pytest

from mmweaver.core.records import PointCloud
from mmweaver.recognition.performance_variation import PerformanceVariation, varied
from mmweaver.recognition.point_recordings import PointRecording

STEP_MPS, LARGEST_MPS, FRAMES = 0.25, 2.0, 40
AS_IT_WAS = PerformanceVariation(
    tempo=0.0, size=0.0, shift_m=0.0, turn_rad=0.0, cut_share=0.0, most_cut=0.0, hidden_share=0.0
)


def receding() -> PointRecording:
    """Three points a frame ahead of the radar that recede at 1 m/s, with 10 frames a second."""
    frame = np.repeat(np.arange(FRAMES), 3)
    cloud = PointCloud(
        frame=frame, x_m=np.zeros(len(frame)), y_m=2.0 + 0.1 * frame, z_m=np.tile([-0.1, 0.0, 0.1], FRAMES),
        radial_velocity_mps=np.full(len(frame), 4 * STEP_MPS), snr_db=np.full(len(frame), 15.0),
    )  # fmt: skip
    return PointRecording(name="away_0", cloud=cloud, num_frames=FRAMES, frame_rate_hz=10.0, label="away")


def copy_of(how: PerformanceVariation, seed: int = 0, first: int = 5, *, once: bool = False) -> PointRecording:
    rng = np.random.default_rng(seed)
    return varied(receding(), first, 20, rng, STEP_MPS, LARGEST_MPS, how, once=once)


@pytest.mark.parametrize("once", [False, True])
def test_without_variation_a_copy_is_the_window(once: bool):
    window, copy = receding().part(5, 20), copy_of(AS_IT_WAS, once=once)
    assert (copy.label, copy.name, copy.num_frames) == (window.label, window.name, 20)
    for name in ("frame", "x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db"):
        assert np.allclose(getattr(copy.cloud, name), getattr(window.cloud, name), atol=1e-9)


def test_a_faster_copy_moves_as_fast_as_its_velocity_says():
    for seed in range(10):
        copy = copy_of(PerformanceVariation(**{**vars(AS_IT_WAS), "tempo": 0.3}), seed).cloud
        velocity = copy.radial_velocity_mps[0]
        assert np.array_equal(np.unique(copy.frame), np.arange(20))
        assert np.isclose(velocity / STEP_MPS, round(velocity / STEP_MPS))
        moved_mps = 10 * np.polyfit(copy.frame, copy.y_m, 1)[0]
        assert np.isclose(moved_mps, velocity, atol=STEP_MPS / 2 + 0.05)


def test_a_wider_copy_is_wider_and_folds_where_the_radar_does():
    copy = copy_of(PerformanceVariation(**{**vars(AS_IT_WAS), "size": 3.0}), seed=1).cloud
    size = np.ptp(copy.y_m) / np.ptp(receding().part(5, 20).cloud.y_m)
    expected = (size * 1.0 + LARGEST_MPS) % (2 * LARGEST_MPS) - LARGEST_MPS
    assert size > 1.5
    assert np.abs(copy.radial_velocity_mps).max() <= LARGEST_MPS
    assert np.isclose(copy.radial_velocity_mps[0], expected, atol=STEP_MPS / 2 + 1e-9)


def test_a_copy_elsewhere_has_the_same_motion():
    copy = copy_of(PerformanceVariation(**{**vars(AS_IT_WAS), "shift_m": 0.5, "turn_rad": 0.5}), seed=2).cloud
    window = receding().part(5, 20).cloud
    farther_m = np.linalg.norm([copy.x_m, copy.y_m, copy.z_m], axis=0) - np.hypot(window.y_m, window.z_m)
    assert 0.01 < abs(farther_m[0]) <= 0.5
    assert np.allclose(farther_m, farther_m[0])
    assert np.ptp(np.arctan2(copy.x_m, copy.y_m)) < 1e-9 < abs(copy.x_m[0])


def test_single_performances_may_lack_their_beginning_or_end_and_what_goes_on_does_not():
    how = PerformanceVariation(**{**vars(AS_IT_WAS), "cut_share": 1.0, "most_cut": 0.5})
    lasts = [int(copy_of(how, seed, once=True).cloud.frame[-1]) + 1 for seed in range(20)]
    assert min(lasts) < 15 < max(lasts) <= 20
    assert all(copy_of(how, seed, once=True).cloud.frame[0] == 0 for seed in range(20))
    assert len(copy_of(how, once=False).cloud.frame) == 60


def test_a_hidden_part_leaves_the_rest():
    how = PerformanceVariation(**{**vars(AS_IT_WAS), "hidden_share": 1.0})
    counts = [len(copy_of(how, seed).cloud.frame) for seed in range(20)]
    assert 20 <= min(counts) < 55


def test_an_empty_window_stays_empty():
    nobody = receding().part(5, 20)
    nobody = PointRecording(
        name="", cloud=nobody.cloud.select(np.zeros(60, bool)), num_frames=20, frame_rate_hz=10.0, label="empty"
    )
    for once in (False, True):
        rng = np.random.default_rng(0)
        copy = varied(nobody, 0, 20, rng, STEP_MPS, LARGEST_MPS, PerformanceVariation(), once=once)
        assert (len(copy.cloud.frame), copy.num_frames) == (0, 20)
