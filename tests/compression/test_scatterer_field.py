from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fitting import FitRecipe
from mmweaver.compression.signal_field import finer_grid
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.signal.cube import adc_from_cube, radar_cube
from tests.compression.echoes import SMALL, crowd, direction_of, error_db, exact_point, middle_s
from tests.compression.scatterers.test_fit_window import overlapping

RECIPE = FitRecipe(num_points=90, stages=10)


@pytest.fixture(scope="module")
def field() -> ScattererField:
    return ScattererField.fit(crowd(), RECIPE)


def one_point(config=SMALL, range_m: float = 1.4, velocity_mps: float = 0.5, num_frames: int = 1) -> RadarCube:
    values = [
        exact_point(
            config, range_m + velocity_mps * frame * config.frame_period_s, velocity_mps, direction_of(0.2, 0.1)
        )
        for frame in range(num_frames)
    ]
    return RadarCube(values=np.stack(values), grid=CubeGrid.of(config, num_frames), config=config, scale=1.0)


def test_three_ways_to_render_the_native_grid_agree(field: ScattererField):
    truth = crowd().values
    native = field.native()
    assert error_db(native, truth) < -30
    assert np.array_equal(field.native(threads=2), native)
    assert error_db(field.values_on(replace(field.grid)), native) < -90
    index = np.stack([np.random.default_rng(0).integers(0, size, 300) for size in native.shape], axis=1)
    assert error_db(field.sample(index.astype(float)), native[tuple(index.T)]) < -90
    assert field.num_values < 90 * 6 + 2 * 24 * 12 + 2


def test_finer_grids_contain_the_native_cells(field: ScattererField):
    finer = field.values_on(finer_grid(field.grid, n_r=2.0, n_d=2.0))
    assert error_db(finer[:, ::2, ::2], field.native()) < -60


def test_values_between_bins_equal_those_of_a_shifted_radar():
    """Half a range bin off: the exact cube of the same point, moved by half a bin, up to its phase."""
    field = ScattererField.fit(one_point(), FitRecipe(num_points=3, stages=1, with_static=False, least_gain=0.0))
    half = replace(field.grid, range_m=field.grid.range_m + SMALL.range_resolution_m / 2)
    ours = field.values_on(half)[0]
    moved = exact_point(SMALL, 1.4 - SMALL.range_resolution_m / 2, 0.5, direction_of(0.2, 0.1))
    assert error_db(np.abs(ours), np.abs(moved)) < -35


def test_a_point_is_rendered_for_another_radar():
    """Twice the bandwidth and half the loops, nothing fitted again: right phase and place."""
    field = ScattererField.fit(one_point(), FitRecipe(num_points=1, stages=1, with_static=False, least_gain=0.0))
    slope = 1.25 * SMALL.chirp_slope_hz_per_s
    other = replace(
        SMALL, chirp_slope_hz_per_s=slope, num_loops=8, num_range_bins=30, start_frequency_hz=76.5e9,
        frequency_limits_hz=(70e9, 90e9),
    )  # fmt: skip
    ours = field.for_radar(other, num_frames=1).values[0]
    late_s = middle_s(other) - middle_s(SMALL)
    truth = exact_point(other, 1.4 + 0.5 * late_s, 0.5, direction_of(0.2, 0.1))
    assert error_db(np.abs(ours), np.abs(truth)) < -35
    assert error_db(ours, truth) < -20


def test_static_clutter_is_rendered_for_another_radar():
    cube = one_point(velocity_mps=0.0, num_frames=2)
    field = ScattererField.fit(cube, FitRecipe(num_points=0, stages=1))
    assert int(field.layers.counts().sum()) == 0
    other = replace(SMALL, num_loops=8)
    truth = exact_point(other, 1.4, 0.0, direction_of(0.2, 0.1))
    assert error_db(field.for_radar(other, num_frames=1).values[0], truth) < -20


def test_overlapping_windows_at_any_instant():
    """Fitted once for all chirps; a window between two windows is rendered from the same scatterers."""
    long = replace(SMALL, num_loops=64)
    whole = exact_point(long, 1.4, 0.6, direction_of(0.2, 0.0))
    cube = overlapping(hop=4, num_frames=5)

    adc = adc_from_cube(RadarCube(values=whole[None], grid=CubeGrid.of(long, 1), config=long, scale=1.0)).samples[0]
    windows = np.stack([adc[2 + 4 * at : 18 + 4 * at] for at in range(10)])
    every = radar_cube(AdcCube(samples=windows, config=SMALL, scale=1.0))
    grid = replace(every.grid, frame_time_s=np.arange(10) * 4 * SMALL.loop_period_s)
    field = ScattererField.fit(replace(every, grid=grid), FitRecipe(num_points=3, stages=3, with_static=False))
    assert field.fit_window.hop == 4
    assert error_db(field.native(), every.values) < -35
    halfway = replace(grid, frame_time_s=grid.frame_time_s[2:4] + 2 * SMALL.loop_period_s)
    late = np.stack([adc[2 + 2 + 4 * at : 18 + 2 + 4 * at] for at in (2, 3)])
    truth = radar_cube(AdcCube(samples=late, config=SMALL, scale=1.0)).values
    assert error_db(field.values_on(halfway), truth) < -30
    assert cube.values.shape == (5, 24, 16, 12)


def test_noise_has_the_power_and_correlation_of_the_recording():
    rng = np.random.default_rng(0)

    shape = (3, 16, SMALL.num_tx, SMALL.num_rx, SMALL.num_samples)
    adc = (rng.normal(size=shape) + 1j * rng.normal(size=shape)).astype(np.complex64)
    cube = radar_cube(AdcCube(samples=adc, config=SMALL, scale=1.0))
    field = ScattererField.fit(cube, FitRecipe(num_points=1, with_static=False, least_gain=1e9))
    silent = replace(cube, values=np.zeros_like(cube.values))
    ours = field.with_noise(silent, seed=1).values
    assert np.mean(np.abs(ours) ** 2) == pytest.approx(np.mean(np.abs(cube.values) ** 2), rel=0.1)
    for axis in (1, 2):
        alike = [np.real(np.sum(v * np.roll(v, 1, axis).conj()) / np.sum(np.abs(v) ** 2)) for v in (ours, cube.values)]
        assert alike[0] == pytest.approx(alike[1], abs=0.06)
    assert np.array_equal(ours, field.with_noise(silent, seed=1).values)
