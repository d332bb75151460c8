import numpy as np
import pytest
from jaxtyping import Complex

from mmweaver.compression import signal_field
from mmweaver.compression.signal_field import (
    Coordinates,
    SignalField,
    antenna_at,
    antenna_coordinate,
    coordinates_on,
    finer_grid,
    sampled_grid,
)
from mmweaver.core.boards import AWR1843
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid
from tests.cubes import SMALL

NATIVE = CubeGrid.of(AWR1843, 3)


@pytest.mark.parametrize("factor", [2.0, 3.0, 4.0])
def test_finer_grids_contain_the_native_cells(factor: float):
    finer = finer_grid(NATIVE, n_r=factor, n_d=factor, n_a=factor)
    step = int(factor)
    assert finer.shape == (3, 64 * step, 32 * step, 11 * step + 1)
    assert np.allclose(finer.range_m[::step], NATIVE.range_m, atol=1e-12)
    assert np.allclose(finer.radial_velocity_mps[::step], NATIVE.radial_velocity_mps, atol=1e-12)
    assert np.allclose(finer.antenna_position_m[::step], NATIVE.antenna_position_m, atol=1e-12)


def test_one_and_a_half_times_finer_contains_every_other_cell():
    finer = finer_grid(NATIVE, n_r=1.5, n_d=1.5)
    assert finer.shape == (3, 96, 48, 12)
    assert np.allclose(finer.range_m[::3], NATIVE.range_m[::2])
    assert finer.radial_velocity_mps[48 // 2] == pytest.approx(0, abs=1e-12)


def test_coordinates_are_in_cells():
    frame, range_bin, doppler_bin, antenna = coordinates_on(NATIVE, finer_grid(NATIVE, n_r=2.0, n_d=4.0, n_a=2.0))
    assert np.allclose(frame, [0, 1, 2])
    assert np.allclose(range_bin, np.arange(128) / 2, atol=1e-9)
    assert np.allclose(doppler_bin, np.arange(128) / 4, atol=1e-9)
    assert np.allclose(antenna, np.arange(23) / 2, atol=1e-6)


def test_antenna_places_and_numbers_are_inverse():
    number = np.array([0.0, 0.25, 3.0, 7.9, 11.0])
    place = antenna_at(NATIVE.antenna_position_m, number)
    assert np.allclose(antenna_coordinate(NATIVE.antenna_position_m, place, NATIVE.wavelength_m), number, atol=1e-6)


def test_one_antenna_is_enough():
    single = NATIVE.antenna_position_m[:1]
    assert antenna_at(single, np.zeros(2)).shape == (2, 3)
    assert antenna_coordinate(single, single, NATIVE.wavelength_m).tolist() == [0.0]


def test_sampled_coordinates_stay_within_the_radius():
    for radius in (0, 1, 7):
        _, range_bin, doppler_bin, antenna = coordinates_on(NATIVE, sampled_grid(NATIVE, radius / 8, seed=0))
        for at in (range_bin, doppler_bin, antenna):
            offset = at - np.arange(len(at))
            assert offset.min() > -1e-6
            assert offset.max() <= radius / 8 + 1e-6
            assert at[-1] == pytest.approx(len(at) - 1)
        if radius == 7:
            assert (range_bin - np.arange(64)).max() > 0.7


def test_a_radius_of_a_whole_cell_is_refused():
    with pytest.raises(InputError, match="below 1"):
        sampled_grid(NATIVE, 1.0, seed=0)


def test_samples_follow_the_seed():
    one, again, other = (sampled_grid(NATIVE, 3 / 8, seed=seed).range_m for seed in (0, 0, 1))
    assert (one == again).all()
    assert (one != other).any()


class Formula(SignalField):
    def __init__(self):
        self.config, self.grid, self.scale = SMALL, CubeGrid.of(SMALL, 3), 1.0

    @property
    def num_values(self) -> int:
        return 0

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        frame, range_bin, doppler_bin, antenna = coordinates.T
        return (frame + 10 * range_bin + 1j * (doppler_bin - 100 * antenna)).astype(np.complex64)


def test_a_grid_equals_its_points(monkeypatch):
    monkeypatch.setattr(signal_field, "CHUNK_POINTS", 1000)  # several chunks, one of them short
    values = Formula().values_on(CubeGrid.of(SMALL, 3))
    frame, range_bin, doppler_bin, antenna = np.indices(values.shape)
    assert np.allclose(values, frame + 10 * range_bin + 1j * (doppler_bin - 100 * antenna), atol=1e-2)
    assert values.dtype == np.complex64


def test_a_cube_carries_grid_config_and_scale():
    field = Formula()
    finer = field.on_grid(n_r=2.0)
    assert finer.values.shape == finer.grid.shape == (3, 64, 16, 12)
    assert finer.config is SMALL
    assert np.allclose(finer.values[:, ::2], field.cube().values, atol=1e-2)
