"""Cells of a field: a place keeps its number."""

import numpy as np
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.models.power_cells import CellSizes


def test_a_place_has_one_number_whoever_passes_there():
    sizes = CellSizes.of(AWR1843)
    seen = []
    for pelvis in ([2.0, 0.3, 0.0, -0.1], [2.21, -0.4, 0.13, -0.1]):
        blocks, inside = sizes.boxes(torch.tensor(pelvis), (2, 2, 2, 2))
        cells = (blocks[:, None] + inside).flatten(0, 1)
        numbers = sizes.numbers(cells).numpy()
        assert len(np.unique(numbers)) == len(numbers)
        seen.append((numbers, cells.numpy()))
    (first, here), (second, there) = seen
    _, one, other = np.intersect1d(first, second, return_indices=True)
    assert 0 < len(one) < len(first)
    assert np.allclose(here[one], there[other], atol=1e-4)
