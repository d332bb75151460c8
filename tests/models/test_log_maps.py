"""The networks' maps are those of signal.spectra, in other units."""

from dataclasses import replace

import numpy as np
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.models.frame_motion import MIDDLE_DB, NUM_AZIMUTHS, SPREAD_DB, WIDEST_DEG, LogMaps
from mmweaver.signal.spectra import range_azimuth_power, range_doppler_power


def _cube(scale: float) -> RadarCube:
    grid = CubeGrid.of(AWR1843, 2)
    rng = np.random.default_rng(0)
    values = scale * (rng.standard_normal(grid.shape) + 1j * rng.standard_normal(grid.shape))
    return RadarCube(values=values.astype(np.complex64), grid=grid, config=AWR1843, scale=1.0)


def test_they_are_the_spectra_above_the_noise():
    maps, cube = LogMaps(AWR1843), _cube(1e-3)
    doppler, angle = maps(torch.from_numpy(cube.values))
    azimuth = np.deg2rad(np.linspace(-WIDEST_DEG, WIDEST_DEG, NUM_AZIMUTHS))
    noise = maps.noise_mw
    for made, power, level in (
        (doppler[:, 0], range_doppler_power(cube), noise),
        (angle[:, 0], range_azimuth_power(cube, azimuth), noise * 32 / 8),
        (angle[:, 1], range_azimuth_power(cube, azimuth, moving_only=True), noise * 32 / 8),
    ):
        assert np.allclose(made * SPREAD_DB + MIDDLE_DB, 10 * np.log10(power / level + 1), atol=1e-3)


def test_loudness_stays_visible():
    cube = _cube(1e-3)
    louder = replace(cube, values=10 * cube.values)
    one, ten = (LogMaps(AWR1843)(torch.from_numpy(each.values))[0].mean() for each in (cube, louder))
    assert float(ten - one) * SPREAD_DB > 19


def test_zeros_are_the_lowest_and_have_a_slope():
    zeros = torch.zeros(AWR1843.num_range_bins, 32, 12, dtype=torch.complex64, requires_grad=True)
    doppler, angle = LogMaps(AWR1843)(zeros)
    assert torch.allclose(doppler, torch.tensor(-MIDDLE_DB / SPREAD_DB))
    (doppler.sum() + angle.sum()).backward()
    assert zeros.grad is not None
    assert torch.isfinite(torch.view_as_real(zeros.grad)).all()
