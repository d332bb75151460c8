"""Different radars on one grid: energy is kept, the same scene has the same decibels, ranges apart are refused."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.evaluation.compared_sides import common_axes, common_window_m, maps_of
from mmweaver.evaluation.signal_evidence import SignalEvidence
from tests.evaluation.made_signals import RADAR, evidence, samples, still

POINTS = [still(1.3, 1.0, 0.2), still(2.5, 0.5, -0.3)]
COARSE = replace(RADAR, num_samples=64, num_range_bins=24, num_loops=8)  # half the bandwidth


def both() -> tuple[SignalEvidence, SignalEvidence]:
    pair = [evidence(samples(POINTS, config=config, noise=1e-3)) for config in (RADAR, COARSE)]
    window_m = common_window_m(("A", "B"), [one.range_m for one in pair])
    return SignalEvidence(pair[0].signal, window_m), SignalEvidence(pair[1].signal, window_m)


def test_radars_of_different_bins_show_the_same_energy_at_the_same_place():
    a, b = both()
    axes = common_axes(a, b)
    assert np.diff(axes.range_m) == pytest.approx(COARSE.range_resolution_m)
    assert axes.reference.startswith("dBm")
    maps = [maps_of(one, axes) for one in (a, b)]
    for centre_m, level_db in ((1.3, 0.0), (2.5, -6.0)):
        near = np.abs(axes.range_m - centre_m) < 0.4
        energy_db = [10 * np.log10((10 ** (one["range_profile"][near] / 10)).sum()) for one in maps]
        assert energy_db[0] == pytest.approx(level_db + 10 * np.log10(1.5), abs=1.0)  # a Hann window spreads by 1.5
        assert energy_db[1] == pytest.approx(energy_db[0], abs=0.5)
    for name in ("range_doppler", "range_azimuth"):
        first, second = (one[name] for one in maps)
        assert first.shape == second.shape
        peaks = [np.array(np.unravel_index(one.argmax(), one.shape)) for one in (first, second)]
        assert np.abs(peaks[0] - peaks[1]).max() <= 1


def test_no_velocity_is_shown_that_one_of_both_lacks():
    a, _ = both()
    axes = common_axes(a, a)
    assert axes.radial_velocity_mps == pytest.approx(a.cube.grid.radial_velocity_mps)
    shown = maps_of(a, axes)["range_doppler"]
    assert shown.min() > -150  # noise, not an empty column


def test_without_a_scale_decibels_are_over_noise():
    a, b = both()
    adc = a.signal.adc
    assert adc is not None
    unknown = evidence(replace(adc, scale=float("nan")))
    axes = common_axes(unknown, b)
    assert "noise" in axes.reference
    peak_db = maps_of(unknown, axes)["range_profile"].max()
    assert peak_db == pytest.approx(60, abs=2)  # amplitude 1 over noise of 1e-3 a sample
