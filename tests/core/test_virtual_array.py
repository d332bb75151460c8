"""Which antennas tell azimuth and elevation, for the arrays there are."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.virtual_array import azimuth_resolution_rad, azimuth_row, elevation_rows, has_elevation


def test_the_1843_pairs_four_columns():
    pair = elevation_rows(AWR1843.antenna_position_m, AWR1843.wavelength_m)
    assert pair is not None
    place_m = AWR1843.antenna_position_m
    assert pair.lower.tolist() == [2, 3, 8, 9]
    assert pair.upper.tolist() == [4, 5, 6, 7]
    assert np.allclose(place_m[pair.upper] - place_m[pair.lower], [0, 0, AWR1843.wavelength_m / 2])
    assert pair.spacing_m == pytest.approx(AWR1843.wavelength_m / 2)


def test_two_transmitters_in_a_row_have_no_elevation():
    flat = replace(AWR1843, tx_position_m=(AWR1843.tx_position_m[0], AWR1843.tx_position_m[2]), tx_order=(0, 1))
    assert not has_elevation(flat)
    assert azimuth_row(flat.antenna_position_m, flat.wavelength_m).tolist() == list(range(8))


def test_the_l_of_three_receivers():
    assert has_elevation(BGT60)
    assert azimuth_row(BGT60.antenna_position_m, BGT60.wavelength_m).tolist() == [2, 0]


def test_azimuth_resolution_is_two_over_the_number_of_columns():
    assert azimuth_resolution_rad(AWR1843) == pytest.approx(2 / 8)
    single = replace(AWR1843, tx_position_m=AWR1843.tx_position_m[:1], rx_position_m=((0.0, 0.0, 0.0),), tx_order=(0,))
    assert np.isnan(azimuth_resolution_rad(single))
    assert not has_elevation(single)
