"""Profiles are smooth where they say so."""

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.motion.animation.profiles import bump, cap, rise, rise_integral, softmin, through, travel, wander

U = np.linspace(-0.5, 1.5, 4001)


def second(values: np.ndarray) -> np.ndarray:
    return np.diff(values, 2) / (U[1] - U[0]) ** 2


def test_c2_profiles_have_no_jump_in_the_second_derivative():
    knots = [(0.0, 0.0, 0.0, 0.0), (0.4, -1.0, 0.0, 9.0), (1.0, 0.5, 0.0, 0.0)]
    for values in (rise(U), bump(U), travel(U, 0.3, 0.2), cap(U, 0.7, 0.2), through(U, knots)):
        assert np.abs(np.diff(second(values))).max() < 0.03 * max(np.abs(second(values)).max(), 1)


def test_rise_integral_is_the_integral():
    assert np.allclose(np.gradient(rise_integral(U), U), rise(U), atol=1e-3)


def test_travel_arrives_and_goes_on_where_it_has_no_ramp():
    ends = np.array([0.0, 1.0])
    assert np.allclose(travel(ends, 0.3, 0.4), ends)
    assert np.allclose(travel(ends, 0.0, 0.0), ends)
    assert travel(np.array([2.0]), 0.3, 0.0)[0] > 1.5
    assert travel(np.array([2.0]), 0.3, 0.3)[0] == 1.0


def test_softmin_is_just_below_the_minimum():
    low = softmin([U, 1 - U], 0.01)
    true = np.minimum(U, 1 - U)
    assert np.all(low <= true)
    assert np.all(low > true - 0.01 * np.log(2) - 1e-12)


def test_wander_has_unit_spread():
    time = np.linspace(0, 2000, 40000)
    assert abs(wander(time, stream(0, "t"), slow_hz=0.1, fast_hz=1.0).std() - 1) < 0.05
