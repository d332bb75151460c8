"""Mean maps against the mean of many signals of drawn phases."""

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.propagation.mean_power import MeanPower
from mmweaver.signal.point_response import Points
from mmweaver.signal.spectra import (
    azimuth_axis_rad,
    elevation_axis_rad,
    range_azimuth_power,
    range_doppler_power,
    range_elevation_power,
)


def test_they_are_the_mean_over_drawn_phases():
    radar = MeanPower(AWR1843)
    rng = np.random.default_rng(3)
    count, draws = 12, 1000
    places = [rng.uniform(20, 75, count), rng.uniform(-12, 12, count)]
    direction = np.column_stack([rng.uniform(-0.7, 0.7, count), rng.uniform(-0.3, 0.3, count)])
    strength = rng.uniform(0.3, 1.0, count)

    def points(phase: np.ndarray) -> Points:
        draws = len(phase)
        each = [torch.tensor(np.tile(place, (draws, 1)), dtype=torch.float32) for place in places]
        return Points(
            range_bin=each[0], doppler_bin=each[1],
            direction=torch.tensor(np.tile(direction, (draws, 1, 1)), dtype=torch.float32),
            amplitude=torch.tensor(strength * np.exp(2j * np.pi * phase), dtype=torch.complex64),
        )  # fmt: skip

    mean = radar.maps(points(np.zeros((1, count))))
    total = [0.0, 0.0, 0.0]
    for _ in range(10):
        drawn = points(rng.random((draws // 10, count)))
        values = (radar.response.render(drawn, radar.axes) * radar.response.phasor(radar.axes)).numpy()
        cube = RadarCube(values=values, grid=CubeGrid.of(AWR1843, len(values)), config=AWR1843, scale=1.0)
        maps = (
            range_doppler_power(cube), range_azimuth_power(cube, azimuth_axis_rad()),
            range_elevation_power(cube, elevation_axis_rad()),
        )  # fmt: skip
        total = [sum_ + each.mean(axis=0) / 10 for sum_, each in zip(total, maps, strict=True)]
    for name, truth in zip(("range_doppler", "range_azimuth", "range_elevation"), total, strict=True):
        found = getattr(mean, name)[0].numpy()
        strong = truth > 1e-2 * truth.max()
        assert np.abs(10 * np.log10(found[strong] / truth[strong])).mean() < 0.35, name


def test_noise_is_what_a_noisy_cube_holds():
    from mmweaver.core.records import AdcCube
    from mmweaver.signal.cube import radar_cube

    rng = np.random.default_rng(0)
    shape = (4, AWR1843.num_loops, AWR1843.num_tx, AWR1843.num_rx, AWR1843.num_samples)
    samples = rng.standard_normal((*shape, 2)).astype(np.float32).view(np.complex64)[..., 0]
    samples *= np.float32(np.sqrt(AWR1843.noise_power_mw / 2))
    cube = radar_cube(AdcCube(samples=samples, config=AWR1843, scale=1.0))
    doppler, azimuth, elevation = MeanPower(AWR1843).noise_maps()
    assert range_doppler_power(cube).mean() == pytest.approx(doppler, rel=0.02)
    assert range_azimuth_power(cube, azimuth_axis_rad()).mean() == pytest.approx(azimuth, rel=0.02)
    assert range_elevation_power(cube, elevation_axis_rad()).mean() == pytest.approx(elevation, rel=0.02)
