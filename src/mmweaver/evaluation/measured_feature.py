"""A feature of a signal: one function of the evidence, registered by a decorator.

@feature("noise_level", "noise of a sample", "dBm", tolerance=3.0)
def noise_level(evidence: SignalEvidence) -> FrameValues: ...
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmweaver.evaluation.signal_evidence import SignalEvidence


@dataclass(frozen=True)
class FrameValues:
    """One value per frame (or window of frames) in the feature's unit; nan for frames that do not show it."""

    values: np.ndarray
    at_most: bool = False  # upper limits, since most frames show nothing above the noise


Measure = Callable[[SignalEvidence], FrameValues]


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A quantity that can be measured on any recording."""

    name: str
    title: str
    unit: str
    tolerance: float  # typical difference between similar recordings, in `unit`
    definition: str
    measure: Measure  # raises CannotSeeError
    whole_frames: bool  # cannot be measured on quarters of a frame


FEATURES: list[Feature] = []


def feature(
    name: str, title: str, unit: str, tolerance: float, *, definition: str = "", whole_frames: bool = False
) -> Callable[[Measure], Measure]:
    """Decorator that registers a function as a feature of `compare`.

    Args:
        name: Key in comparison.json.
        title: Label in tables.
        unit: Unit of the values.
        tolerance: Typical difference between similar recordings, in `unit`.
        definition: What is measured. Default: first line of the docstring.
        whole_frames: Whether it cannot be measured on quarters of a frame. Default: False.

    Returns:
        A decorator that leaves the function unchanged.
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
