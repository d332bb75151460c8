"""A feature of a signal: one function of the evidence, declared by one decorator.

@feature("noise_level", "noise of a sample", "dBm", tolerance=3.0)
def noise_level(evidence: SignalEvidence) -> FrameValues: ...
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmweaver.evaluation.signal_evidence import SignalEvidence


@dataclass(frozen=True)
class FrameValues:
    """A value per frame (or window of frames), in the feature's unit; nan where a frame does not show it."""

    values: np.ndarray
    at_most: bool = False  # nothing was found above the noise in most frames: the values are upper limits


Measure = Callable[[SignalEvidence], FrameValues]


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A number that recordings show."""

    name: str
    title: str
    unit: str
    tolerance: float  # what two recordings of one kind differ by, in `unit`
    definition: str  # what is measured
    measure: Measure  # raises CannotSeeError
    whole_frames: bool  # cannot be measured on quarters of a frame


FEATURES: list[Feature] = []


def feature(
    name: str, title: str, unit: str, tolerance: float, *, definition: str = "", whole_frames: bool = False
) -> Callable[[Measure], Measure]:
    """Declares a function as a feature of `compare`.

    Args:
        name: Key in comparison.json.
        title: Label in tables.
        unit: Unit of the values.
        tolerance: What two recordings of one kind differ by, in `unit`.
        definition: What is measured. Default: the first line of the docstring.
        whole_frames: Whether quarters of a frame do not show it.

    Returns:
        A decorator that leaves the function as it is.
    """

    def register(measure: Measure) -> Measure:
        text = definition or (measure.__doc__ or "").partition("\n")[0]
        FEATURES.append(
            Feature(
                name=name,
                title=title,
                unit=unit,
                tolerance=tolerance,
                definition=text.rstrip("."),
                measure=measure,
                whole_frames=whole_frames,
            )
        )
        return measure

    return register
