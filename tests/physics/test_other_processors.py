"""Signals are those of the processor that computed the stored ones, within what processors were seen to differ.

The same seed gives the same bits on one kind of processor; on another, sums are rounded differently (docs/security.md).
"""

import numpy as np
import pytest

from tests.physics.reference_signals import FILE, TOLERANCE, signal


@pytest.mark.parametrize("method", TOLERANCE)
def test_a_signal_is_the_stored_one_within_the_tolerance(method: str):
    values = signal(method)
    with np.load(FILE) as stored:
        cells, expected = stored[f"{method}_cell"], stored[f"{method}_value"]
    assert np.abs(expected).max() == pytest.approx(1.0)
    assert np.abs(values.ravel()[cells] - expected).max() <= TOLERANCE[method], (
        "if signals were meant to change: python -m tests.physics.reference_signals"
    )
