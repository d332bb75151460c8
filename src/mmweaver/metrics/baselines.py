"""Trivial predictions: a score is meaningful by how much it exceeds theirs."""

from dataclasses import replace

import numpy as np

from mmweaver.core.records import RadarCube


def all_zeros(truth: RadarCube) -> RadarCube:
    """A cube of zeros."""
    return replace(truth, values=np.zeros_like(truth.values))


def static_mean(truth: RadarCube) -> RadarCube:
    """The mean over the frames of the ground truth, repeated: exact static clutter, no motion."""
    mean = truth.values.mean(axis=0, keepdims=True, dtype=np.complex128).astype(np.complex64)
    return replace(truth, values=np.repeat(mean, len(truth.values), axis=0))


BASELINES = {"zeros": all_zeros, "static_mean": static_mean}
