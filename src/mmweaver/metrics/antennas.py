"""Phase consistency across antennas: whether the array sees echoes from the right direction."""

import numpy as np

from mmweaver.core.shapes import CubeValues, RangeDopplerMask

CHANCE_RAD = np.pi / 2  # mean absolute error of a uniformly random phase


def antenna_phase_error_rad(prediction: CubeValues, truth: CubeValues, where: RangeDopplerMask) -> float:
    """Mean absolute error of the phase step from each antenna to the next, over the cells `where`, in [0, pi].

    Invariant to a phase common to all antennas of a cell. A random phase scores pi / 2, and so does a step next to an
    antenna that is exactly zero. nan without cells or with fewer than two antennas.

    >>> truth = np.exp(1j * np.array([0.0, 1.0, 2.0])).reshape(1, 1, 1, 3)
    >>> everywhere = np.ones((1, 1, 1), bool)
    >>> round(antenna_phase_error_rad(truth * np.exp(0.7j), truth, everywhere), 9)
    0.0
    >>> round(antenna_phase_error_rad(np.abs(truth) + 0j, truth, everywhere), 9)
    1.0
    """
    p, t = prediction[where].astype(np.complex128), truth[where].astype(np.complex128)
    step_p, step_t = (values[:, 1:] * values[:, :-1].conj() for values in (p, t))
    if not step_t.size:
        return float("nan")
    error = np.abs(np.angle(step_p * step_t.conj()))
    return float(np.mean(np.where((step_p == 0) | (step_t == 0), CHANCE_RAD, error)))
