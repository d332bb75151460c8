import numpy as np
import pytest

from mmweaver.compression.quantised_cells import quantise
from mmweaver.compression.rate_model import CellSample
from mmweaver.core.seeding import stream


def test_the_errors_are_those_of_all_cells():
    """Few strong cells among many weak ones: the strong are all sampled."""
    draw = stream(0, "cells").normal(size=(2, 3, 5, 40, 50))
    coefficients = (draw[0] + 1j * draw[1]).astype(np.complex64)
    is_active = np.zeros((5, 40, 50), bool)
    is_active[:, 7, ::5] = True
    coefficients[:, is_active] *= 100
    sample = CellSample.of(coefficients, is_active, front_bytes=7)
    assert sample.weight.sum() == pytest.approx(is_active.size)
    for step, coarser in ((0.5, 4), (3.0, 1), (0.5, 0)):
        cells = quantise(coefficients, step, coarser, is_active)
        lost = np.sum(np.abs(coefficients - cells.values(step, coarser or 1)) ** 2, axis=0)
        found = sample.estimate(step, coarser)
        assert found.all_error == pytest.approx(lost.sum(), rel=0.1)
        assert found.active_error == pytest.approx(lost[is_active].sum(), rel=0.4)
    sizes = [sample.estimate(step, 1).num_bytes for step in (0.1, 1.0, 10.0, 1e4)]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[-1] == 7
