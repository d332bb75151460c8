"""What a feature is, and what measuring it gives: a value a frame, or the reason why it cannot be seen."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmweaver.comparison.signal_evidence import SignalEvidence


class CannotSeeError(Exception):
    """A feature that a recording does not show; the message says why."""


@dataclass(frozen=True)
class FrameValues:
    """A value a frame (or a window of frames), in the feature's unit; nan where a frame does not show it."""

    values: np.ndarray
    at_most: bool = False  # nothing was found above the noise in most frames: the values are upper limits


@dataclass(frozen=True, kw_only=True)
class Feature:
    """A number that recordings show. `tolerance`: what two recordings of one kind differ by, in its unit."""

    name: str
    title: str
    unit: str
    tolerance: float
    definition: str  # what is measured, and the physics behind it
    measure: Callable[[SignalEvidence], FrameValues]  # raises CannotSeeError
    whole_frames: bool = False  # cannot be measured on quarters of a frame


def decibels(ratio: np.ndarray | float) -> np.ndarray:
    """10 log10 of a ratio of powers; nan where it is not positive."""
    power = np.asarray(ratio, float)
    return np.asarray(10 * np.log10(np.where((power > 0) & np.isfinite(power), power, np.nan)))
