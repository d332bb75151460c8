import numpy as np
import pytest

from mmweaver.compression.cell_sample import CellSample
from mmweaver.compression.step_search import step_of_error, step_of_size, sum_at
from mmweaver.core.seeding import stream

BOUNDS = 1e-6, 1e2


def samples() -> list[CellSample]:
    draw = stream(0, "cells")
    strength = 10 ** draw.uniform(-4, 0, (2, 200, 1))
    return [
        CellSample(magnitude=(one * np.abs(draw.normal(size=(200, 6)))).astype(np.float32),
                   is_active=np.ones(200, bool), weight=np.ones(200), front_bytes=40)
        for one in strength
    ]  # fmt: skip


@pytest.mark.parametrize("num_bytes", [100, 400, 2000])
def test_a_size_is_found_from_anywhere(num_bytes: int):
    """Whatever is known already, the step is the same, and has the size; what was asked before costs nothing."""
    fresh = samples()
    found = step_of_size(fresh, num_bytes, 1, BOUNDS)
    assert sum_at(fresh, found, 1).num_bytes == pytest.approx(num_bytes, rel=5e-3)
    known = samples()
    for step in (1e-5, 3e-3, 0.2, 7.0):
        sum_at(known, step, 1)
    assert step_of_size(known, num_bytes, 1, BOUNDS) == pytest.approx(found)
    nodes = fresh[0].nodes(1)
    assert len(nodes) < 12
    assert step_of_size(fresh, num_bytes, 1, BOUNDS) == pytest.approx(found)
    assert fresh[0].nodes(1) == nodes


def test_what_cannot_be_is_the_nearest_bound():
    own = samples()
    assert step_of_size(own, 10, 1, BOUNDS) == BOUNDS[1]
    assert step_of_size(own, 1e9, 1, BOUNDS) == BOUNDS[0]


def test_an_error_is_found():
    own = samples()
    wanted = sum_at(own, 0.01, 1).all_error
    assert step_of_error(own, wanted, 1, BOUNDS, lambda one: one.all_error) == pytest.approx(0.01, rel=1e-2)
