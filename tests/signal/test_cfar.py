"""Noise alone has the requested false alarm rate; thresholds are those of the textbooks."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import radar_cube
from mmweaver.signal.points import CfarCells, ca_cfar, ca_factor

RATES = [1e-2, 1e-3, 1e-4]


def assert_rate(num_fired: int, num_cells: int, rate: float) -> None:
    """Within four standard deviations of counting (neighbours share training cells: doubled), and 5 %."""
    expected = num_cells * rate
    assert abs(num_fired - expected) < 4 * np.sqrt(2 * expected) + 0.05 * expected


@pytest.fixture(scope="module")
def noise_cells() -> np.ndarray:
    """Noise of the converters through the whole chain: |cube|^2, (frame, range, doppler, antenna)."""
    draw = stream(0, "test cfar chain")
    samples = draw.standard_normal((60, 32, 3, 4, 256, 2), dtype=np.float32).view(np.complex64)[..., 0]
    return np.abs(radar_cube(AdcCube(samples=samples, config=AWR1843, scale=1.0)).values.astype(np.complex128)) ** 2


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("cells", [CfarCells(), CfarCells(guard=(2, 2), training=(6, 4))], ids=["wide", "narrow"])
def test_noise_of_twelve_antennas_has_the_requested_false_alarm_rate(noise_cells, rate: float, cells: CfarCells):
    power = noise_cells.mean(axis=-1)
    found = ca_cfar(power, false_alarm_rate=rate, num_looks=12, cells=cells)
    assert_rate(int(found.is_detected.sum()), power.size, rate)
    assert found.noise_power.mean() == pytest.approx(power.mean(), rel=0.01)
    if rate == RATES[0]:  # near the ends of range, where rings are truncated, too
        edges = found.is_detected[:, [0, 1, 2, -3, -2, -1]]
        assert_rate(int(edges.sum()), edges.size, rate)


@pytest.mark.parametrize("rate", RATES)
def test_noise_of_one_antenna_has_the_requested_false_alarm_rate(noise_cells, rate: float):
    power = np.moveaxis(noise_cells[..., [0, 5, 11]], -1, 0).reshape(-1, 64, 32)
    assert_rate(int(ca_cfar(power, false_alarm_rate=rate).is_detected.sum()), power.size, rate)


def test_few_training_cells_of_windowed_noise_count_as_fewer(noise_cells):
    """Taken as independent, 56 cells of Hann windows would let a fifth more false alarms pass."""
    cells = CfarCells(guard=(2, 2), training=(2, 2))
    found = ca_cfar(noise_cells.mean(axis=-1), false_alarm_rate=1e-2, num_looks=12, cells=cells)
    assert found.is_detected.mean() == pytest.approx(1e-2, rel=0.06)


@pytest.mark.parametrize("rate", RATES)
def test_one_look_has_the_textbook_thresholds(rate: float):
    assert ca_factor(rate, 24.0, 1) == pytest.approx(24 * (rate ** (-1 / 24) - 1), rel=1e-9)


@pytest.mark.parametrize("scale", [1.0, 1e-18, 1e12])
def test_a_target_is_found_and_scale_does_not_matter(scale: float):
    power = stream(0, "test target").gamma(12, 1 / 12, (1, 64, 32))
    power[0, 3, 31] = power[0, 40, 0] = 10.0
    found = ca_cfar(power * scale, false_alarm_rate=1e-6, num_looks=12)
    assert np.argwhere(found.is_detected).tolist() == [[0, 3, 31], [0, 40, 0]]


def test_training_cells_are_cyclic_in_doppler():
    power = np.ones((1, 32, 16))
    power[0, 16, 0] = 1000.0
    noise = ca_cfar(power, cells=CfarCells(guard=(1, 1), training=(2, 2))).noise_power[0, 16]
    assert noise[[14, 2]] == pytest.approx(1 + 999 / 40)
    assert noise[[0, 1, 15, 8]] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("shape", "rate", "named"), [((8, 8), 0.0, "false alarm rate"), ((1, 1), 0.1, "cell"), ((2, 2), 0.1, "guard")]
)
def test_impossible_maps_and_rates_are_refused(shape: tuple[int, int], rate: float, named: str):
    with pytest.raises(InputError, match=named):
        ca_cfar(np.ones((1, *shape)), false_alarm_rate=rate)


@pytest.mark.parametrize("num_doppler", [1, 2, 5, 8, 15, 16, 19])
def test_areas_do_not_reach_round_a_short_doppler_axis(num_doppler: int):
    cells = CfarCells(guard=(2, 3), training=(6, 8)).within(num_doppler)
    for reach in (cells.guard[1], cells.training[1]):
        doppler_bins = np.arange(-reach, reach + 1) % num_doppler
        assert len(set(doppler_bins)) >= len(doppler_bins) - 1, "at most the two ends, half a turn away, are one cell"
    assert (cells.guard[0], cells.training[0]) == (2, 6)
