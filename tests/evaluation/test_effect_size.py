"""Intervals cover the truth as often as they say, and effects have the size that was put in."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.evaluation.finding import difference_of, spread_of


def test_intervals_cover_the_median():
    random = stream(0, "test")
    covered = 0
    for at in range(100):
        low, high = spread_of(random.normal(3.0, 1.0, 40), in_order=False, seed=at).interval_95 or (0, 0)
        covered += low <= 3.0 <= high
    assert 88 <= covered <= 100


def test_blocks_widen_the_interval_of_frames_that_resemble_each_other():
    slow = np.repeat(stream(0, "test").normal(size=20), 10)
    spans = [spread_of(slow, in_order=in_order).interval_95 or (0, 0) for in_order in (False, True)]
    widths = [high - low for low, high in spans]
    assert widths[1] > 1.3 * widths[0]


def test_the_effect_is_in_units_of_spread_and_tolerance():
    random = stream(0, "test")
    a, b = random.normal(0, 3.0, 400), random.normal(10, 3.0, 400)
    found = difference_of(a, b, 4.0, in_order=False)
    assert found.effect_size == pytest.approx(10 / 5, abs=0.2)
    assert found.wasserstein == pytest.approx(10, abs=0.6)
    assert found.separable is not None
    assert found.separable > 0.97
    low, high = found.effect_interval_95 or (0, 0)
    assert low < found.effect_size < high
    same = difference_of(np.full(5, 2.0), np.full(5, 2.0), 1.0, in_order=True)
    assert (same.effect_size, same.separable, same.wasserstein) == (0, 0.5, 0)
