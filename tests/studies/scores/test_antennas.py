import numpy as np
import pytest

from mmweaver.core.seeding import stream
from studies.scores.cube_scores import antenna_phase_error_rad

RNG = stream(0, "antennas")
SHAPE = (2, 6, 5, 4)
TRUTH = np.exp(2j * np.pi * RNG.random(SHAPE)) * (1 + RNG.random(SHAPE))
EVERYWHERE = np.ones(SHAPE[:3], bool)


def test_it_is_the_unwrapped_difference_of_phase_steps():
    prediction = TRUTH * np.exp(0.5j * RNG.standard_normal(SHAPE))
    steps = [np.diff(np.angle(values), axis=-1) for values in (prediction, TRUTH)]
    wrapped = (steps[0] - steps[1] + np.pi) % (2 * np.pi) - np.pi
    assert antenna_phase_error_rad(prediction, TRUTH, EVERYWHERE) == pytest.approx(np.abs(wrapped).mean())


def test_a_common_phase_and_gain_per_cell_do_not_matter():
    turned = TRUTH * (RNG.random(SHAPE[:3]) * np.exp(2j * np.pi * RNG.random(SHAPE[:3])))[..., None]
    assert antenna_phase_error_rad(turned, TRUTH, EVERYWHERE) == pytest.approx(0, abs=1e-9)


def test_chance_is_half_pi():
    big = (40, 40, 10, 4)
    one, other = (np.exp(2j * np.pi * RNG.random(big)) for _ in range(2))
    assert antenna_phase_error_rad(one, other, np.ones(big[:3], bool)) == pytest.approx(np.pi / 2, abs=0.02)
    assert antenna_phase_error_rad(0 * TRUTH, TRUTH, EVERYWHERE) == pytest.approx(np.pi / 2)


def test_no_cells_and_no_second_antenna_give_no_number():
    assert np.isnan(antenna_phase_error_rad(TRUTH, TRUTH, ~EVERYWHERE))
    assert np.isnan(antenna_phase_error_rad(TRUTH[..., :1], TRUTH[..., :1], EVERYWHERE))
