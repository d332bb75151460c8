"""Confidence is the share that is right, and the most confident windows are more often right."""

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.recognition.confidence import Calibration, coverage_curve, fitted_exponent, probabilities

COUNT, LABELS = 4000, 4


def voted(sharpness: float) -> tuple[np.ndarray, np.ndarray]:
    """Votes (window, label) and true labels that are sampled from known probabilities, of which votes are a power."""
    rng = stream(1, "confidence test")
    known = rng.dirichlet(np.full(LABELS, 0.7), COUNT)
    truth = np.array([rng.choice(LABELS, p=row) for row in known])
    votes = known**sharpness
    return votes / votes.sum(axis=1, keepdims=True), truth


@pytest.mark.parametrize("sharpness", [0.4, 1.0, 2.0])
def test_flat_and_sharp_votes_are_calibrated(sharpness: float):
    votes, truth = voted(sharpness)
    exponent = fitted_exponent(votes[::2], truth[::2])
    assert exponent == pytest.approx(1 / sharpness, rel=0.15)
    held, labels = votes[1::2], truth[1::2]
    sure, is_right = probabilities(held, exponent).max(axis=1), held.argmax(axis=1) == labels
    assert Calibration.of(sure, is_right).error < 0.04
    if sharpness != 1.0:
        assert Calibration.of(held.max(axis=1), is_right).error > 0.08


def test_fewer_windows_are_more_often_right():
    votes, truth = voted(1.0)
    rows = coverage_curve(votes.max(axis=1), votes.argmax(axis=1) == truth)
    accuracy = [row["accuracy"] for row in rows]
    assert [row["coverage"] for row in rows] == [1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3]
    assert np.all(np.diff(accuracy) > 0)
    assert accuracy[0] == pytest.approx((votes.argmax(axis=1) == truth).mean(), abs=1e-4)
    chosen = votes.max(axis=1) >= rows[3]["confidence_from"]
    assert chosen.mean() == pytest.approx(0.7, abs=0.01)
