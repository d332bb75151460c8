"""Sampled conditions stay within their ranges."""

import numpy as np

from mmweaver.core.seeding import stream
from mmweaver.recognition.variation import Variation, sample_variation


def test_samples_fill_their_ranges():
    variation = Variation()
    samples = [sample_variation(variation, stream(seed, "draw")) for seed in range(300)]
    for name in ("tempo", "vigour", "distance_m", "height_m", "noise_db", "threshold_db", "gain_db"):
        low, high = getattr(variation, name)
        values = np.array([getattr(one, name) for one in samples])
        assert low <= values.min() < low + 0.1 * (high - low), name
        assert high >= values.max() > high - 0.1 * (high - low), name
    walls = [one.wall_m is not None for one in samples]
    assert abs(np.mean(walls) - variation.wall_share) < 0.1
    assert {one.skin_exponent for one in samples} == set(variation.skin_exponents)


def test_the_start_is_at_its_distance():
    one = sample_variation(Variation(), stream(0, "draw"))
    assert np.isclose(np.hypot(*one.start_m), one.distance_m)
    assert np.isclose(np.degrees(np.arctan2(*one.start_m)), one.azimuth_deg)
