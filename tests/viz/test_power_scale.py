"""The scale of decibels of a page: absolute, with the noise in sight."""

import numpy as np
import pytest

from mmweaver.viz.theme import MIN_ABOVE_NOISE_DB, PowerScale


def test_levels_are_absolute_where_the_scale_is_known():
    scale = PowerScale.of(peak=1.0, noise=1e-5, scale=1e-4)  # 1.0 stands for 1e-8 mW: -80 dBm
    assert scale.unit == "dBm"
    assert scale.noise_db == pytest.approx(-130.0)
    assert (scale.low_db, scale.high_db) == (-135.0, -80.0)
    assert scale.decibels(np.array([1.0, 1e-2, 0.0])).tolist() == pytest.approx([-80.0, -100.0, -135.0])


def test_noise_alone_stays_at_the_dark_end():
    scale = PowerScale.of(peak=4.0, noise=1.0, scale=float("nan"))
    assert "count" in scale.unit
    assert scale.high_db >= scale.noise_db + MIN_ABOVE_NOISE_DB
    assert scale.decibels(np.array([4.0]))[0] < scale.low_db + 0.35 * (scale.high_db - scale.low_db)


def test_a_strong_leakage_does_not_hide_the_noise():
    scale = PowerScale.of(peak=1e12, noise=1.0, scale=float("nan"))
    assert (scale.low_db, scale.high_db) == (-5.0, 75.0)


def test_silence_has_a_scale():
    scale = PowerScale.of(peak=0.0, noise=None, scale=float("nan"))
    assert scale.decibels(np.zeros(3)).tolist() == [scale.low_db] * 3
