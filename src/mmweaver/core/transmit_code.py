"""Simultaneous transmitters: what each chirp of a loop sends, and how the transmitters are separated again.

A loop has slots, one chirp each; in slot s transmitter m sends with the complex weight W[s, m] (0: off). TDM-MIMO is a
permutation, BPM-MIMO a Hadamard matrix, a steered beam one row of phases. Where W has as many independent rows as
transmitters, its pseudo-inverse separates them; otherwise each slot is one transmitter of its own, a beam, which is
possible where no transmitter is part of two beams.

Reference: TI SWRA554, MIMO Radar; TI SWRU544, mmWave SDK User Guide (bpmCfg).
"""

import numpy as np

from mmweaver.core.errors import InputError

TxCode = tuple[tuple[tuple[float, float], ...], ...]  # (slot, tx): real and imaginary part
HALF_AMPLITUDE = 0.5  # weights are on or off


def tx_code_of(weights: np.ndarray) -> TxCode:
    """Complex weights (slot, tx) as a radar file has them.

    >>> tx_code_of(np.array([[1, 1], [1, -1]]))
    (((1.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (-1.0, 0.0)))
    """
    return tuple(tuple((float(one.real) + 0.0, float(one.imag) + 0.0) for one in row) for row in np.asarray(weights))


def weights_of(code: TxCode) -> np.ndarray:
    """The complex weights (slot, tx) of a code."""
    return np.array([[complex(*one) for one in row] for row in code])


def separates_transmitters(weights: np.ndarray) -> bool:
    """Whether every transmitter can be decoded from the slots."""
    return bool(np.linalg.matrix_rank(weights) == weights.shape[1])


def decoder(weights: np.ndarray) -> np.ndarray:
    """The matrix that turns slots into transmitters, or into beams of phase 0 at their centre.

    Args:
        weights: Complex weights (slot, tx).

    Returns:
        Matrix (virtual tx, slot).

    Raises:
        InputError: where transmitters can be neither separated nor assigned to one beam each.

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
    """Positions (virtual tx, 3) of the decoded transmitters, or of the beams' phase centres."""
    if separates_transmitters(weights):
        return tx_m
    share = np.abs(weights)
    return share @ tx_m / share.sum(axis=1, keepdims=True)
