"""What knows nothing of the signal and scores all the same: a score means what it exceeds these by."""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import RadarCube


def all_zeros(truth: RadarCube) -> RadarCube:
    """The empty cube."""
    return replace(truth, values=np.zeros_like(truth.values))


def static_mean(truth: RadarCube) -> RadarCube:
    """The mean over the truth's frames, shown in every frame: knows the room, and nothing that moves."""
    mean = truth.values.mean(axis=0, keepdims=True, dtype=np.complex128).astype(np.complex64)
    return replace(truth, values=np.repeat(mean, len(truth.values), axis=0))


FLOORS = {"zeros": all_zeros, "static_mean": static_mean}
