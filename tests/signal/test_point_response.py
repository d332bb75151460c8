"""The renderer against the exact sum over samples, chirps and antennas, through the project's own transforms."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from mmweaver.compression.signal_field import finer_grid
from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import CubeGrid
from mmweaver.signal.point_response import PointResponse, Points
from tests.compression.echoes import SMALL, direction_of, error_db, exact_point


def point(response: PointResponse, range_m: float, velocity_mps: float, towards: np.ndarray) -> Points:
    doppler_bin = velocity_mps / response.velocity_a_bin_mps
    range_bin = range_m / response.range_a_bin_m + response.coupling * doppler_bin
    return Points(
        range_bin=torch.tensor([range_bin], dtype=torch.float32),
        doppler_bin=torch.tensor([doppler_bin], dtype=torch.float32),
        direction=torch.tensor([[towards[0], towards[2]]], dtype=torch.float32),
        amplitude=torch.ones(1, dtype=torch.complex64),
    )


def rendered(config: RadarConfig, range_m: float, velocity_mps: float, towards: np.ndarray) -> np.ndarray:
    response = PointResponse(config)
    axes = response.axes()
    return (response.render(point(response, range_m, velocity_mps, towards), axes) * response.phasor(axes)).numpy()


def mismatch_db(config: RadarConfig, velocity_mps: float, range_m: float = 2.1) -> tuple[float, complex]:
    """Error after the best complex factor, and that factor."""
    towards = direction_of(0.3, 0.1)
    truth = exact_point(config, range_m, velocity_mps, towards)
    ours = rendered(config, range_m, velocity_mps, towards)
    factor = np.vdot(ours, truth) / np.vdot(ours, ours)
    return error_db(factor * ours, truth), complex(factor)


@pytest.mark.parametrize(("velocity_mps", "bound_db"), [(0.0, -60), (0.37, -55), (-1.0, -50), (3.0, -40)])
def test_a_moving_point_is_exact_off_every_bin(velocity_mps: float, bound_db: float):
    mismatch, factor = mismatch_db(AWR1843, velocity_mps)
    assert mismatch < bound_db
    assert abs(factor) == pytest.approx(1.0, abs=5e-3)


def test_the_phase_is_that_of_the_carrier_at_the_range():
    for range_m in (1.5, 2.1, 2.8):
        _, factor = mismatch_db(AWR1843, 0.8, range_m)
        delay_s = 2 * range_m / 299_792_458.0
        turns = AWR1843.centre_frequency_hz * delay_s - AWR1843.chirp_slope_hz_per_s * delay_s**2 / 2
        assert abs(np.angle(factor * np.exp(-2j * np.pi * turns))) < 0.02


def test_the_residual_tdm_phase_matters():
    """A cube is compensated bin by bin; a point between two bins keeps a phase step between transmitters."""
    towards = direction_of(0.3, 0.1)
    half_bin_mps = 3.5 * SMALL.velocity_resolution_mps
    truth = exact_point(SMALL, 1.4, half_bin_mps, towards)
    response = PointResponse(SMALL)
    errors = []
    for known in (response.delay, 0 * response.delay):
        response.delay = known
        axes = response.axes()
        ours = (response.render(point(response, 1.4, half_bin_mps, towards), axes) * response.phasor(axes)).numpy()
        errors.append(error_db(np.vdot(ours, truth) / np.vdot(ours, ours) * ours, truth))
    assert errors[0] < -45
    assert errors[1] > errors[0] + 15


def test_velocity_beyond_the_limit_aliases():
    assert mismatch_db(SMALL, 1.15 * SMALL.max_velocity_mps, 1.4)[0] < -30


def test_a_finer_grid_holds_the_cells_of_the_own_one():
    response = PointResponse(SMALL)
    grid = CubeGrid.of(SMALL, 1)
    points = point(response, 1.4, 0.6, direction_of(-0.2, 0.0))
    own = response.render(points, response.axes())
    finer = response.render(points, response.axes(finer_grid(grid, n_r=2.0, n_d=2.0)))
    assert torch.allclose(finer[::2, ::2], own, atol=1e-5)


def test_single_cells_equal_those_of_the_grid():
    response = PointResponse(SMALL)
    axes = response.axes()
    points = point(response, 1.4, 0.6, direction_of(-0.2, 0.1))
    whole = response.render(points, axes) * response.phasor(axes)
    r, d, a = np.array([2, 9, 20]), np.array([1, 10, 15]), np.array([0, 5, 11])
    cells = replace(
        axes,
        range_bin=axes.range_bin[r],
        doppler_bin=axes.doppler_bin[d],
        place=axes.place[a],
        delay=axes.delay[a],
        parts=axes.parts[:, a],
    )
    some = response.cells(points, cells) * response.phasor(cells, is_grid=False)
    assert torch.allclose(some, whole[r, d, a], atol=1e-6)
