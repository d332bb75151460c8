"""Result of one fit of a board, or why it cannot be determined; fits are registered by a decorator."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence

Measured = TypeVar("Measured")


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Result of a fit.

    Attributes:
        title: Name of the fit.
        text: Result in words, or the reason why it cannot be determined.
        fields: Fields of `Board`; empty if it cannot be determined.
        errors: One standard error per field where it is known, in the field's unit, rms over a table's entries.
    """

    title: str = ""
    text: str
    fields: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)

    @property
    def is_found(self) -> bool:
        """Whether the fit determined anything."""
        return bool(self.fields)


Fit = Callable[[Sequence[SignalEvidence]], Finding]
SIGNAL_FITS: list[Fit] = []


def signal_fit(title: str) -> Callable[[Fit], Fit]:
    """Decorator that registers a fit of signals; the text of a CannotSeeError becomes its finding.

    Args:
        title: Title of its findings.

    Returns:
        The decorator.
    """

    def register(fit: Fit) -> Fit:
        @functools.wraps(fit)
        def run(evidence: Sequence[SignalEvidence]) -> Finding:
            try:
                found = fit(evidence)
            except CannotSeeError as reason:
                found = Finding(text=str(reason))
            return replace(found, title=title)

        SIGNAL_FITS.append(run)
        return run

    return register


def measured(evidence: Sequence[SignalEvidence], measure: Callable[[SignalEvidence], Measured]) -> list[Measured]:
    """Measures each recording and skips those that do not show the quantity.

    Args:
        evidence: Recordings.
        measure: Measures one recording.

    Returns:
        Results of the recordings that show it.

    Raises:
        CannotSeeError: If none does.
    """
    found, why = [], CannotSeeError("it takes a signal")
    for one in evidence:
        try:
            found.append(measure(one))
        except CannotSeeError as reason:
            why = reason
    if not found:
        raise why
    return found
