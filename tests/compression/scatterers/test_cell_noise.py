"""Noise sampled in cells against noise through the radar's own processing."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression.scatterers.layers import cell_noise, overlapping_noise
from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.windows import hann

EVERY_BIN = replace(AWR1843, num_samples=64, first_range_bin=0, num_range_bins=64)


def alike(values: np.ndarray, axis: int, step: int) -> float:
    """Correlation of neighbouring cells, without the phase rotation due to the start of the frame."""
    return float(np.abs(np.mean(values * np.roll(values, step, axis).conj())) / np.mean(np.abs(values) ** 2))


@pytest.mark.parametrize("config", [AWR1843, EVERY_BIN])
def test_cell_noise_has_the_statistics_of_processed_white_samples(config: RadarConfig):
    rng = np.random.default_rng(0)
    shape = (6, config.num_loops, config.num_tx, config.num_rx, config.num_samples, 2)
    samples = rng.standard_normal(shape, dtype=np.float32).view(np.complex64)[..., 0]
    wanted = radar_cube(AdcCube(samples=samples, config=config, scale=1.0), compensate_tdm=False).values
    got = cell_noise(np.random.default_rng(1), config, 6)
    assert got.shape == wanted.shape
    assert np.mean(np.abs(got) ** 2) == pytest.approx(1.0, rel=0.02)
    assert np.abs(np.mean(got**2)) < 0.02  # both parts alike and apart
    for axis in (0, 1, 2, 3):
        for step in (1, 2, 3):
            assert alike(got, axis, step) == pytest.approx(alike(wanted, axis, step), abs=0.02), (axis, step)


def test_overlapping_frames_share_chirps():
    hop, num_loops = AWR1843.num_loops // 4, AWR1843.num_loops
    got = overlapping_noise(np.random.default_rng(0), AWR1843, 8, hop)
    assert np.mean(np.abs(got) ** 2) == pytest.approx(1.0, rel=0.05)
    chirps = np.fft.ifft(got, axis=2)[:, :, 1:] / hann(num_loops)[1:, None]  # the window is blind to the first
    assert np.allclose(chirps[:-1, :, hop:], chirps[1:, :, : num_loops - 1 - hop], atol=1e-3 * np.abs(chirps).mean())
