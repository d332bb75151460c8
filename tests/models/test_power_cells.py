"""Cells of a field: what is shared out to them adds up, and a place keeps its number."""

import numpy as np
import pytest
import torch

from mmweaver.core.presets import AWR1843
from mmweaver.models.power_cells import REFERENCE, CellSizes, density
from mmweaver.paths.mean_echoes import MeanEchoes


def _echoes(count: int) -> MeanEchoes:
    random = torch.Generator().manual_seed(1)
    part = torch.rand(5, count, generator=random)
    return MeanEchoes(
        range_m=1.5 + part[0], velocity_mps=part[1] - 0.5, direction=0.4 * part[2:4].T - 0.2,
        cross_section_m2=0.1 + part[4],
    )  # fmt: skip


def test_a_raster_of_reference_cells_holds_all_that_echoes():
    """Wherever the raster begins, the cells hold the sum of the cross sections."""
    echoes = _echoes(30)
    off = torch.tensor([0.013, 0.1, 0.05, 0.2])
    axes = [start + shift + torch.arange(count) * size for start, shift, count, size in
            zip((1.3, -1.2, -0.6, -0.8), off, (28, 9, 10, 7), REFERENCE, strict=True)]  # fmt: skip
    section, near = density(echoes, torch.cartesian_prod(*axes), torch.ones(30))
    assert float(section.sum()) == pytest.approx(float(echoes.cross_section_m2.sum()), rel=1e-4)
    assert float(near.sum()) == 30 * 2**4  # each echo lies between two cells of every axis


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
