"""How sure a recogniser is: calibrated confidence of its labels, and accuracy against coverage when it abstains.

Shares of votes are no probabilities. On generated people who were held out an exponent is fitted to them, so that of
the windows labelled with confidence p a share p is right there. Recordings differ from generated people, so scores
report the calibration error that remains on them.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

EXPONENTS = np.geomspace(0.25, 8.0, 61)
FLOOR = 1e-3  # share of votes below which a label is not excluded
BINS = 10
COVERAGES = tuple(np.linspace(1.0, 0.3, 8).round(1).tolist())

Votes = Float[np.ndarray, "window label"]
Labels = Int[np.ndarray, " window"]


def probabilities(votes: Votes, exponent: float) -> Votes:
    """Probability of each label (window, label) from shares of votes.

    Args:
        votes: Shares of votes (window, label).
        exponent: As given by `fitted_exponent`.
    """
    raised = np.maximum(votes, FLOOR) ** exponent
    return raised / raised.sum(axis=1, keepdims=True)


def fitted_exponent(votes: Votes, truth: Labels) -> float:
    """The exponent of EXPONENTS with the highest likelihood.

    Args:
        votes: Shares of votes (window, label) of windows that did not train.
        truth: True labels (window,).
    """
    rows = np.arange(len(truth))
    likelihood = [np.log(probabilities(votes, exponent)[rows, truth]).sum() for exponent in EXPONENTS]
    return float(EXPONENTS[int(np.argmax(likelihood))])


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """Expected calibration error and mean confidence, against the share of windows that are right."""

    error: float
    confidence: float
    accuracy: float

    @staticmethod
    def of(confidence: Float[np.ndarray, " window"], is_right: Bool[np.ndarray, " window"]) -> "Calibration":
        """Compares confidence with accuracy in BINS equal bins.

        Args:
            confidence: Confidence of each window.
            is_right: Whether its label is right.
        """
        part = np.minimum((confidence * BINS).astype(int), BINS - 1)
        gap = np.bincount(part, confidence - is_right, minlength=BINS)
        return Calibration(
            error=float(np.abs(gap).sum() / len(confidence)),
            confidence=float(confidence.mean()),
            accuracy=float(is_right.mean()),
        )


def coverage_curve(
    confidence: Float[np.ndarray, " window"], is_right: Bool[np.ndarray, " window"]
) -> list[dict[str, Any]]:
    """Accuracy of the most confident windows.

    Args:
        confidence: Confidence of each window.
        is_right: Whether its label is right.

    Returns:
        For each coverage the lowest confidence among these windows, and the share of them that is right.
    """
    order = np.argsort(-confidence, kind="stable")
    rows: list[dict[str, Any]] = []
    for coverage in COVERAGES:
        own = order[: max(round(coverage * len(order)), 1)]
        rows.append(
            {
                "coverage": coverage,
                "confidence_from": round(float(confidence[own[-1]]), 4),
                "accuracy": round(float(is_right[own].mean()), 4),
            }
        )
    return rows
