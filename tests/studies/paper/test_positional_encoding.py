import numpy as np
import pytest
import torch

from studies.paper.positional_encoding import OCTAVES, encoded_size, harmonics, normalised, positional_encoding


def test_three_coordinates_become_51_values():
    assert encoded_size(3) == 51
    assert positional_encoding(torch.zeros(7, 3)).shape == (7, 51)


def test_it_is_the_papers_formula_with_the_raw_coordinates():
    x = torch.tensor([[0.3, -0.7, 0.11]])
    encoded = positional_encoding(x).numpy()[0]
    expected = []
    for value in (0.3, -0.7, 0.11):
        expected += [value, *(np.cos(2**i * value) for i in range(8)), *(np.sin(2**i * value) for i in range(8))]
    assert np.allclose(encoded, expected, atol=1e-5)
    assert OCTAVES == (1, 2, 4, 8, 16, 32, 64, 128)


@pytest.mark.parametrize("num", [12, 32, 64])
def test_harmonics_end_where_cells_alias(num: int):
    """At Nyquist neighbouring cells, 2 / (num - 1) apart, are half a turn apart."""
    assert harmonics(num)[-1] * 2 / (num - 1) == pytest.approx(np.pi)
    assert harmonics(num, 0.5)[-1] == pytest.approx(harmonics(num)[-1] / 2)


def test_cells_are_spread_over_minus_one_to_one():
    assert normalised(np.arange(3.0), 3).tolist() == [-1, 0, 1]
    assert normalised(np.zeros(2), 1).tolist() == [0, 0]
