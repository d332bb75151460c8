"""Noise alone has the requested false alarm rate; thresholds are those of the textbooks."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.presets import AWR1843
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.dsp.cfar import CfarCells, ca_cfar, ca_factor, os_cfar, os_factor
from mmweaver.dsp.cube import radar_cube

CFARS = [ca_cfar, os_cfar]
RATES = [1e-2, 1e-3, 1e-4]


def assert_rate(num_fired: int, num_cells: int, rate: float, tolerance: float) -> None:
    """Within four standard deviations of counting (neighbours share training cells: doubled), and a tolerance."""
    expected = num_cells * rate
    assert abs(num_fired - expected) < 4 * np.sqrt(2 * expected) + tolerance * expected


@pytest.mark.parametrize("cfar", CFARS)
@pytest.mark.parametrize("num_looks", [1, 12])
@pytest.mark.parametrize("rate", RATES)
def test_independent_noise_has_the_requested_false_alarm_rate(cfar, num_looks: int, rate: float):
    power = stream(0, "test cfar", num_looks).gamma(num_looks, 3.0, (120, 64, 32))
    cells = CfarCells(guard=(1, 1), training=(4, 3))
    found = cfar(power, false_alarm_rate=rate, num_looks=num_looks, cells=cells, hann_windowed=False)
    assert_rate(int(found.is_detected.sum()), power.size, rate, 0.0)
    assert found.noise_power.mean() == pytest.approx(3.0 * num_looks, rel=0.02)


@pytest.fixture(scope="module")
def noise_cells() -> np.ndarray:
    """Noise of the converters through the whole chain: |cube|^2, (frame, range, doppler, antenna)."""
    draw = stream(0, "test cfar chain")
    samples = draw.standard_normal((60, 32, 3, 4, 256, 2), dtype=np.float32).view(np.complex64)[..., 0]
    return np.abs(radar_cube(AdcCube(samples=samples, config=AWR1843, scale=1.0)).values.astype(np.complex128)) ** 2


@pytest.mark.parametrize("cfar", CFARS)
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize(
    "cells",
    [CfarCells(), pytest.param(CfarCells(guard=(2, 2), training=(6, 4)), marks=pytest.mark.slow)],
    ids=["wide", "narrow"],
)
def test_windowed_noise_of_twelve_antennas_has_the_requested_false_alarm_rate(
    noise_cells, cfar, rate: float, cells: CfarCells
):
    power = noise_cells[: 60 if cfar is ca_cfar else 30].mean(axis=-1)
    found = cfar(power, false_alarm_rate=rate, num_looks=12, cells=cells)
    assert_rate(int(found.is_detected.sum()), power.size, rate, 0.05)


@pytest.mark.parametrize("cfar", CFARS)
@pytest.mark.parametrize("rate", RATES)
def test_windowed_noise_of_one_antenna_has_the_requested_false_alarm_rate(noise_cells, cfar, rate: float):
    some = noise_cells[: 60 if cfar is ca_cfar else 20]  # ordering takes 15 times as long as averaging
    power = np.moveaxis(some[..., [0, 5, 11]], -1, 0).reshape(-1, 64, 32)
    found = cfar(power, false_alarm_rate=rate, num_looks=1)
    assert_rate(int(found.is_detected.sum()), power.size, rate, 0.05)


def test_the_rate_holds_near_the_ends_of_range(noise_cells):
    power = noise_cells.mean(axis=-1)
    found = ca_cfar(power, false_alarm_rate=1e-2, num_looks=12)
    edges = found.is_detected[:, [0, 1, 2, -3, -2, -1]]
    assert_rate(int(edges.sum()), edges.size, 1e-2, 0.05)


@pytest.mark.parametrize("rate", RATES)
def test_one_look_has_the_textbook_thresholds(rate: float):
    num = 24
    assert ca_factor(rate, float(num), 1) == pytest.approx(num * (rate ** (-1 / num) - 1), rel=1e-9)
    rank = 18
    level, factor = os_factor(rate, float(rank), float(num), 1)
    over = factor / level
    product = np.prod([(num - i) / (num - i + over) for i in range(rank)])
    assert product == pytest.approx(rate, rel=1e-3)


@pytest.mark.parametrize("cfar", CFARS)
def test_a_target_is_found_and_scale_does_not_matter(cfar):
    power = stream(0, "test target").gamma(12, 1 / 12, (1, 64, 32))
    power[0, 3, 31] = power[0, 40, 0] = 10.0
    for scale in (1.0, 1e-18, 1e12):
        found = cfar(power * scale, false_alarm_rate=1e-6, num_looks=12, hann_windowed=False)
        assert np.argwhere(found.is_detected).tolist() == [[0, 3, 31], [0, 40, 0]]


def test_training_cells_are_cyclic_in_doppler():
    power = np.ones((1, 32, 16))
    power[0, 16, 0] = 1000.0
    noise = ca_cfar(power, cells=CfarCells(guard=(1, 1), training=(2, 2))).noise_power[0, 16]
    assert noise[[14, 2]] == pytest.approx(1 + 999 / 40)
    assert noise[[0, 1, 15, 8]] == pytest.approx(1.0)


def test_an_ordered_statistic_is_not_masked_by_a_neighbour():
    power = stream(0, "test mask").gamma(12, 1 / 12, (1, 64, 32))
    power[0, 20, 10], power[0, 27, 10] = 5.0, 5000.0
    assert os_cfar(power, num_looks=12).is_detected[0, 20, 10]
    assert not ca_cfar(power, num_looks=12).is_detected[0, 20, 10]


@pytest.mark.parametrize("cfar", CFARS)
def test_impossible_maps_and_rates_are_refused(cfar):
    with pytest.raises(InputError, match="false alarm rate"):
        cfar(np.ones((1, 8, 8)), false_alarm_rate=0.0)
    with pytest.raises(InputError, match="one cell"):
        cfar(np.ones((1, 1, 1)))
    with pytest.raises(InputError, match="too small"):
        cfar(np.ones((1, 2, 2)))


@pytest.mark.parametrize("num_doppler", range(1, 20))
def test_areas_do_not_reach_round_a_short_doppler_axis(num_doppler: int):
    cells = CfarCells(guard=(2, 3), training=(6, 8)).within(num_doppler)
    for reach in (cells.guard[1], cells.training[1]):
        doppler_bins = np.arange(-reach, reach + 1) % num_doppler
        assert len(set(doppler_bins)) >= len(doppler_bins) - 1, "at most the two ends, half a turn away, are one cell"
    assert (cells.guard[0], cells.training[0]) == (2, 6)


@pytest.mark.parametrize("cfar", CFARS)
def test_a_narrow_map_uses_no_cell_twice(cfar):
    power = stream(0, "test narrow").gamma(3, 1.0, (400, 32, 8))
    found = cfar(power, false_alarm_rate=1e-2, num_looks=3, hann_windowed=False)
    assert_rate(int(found.is_detected.sum()), power.size, 1e-2, 0.0)
