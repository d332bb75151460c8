"""What one fit found of a board, or why it could not see it; fits of signals are declared by one decorator."""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence

Measured = TypeVar("Measured")


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Fields of `Board` that a fit gives; none where it saw nothing and `text` gives the reason.

    `errors`: one standard error of fields where it is known, in the field's unit, rms over a table's entries.
    """

    title: str = ""
    text: str
    fields: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)

    @property
    def is_found(self) -> bool:
        return bool(self.fields)


Fit = Callable[[Sequence[SignalEvidence]], Finding]
SIGNAL_FITS: list[Fit] = []


def signal_fit(title: str) -> Callable[[Fit], Fit]:
    """Declares a fit of signals; its finding has this title, and what it raises as CannotSeeError is the text."""

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
    """What can be measured in each recording. Raises CannotSeeError where none shows it."""
    found, why = [], CannotSeeError("it takes a signal")
    for one in evidence:
        try:
            found.append(measure(one))
        except CannotSeeError as reason:
            why = reason
    if not found:
        raise why
    return found
