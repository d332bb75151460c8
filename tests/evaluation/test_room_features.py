"""Static clutter of known make: a lone point, many, and channels of unequal gain."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.evaluation.room_features import (
    antenna_spread,
    clutter_peak_over_median,
    plane_wave_share,
    range_azimuth_sparsity,
    range_doppler_sparsity,
)
from tests.evaluation.made_signals import evidence, samples, still

RANDOM = stream(0, "test clutter")
DENSE = [
    still(float(range_m), float(amplitude), float(right))
    for range_m, amplitude, right in zip(
        RANDOM.uniform(0.5, 4.4, 400), RANDOM.rayleigh(0.3, 400), RANDOM.uniform(-0.8, 0.8, 400), strict=True
    )
]
SPARSE = [still(1.5, 3.0), still(3.0, 1.0, 0.3)]


def test_a_dense_room_is_flatter_along_range_and_in_its_maps():
    dense, sparse = evidence(samples(DENSE)), evidence(samples(SPARSE))
    for feature in (clutter_peak_over_median, range_doppler_sparsity, range_azimuth_sparsity):
        assert np.median(feature(dense).values) < np.median(feature(sparse).values)
    assert 3 < np.median(clutter_peak_over_median(dense).values) < 20
    assert np.median(clutter_peak_over_median(sparse).values) > 30


def test_a_lone_point_is_one_plane_wave_and_many_are_not():
    lone = [still(1.0 + 0.3 * at, 1.0, 0.1 * at - 0.4) for at in range(9)]
    assert np.median(plane_wave_share(evidence(samples(lone))).values) > 0.95
    assert np.median(plane_wave_share(evidence(samples(DENSE))).values) < 0.8


def test_unequal_channels_spread_a_cell_over_the_antennas():
    adc = samples([still(1.0 + 0.3 * at) for at in range(9)])
    gain_db = np.linspace(-4, 4, 12)
    gained = adc.samples * 10 ** (gain_db.reshape(3, 4, 1) / 20)
    assert np.median(antenna_spread(evidence(adc)).values) < 0.5
    seen = evidence(replace(adc, samples=gained.astype(np.complex64)))
    assert np.median(antenna_spread(seen).values) == pytest.approx(gain_db.std(), abs=0.4)
