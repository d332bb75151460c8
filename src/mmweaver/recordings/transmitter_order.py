"""Firing order of the transmitters of a TDM-MIMO recording, estimated from static echoes.

Receivers of one transmitter are sampled in the same chirp, so their correlation at each baseline is correct in any
order. Antennas of two transmitters at the same baseline must show the same correlation, cell by cell, up to a phase
common to all cells (channel errors); in a wrong order they do not. Receivers in one row carry no information on height,
whose phase is then treated as common to all cells as well; receivers in two rows (AOP, ODS) also distinguish
transmitters above one another. Unlike a plane-wave fit, this tolerates several scatterers per cell.
"""

from itertools import permutations

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import RadarCube

CLEAR = 30.0  # static cells: minimum power relative to other velocities
MIN_CELLS = 12
Baseline = tuple[float, float]  # horizontal and vertical, in half wavelengths


def agreements(cube: RadarCube) -> dict[tuple[int, ...], float]:
    """Agreement of transmitters and receivers for each possible firing order.

    Args:
        cube: The cube, read in the order of its radar.

    Returns:
        Agreement from 0 to 1 by order; empty without evidence (one transmitter, a coded radar, too few static cells).
    """
    config = cube.config
    still = _static_cells(cube)
    if config.is_coded or config.num_tx < 2 or len(still) < MIN_CELLS:
        return {}
    signal = still.reshape(-1, config.num_tx, config.num_rx)
    fired, found = list(config.tx_order), {}
    for order in permutations(range(config.num_tx)):
        moved = np.empty_like(signal)
        moved[:, list(order)] = signal[:, fired]  # assigns the slot of transmitter fired[s] to order[s]
        found[order] = _agreement(moved, config)
    return found


def _static_cells(cube: RadarCube) -> np.ndarray:
    """Static cells (cell, antenna), each normalised to unit norm for equal weight."""
    middle = cube.config.num_loops // 2
    still = cube.values[:, :, middle].mean(axis=0)
    power = (np.abs(still) ** 2).sum(axis=1)
    others = np.median((np.abs(cube.values) ** 2).sum(axis=3).mean(axis=0), axis=1)
    chosen = power > (CLEAR * others if cube.config.num_loops >= 8 else 0)
    return still[chosen] / np.sqrt(power[chosen])[:, None]


def _agreement(signal: np.ndarray, config: RadarConfig) -> float:
    """Coherence of baselines between transmitters with those within one, from cells (cell, tx, rx)."""
    place = (2 * config.antenna_position_m / config.wavelength_m).reshape(*signal.shape[1:], 3)[..., [0, 2]]
    within = _correlations(signal, place, [(tx, tx) for tx in range(config.num_tx)])
    one_row = all(up == 0 for _, up in within)
    agreed = possible = 0.0
    for tx in range(config.num_tx):
        for other in range(tx):
            sums: dict[float, tuple[complex, float]] = {}
            for (across, up), value in _correlations(signal, place, [(tx, other)]).items():
                own = within.get((across, up))
                left_up = 0.0
                if own is None and one_row:
                    left_up, own = up, within.get((across, 0.0))
                if own is not None:
                    so_far, most = sums.get(left_up, (0j, 0.0))
                    size = np.linalg.norm(value) * np.linalg.norm(own)
                    sums[left_up] = so_far + np.vdot(own, value), most + float(size)
            agreed += sum(abs(value) for value, _ in sums.values())
            possible += sum(most for _, most in sums.values())
    return float(agreed / max(possible, 1e-300))


def _correlations(signal: np.ndarray, place: np.ndarray, pairs: list[tuple[int, int]]) -> dict[Baseline, np.ndarray]:
    """Products of antenna pairs (cell,) by baseline, averaged over receivers and pairs of transmitters."""
    found: dict[Baseline, list[np.ndarray]] = {}
    for tx, other in pairs:
        for one in range(signal.shape[2]):
            for two in range(signal.shape[2]):
                across, up = np.round(place[tx, one] - place[other, two], 1) + 0.0
                product = signal[:, tx, one] * signal[:, other, two].conj()
                found.setdefault((float(across), float(up)), []).append(product)
    return {baseline: np.mean(products, axis=0) for baseline, products in found.items()}
