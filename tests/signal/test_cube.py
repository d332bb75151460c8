"""ADC to cube and back, against a plain sum, for every kind of radar."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60, HUPR, IWR6843, MMMESH, PRESETS
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube
from mmweaver.core.seeding import stream
from mmweaver.signal.cube import adc_from_cube, radar_cube, remove_static, remove_static_adc, static_cube


def noise_adc(config: RadarConfig, num_frames: int = 1) -> AdcCube:
    draw = stream(0, "test cube", config.name)
    shape = (num_frames, config.num_loops, config.num_tx, config.num_rx, config.num_samples)
    samples = draw.standard_normal(shape) + 1j * draw.standard_normal(shape)
    if not config.complex_samples:
        samples = samples.real + 0j
    return AdcCube(samples=samples.astype(np.complex64), config=config, scale=2.0)


def error_db(got: np.ndarray, truth: np.ndarray) -> float:
    return float(20 * np.log10(np.linalg.norm(got - truth) / np.linalg.norm(truth)))


def plain_cell(adc: AdcCube, row: int, column: int, tx: int, rx: int) -> complex:
    """One cell from the definition, in float64."""
    config = adc.config
    sample, loop = np.arange(config.num_samples), np.arange(config.num_loops)
    fast = 0.5 - 0.5 * np.cos(2 * np.pi * sample / config.num_samples)
    slow = 0.5 - 0.5 * np.cos(2 * np.pi * loop / config.num_loops)
    turns = (column - config.num_loops // 2) / config.num_loops
    kernel = np.outer(
        slow * np.exp(-2j * np.pi * turns * loop),
        fast * np.exp(-2j * np.pi * (config.first_range_bin + row) * sample / config.num_samples),
    )
    value = np.sum(adc.samples[0, :, tx, rx].astype(complex) * kernel) / fast.sum() / slow.sum()
    turn = config.tx_order.index(tx) / config.num_tx
    return (1 if config.complex_samples else 2) * value * np.exp(-2j * np.pi * turns * turn)


@pytest.mark.parametrize("name", list(PRESETS))
def test_every_cell_is_the_plain_sum(name: str):
    config = PRESETS[name]
    adc = noise_adc(config)
    before = adc.samples.copy()
    cube = radar_cube(adc)
    assert cube.values.dtype == np.complex64
    assert cube.values.shape == cube.grid.shape
    assert cube.scale == adc.scale
    assert np.array_equal(adc.samples, before)
    scale = np.abs(cube.values).max()
    draw = stream(0, "test cells", name)
    for _ in range(20):
        row, column = draw.integers(config.num_range_bins), draw.integers(config.num_loops)
        tx, rx = draw.integers(config.num_tx), draw.integers(config.num_rx)
        truth = plain_cell(adc, int(row), int(column), int(tx), int(rx))
        assert abs(cube.values[0, row, column, tx * config.num_rx + rx] - truth) < 1e-5 * scale


@pytest.mark.parametrize("config", [AWR1843, MMMESH, HUPR, IWR6843, BGT60], ids=lambda config: config.name)
def test_cube_to_adc_and_back(config: RadarConfig):
    adc = noise_adc(config)
    cube = radar_cube(adc)
    back = adc_from_cube(cube)
    assert error_db(radar_cube(back).values, cube.values) < -100
    assert back.scale == adc.scale
    # of all samples with this cube these have the least energy
    assert np.linalg.norm(back.samples) <= np.linalg.norm(adc.samples)
    if not config.complex_samples:
        assert not back.samples.imag.any()


def test_all_range_bins_give_all_samples_back():
    """Where nothing is left out, what the windows do not blank returns: all but sample 0 and loop 0."""
    config = replace(AWR1843, num_samples=64, num_range_bins=64, first_range_bin=0, num_loops=16)
    adc = noise_adc(config)
    back = adc_from_cube(radar_cube(adc))
    assert error_db(back.samples[:, 1:, ..., 1:], adc.samples[:, 1:, ..., 1:]) < -60
    assert not back.samples[:, 0].any()


def test_a_cube_that_no_samples_give_is_met_in_the_least_squares_sense():
    """Energy in loop 0 cannot be: what comes back is the cube without it, and comes back as it is."""
    cube = radar_cube(noise_adc(AWR1843))
    draw = stream(0, "test free cube")
    free = replace(
        cube, values=draw.standard_normal((*cube.values.shape, 2)).astype(np.float32).view(np.complex64)[..., 0]
    )
    once = radar_cube(adc_from_cube(free))
    assert error_db(once.values, free.values) == pytest.approx(10 * np.log10(1 / 32), abs=1.0)
    assert error_db(radar_cube(adc_from_cube(once)).values, once.values) < -60


@pytest.mark.parametrize("config", [AWR1843, IWR6843, BGT60], ids=lambda config: config.name)
def test_static_removal_on_cube_and_on_samples_agree(config: RadarConfig):
    """The cube cannot see loop 0; samples whose loop 0 is the mean of the others make the two exactly alike."""
    adc = noise_adc(config)
    adc.samples[:, 0] = adc.samples[:, 1:].mean(axis=1)
    on_samples = radar_cube(remove_static_adc(adc)).values
    on_cube = remove_static(radar_cube(adc)).values
    assert error_db(on_cube, on_samples) < -90


def test_an_unknown_removal_is_refused():
    with pytest.raises(InputError, match=r"removal 'median'; known: .*mean_chirp"):
        remove_static(radar_cube(noise_adc(BGT60)), "median")


@pytest.mark.parametrize("config", PRESETS.values(), ids=PRESETS)
def test_static_clutter_follows_from_zero_doppler(config: RadarConfig):
    once = noise_adc(config).samples[:, :1]
    whole = radar_cube(AdcCube(samples=np.repeat(once, config.num_loops, axis=1), config=config, scale=1.0))
    made = static_cube(whole.values[0, :, config.num_loops // 2], config)
    assert error_db(made.values, whole.values) < -80
