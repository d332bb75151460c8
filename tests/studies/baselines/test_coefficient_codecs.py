import numpy as np

from studies.baselines.coefficient_codecs import (
    antenna_klt,
    packed_top,
    unpacked_klt,
    unpacked_top,
)
from tests.compression.echoes import crowd


def test_the_largest_cells_come_back_within_their_bits():
    values = crowd().values / np.abs(crowd().values).max()
    again = unpacked_top(packed_top(values, 500), values.shape)
    kept = again != 0
    assert kept.sum() == 500
    assert np.abs(values[~kept]).max() <= np.abs(values[kept]).min()
    assert np.abs(again[kept] / values[kept] - 1).max() < 0.07  # half a step of 0.25 dB and of 1/64 turn


def test_the_reader_has_the_writers_directions():
    basis, data = antenna_klt(crowd().values)
    again, rest = unpacked_klt(data + b"rest", 12)
    assert rest == b"rest"
    assert np.array_equal(basis, again)
    assert np.allclose(basis @ basis.conj().T, np.eye(12))
    strength = np.mean(np.abs(crowd().values.reshape(-1, 12) @ basis.T) ** 2, axis=0)
    assert strength[0] > 2 * strength[-1]
