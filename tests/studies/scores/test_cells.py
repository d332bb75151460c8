from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.signal.spectra import range_doppler_power
from studies.scores.cube_scores import cells_of, noise_floor
from tests.cubes import SMALL, point_cube


def test_the_noise_floor_is_the_noise_power():
    """The median of the mean of 12 exponential powers lies 3 % below their mean."""
    noise = stream(0, "floor").standard_normal((4, 64, 32, 12, 2)).view(np.complex128)[..., 0]
    power = np.mean(np.abs(noise) ** 2, axis=-1)
    assert noise_floor(power) == pytest.approx(2.0, rel=0.05)


def test_noise_alone_is_neither_active_nor_moving():
    cube = point_cube(noise=0.3)
    noise = stream(1, "cells").standard_normal((*cube.values.shape, 2)).view(np.complex128)[..., 0]
    cells = cells_of(replace(cube, values=noise.astype(np.complex64)))
    assert not cells.is_active.any()


def test_the_static_point_is_active_and_moving_points_move():
    cube = point_cube()
    cells = cells_of(cube)
    power = range_doppler_power(cube)
    still = np.abs(np.arange(16) - 8) <= 1
    assert cells.is_active[:, :, still].any()
    assert not cells.is_moving[:, :, still].any()
    velocity = cube.grid.radial_velocity_mps
    for share in (0.31, -0.45):
        at = np.argmin(np.abs(velocity - share * SMALL.max_velocity_mps))
        assert cells.is_moving[0, :, at].any()
    assert power[cells.is_active].sum() > 0.95 * power.sum()
    assert 0.01 < cells.is_active.mean() < 0.3
