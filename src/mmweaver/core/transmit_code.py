"""Simultaneous transmitters: the transmit code of a loop and the separation of its transmitters.

A loop consists of slots, one chirp each; in slot s transmitter m sends with the complex weight W[s, m] (0: off).
TDM-MIMO is a permutation, BPM-MIMO a Hadamard matrix, a steered beam one row of phases. If W has as many independent
rows as transmitters, its pseudo-inverse separates them; otherwise each slot is a virtual transmitter of its own (a
beam), which requires that no transmitter is part of two beams.

Reference: TI SWRA554, MIMO Radar; TI SWRU544, mmWave SDK User Guide (bpmCfg).
"""

import numpy as np

from mmweaver.core.errors import InputError

TxCode = tuple[tuple[tuple[float, float], ...], ...]  # (slot, tx): real and imaginary part
HALF_AMPLITUDE = 0.5  # weights are on or off


def tx_code_of(weights: np.ndarray) -> TxCode:
    """Converts complex weights to the format of radar files.

    Args:
        weights: Complex weights, (slot, tx).

    Returns:
        Real and imaginary parts as nested tuples.

    >>> tx_code_of(np.array([[1, 1], [1, -1]]))
    (((1.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (-1.0, 0.0)))
    """
    return tuple(tuple((float(one.real) + 0.0, float(one.imag) + 0.0) for one in row) for row in np.asarray(weights))


def weights_of(code: TxCode) -> np.ndarray:
    """Complex weights of a code, (slot, tx); inverse of `tx_code_of`."""
    return np.array([[complex(*one) for one in row] for row in code])


def separates_transmitters(weights: np.ndarray) -> bool:
    """Whether the weights (slot, tx) have full column rank, so that every transmitter can be decoded."""
    return bool(np.linalg.matrix_rank(weights) == weights.shape[1])


def decoder(weights: np.ndarray) -> np.ndarray:
    """Matrix from slots to transmitters, or to beams with zero phase at their phase centre.

    Args:
        weights: Complex weights, (slot, tx).

    Returns:
        Decoding matrix, (virtual tx, slot).

    Raises:
        InputError: If transmitters can neither be separated nor assigned to one beam each.

    >>> decoder(np.array([[1, 1], [1, -1]])).real
    array([[ 0.5,  0.5],
           [ 0.5, -0.5]])
    """
    if separates_transmitters(weights):
        return np.linalg.pinv(weights)
    is_on = np.abs(weights) > HALF_AMPLITUDE
    if (is_on.sum(axis=0) > 1).any():
        raise InputError(
            f"{weights.shape[1]} transmitters share {weights.shape[0]} chirps of a loop in a way that cannot be"
            " decoded; use as many independent chirps as transmitters, or one beam"
        )
    phase_rad = [np.unwrap(np.angle(row[on])).mean() for row, on in zip(weights, is_on, strict=True)]
    return np.diag(np.exp(-1j * np.array(phase_rad)))


def virtual_tx_m(weights: np.ndarray, tx_m: np.ndarray) -> np.ndarray:
    """Positions of the decoded transmitters, or of the phase centres of beams.

    Args:
        weights: Complex weights, (slot, tx).
        tx_m: Positions of the physical transmitters in metres, (tx, 3).

    Returns:
        Positions in metres, (virtual tx, 3).
    """
    if separates_transmitters(weights):
        return tx_m
    share = np.abs(weights)
    return share @ tx_m / share.sum(axis=1, keepdims=True)
