"""cube -> ADC -> .bin -> our reader -> the same cube, as well as 16 bits allow."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, HUPR, MMMESH
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.core.seeding import stream
from mmweaver.io.dca1000 import read_bin, write_bin
from mmweaver.signal.cube import adc_from_cube, radar_cube


def scene_cube(config: RadarConfig) -> RadarCube:
    """Twenty tones in range, Doppler and antenna phase between the bins, and noise 60 dB below the strongest."""
    draw = stream(0, "test round trip", config.name)
    shape = (1, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    samples = 1e-3 * (draw.standard_normal(shape) + 1j * draw.standard_normal(shape))
    fast, slow = np.arange(config.num_samples), np.arange(config.num_loops)
    for _ in range(20):
        row = config.first_range_bin + draw.uniform(2, config.num_range_bins - 2)
        beat = np.exp(2j * np.pi * row / config.num_samples * fast)
        doppler = np.exp(2j * np.pi * draw.uniform(-0.5, 0.5) * slow)
        antenna = draw.exponential() * np.exp(2j * np.pi * draw.random((config.num_tx, config.num_rx)))
        samples += np.einsum("l,tr,s->ltrs", doppler, antenna, beat)
    return radar_cube(AdcCube(samples=samples.astype(np.complex64), config=config, scale=1.0))


@pytest.mark.parametrize("iq_order", ["iq", "qi"])
@pytest.mark.parametrize("config", [AWR1843, replace(AWR1843, tx_order=(2, 0, 1)), MMMESH, HUPR])
def test_cube_to_bin_to_cube(tmp_path: Path, config: RadarConfig, iq_order: str):
    cube = scene_cube(config)
    counts = write_bin(tmp_path / "adc_data.bin", adc_from_cube(cube), iq_order=iq_order)
    read = read_bin(tmp_path / "adc_data.bin", config, iq_order=iq_order)
    again = radar_cube(read).values / counts
    error = again - cube.values
    assert np.linalg.norm(error) < 10 ** (-60 / 20) * np.linalg.norm(cube.values)
    # a word's rounding error of variance 1/12 in I and in Q, through windows that keep 1.5 / N of white noise
    expected = np.sqrt(2 / 12 * 1.5 / config.num_samples * 1.5 / config.num_loops) / counts
    assert np.sqrt(np.mean(np.abs(error) ** 2)) == pytest.approx(expected, rel=0.1)
