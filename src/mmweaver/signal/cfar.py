"""Constant false alarm rate (CFAR) detection on range-Doppler power, with thresholds from noise statistics.

The mean of |.|^2 of noise over M antennas ("looks") is gamma distributed with shape M. Hann windows correlate
neighbouring cells, so a ring of N training cells has fewer effective independent ones; both are accounted for.

Reference: Richards, Fundamentals of Radar Signal Processing, ch. 6.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import RangeDopplerMap, RangeDopplerMask

# Correlation of the power of noise in cells 0, 1, 2 bins apart under a Hann window: (1, 2/3, 1/6) squared.
HANN_CORRELATION = np.array([1.0, 4 / 9, 1 / 36])
POWER_CORRELATION = np.outer(HANN_CORRELATION, HANN_CORRELATION)  # (range bins, Doppler bins) apart


@dataclass(frozen=True, kw_only=True)
class CfarCells:
    """Half extents (range, doppler) of the guard area around the cell under test and of the training ring around it.

    By default wide enough that a body, which fills some 8 by 8 cells of 4.4 cm and 0.27 m/s, does not mask itself.
    """

    guard: tuple[int, int] = (4, 4)
    training: tuple[int, int] = (12, 8)

    def within(self, num_doppler: int) -> "CfarCells":
        """These areas for a Doppler axis of so many bins, which is cyclic: no cell is its own training cell."""
        most = (num_doppler - 1) // 2
        if num_doppler >= 2 * self.training[1]:
            return self
        return CfarCells(
            guard=(self.guard[0], min(self.guard[1], most)), training=(self.training[0], min(self.training[1], most))
        )

    def half_extents(self, num_doppler: int) -> tuple[tuple[int, int], tuple[int, int]]:
        """Half extents (range, doppler) of the guard area and of all; limited so that no cell occurs twice."""
        limit = (num_doppler - 1) // 2
        guard = min(self.guard[1], limit)
        whole = min(guard + self.training[1], limit)
        return (self.guard[0], guard), (self.guard[0] + self.training[0], whole)


@dataclass(frozen=True, kw_only=True)
class CfarResult:
    """Detections, and the noise power estimated around each cell, (frame, range, doppler)."""

    is_detected: RangeDopplerMask
    noise_power: RangeDopplerMap


def ca_cfar(
    power: RangeDopplerMap,
    *,
    false_alarm_rate: float = 1e-4,
    num_looks: int = 1,
    cells: CfarCells = CfarCells(),
) -> CfarResult:
    """Cell averaging: a cell is detected where it exceeds a factor times the mean of its training cells.

    Doppler is cyclic; near the ends of range the ring is truncated.

    Args:
        power: under Hann windows.
        false_alarm_rate: of a cell of noise, between 0 and 1.
        num_looks: antennas averaged in `power`.
        cells: guard area and training ring.

    Raises:
        InputError: for an impossible rate or a map too small for any training cell.
    """
    if not 0 < false_alarm_rate < 1:
        raise InputError(f"the false alarm rate must lie between 0 and 1, not {false_alarm_rate}")
    if power.shape[1] * power.shape[2] < 2:
        raise InputError("a range-Doppler map of one cell has no training cells")
    independent = _independent_cells(power.shape[1], power.shape[2], cells)
    factor = np.array([ca_factor(false_alarm_rate, num, num_looks) for num in independent])
    (outer, outer_count), (inner, inner_count) = (
        _box_sum(power, *half) for half in reversed(cells.half_extents(power.shape[2]))
    )
    mean = np.maximum(outer - inner, 0) / (outer_count - inner_count)[:, None]
    return CfarResult(is_detected=power > factor[:, None] * mean, noise_power=mean)


def ca_factor(false_alarm_rate: float, num_training: float, num_looks: int) -> float:
    """Threshold over the mean of the training cells, exact for independent gamma cells (an F distribution).

    For one look it is the textbook's N (rate^(-1/N) - 1):

    >>> round(ca_factor(1e-4, 16.0, 1), 6) == round(16 * (1e-4 ** (-1 / 16) - 1), 6)
    True
    """
    from scipy.special import betaincinv

    share = betaincinv(num_looks * num_training, num_looks, false_alarm_rate)
    return float(num_training * (1 - share) / share)


@lru_cache(maxsize=32)
def _independent_cells(num_range: int, num_doppler: int, cells: CfarCells) -> list[float]:
    """Effective number of independent training cells of each range bin: N^2 over the sum of their correlations."""
    guard, whole = cells.half_extents(num_doppler)
    in_doppler = np.abs(np.arange(-whole[1], whole[1] + 1)) > guard[1]
    known: dict[tuple[int, int], float] = {}
    for at in range(num_range):
        cut = min(at, whole[0]), min(num_range - 1 - at, whole[0])
        if cut in known:
            continue
        is_training = (np.abs(np.arange(-cut[0], cut[1] + 1)) > guard[0])[:, None] | in_doppler
        if not is_training.any():
            raise InputError("the range-Doppler map is too small for training cells; use fewer guard cells")
        mask, pairs = np.pad(is_training.astype(float), 2), 0.0
        for rows in range(-2, 3):
            for columns in range(-2, 3):
                both = mask * np.roll(mask, (rows, columns), (0, 1))
                pairs += float(POWER_CORRELATION[abs(rows), abs(columns)] * both.sum())
        known[cut] = float(mask.sum()) ** 2 / pairs
    return [known[min(at, whole[0]), min(num_range - 1 - at, whole[0])] for at in range(num_range)]


def _box_sum(power: RangeDopplerMap, half_range: int, half_doppler: int) -> tuple[RangeDopplerMap, np.ndarray]:
    """Sums over (2 half + 1)^2 boxes, wrapped in Doppler, cut in range; and the number of cells for each range bin."""
    num_range = power.shape[1]
    padded = np.pad(power, ((0, 0), (0, 0), (half_doppler + 1, half_doppler)), mode="wrap")
    running = np.cumsum(padded, axis=2, dtype=np.float64)
    rows = running[:, :, 2 * half_doppler + 1 :] - running[:, :, : -2 * half_doppler - 1]
    running = np.concatenate([np.zeros_like(rows[:, :1]), np.cumsum(rows, axis=1)], axis=1)
    low = np.maximum(np.arange(num_range) - half_range, 0)
    high = np.minimum(np.arange(num_range) + half_range + 1, num_range)
    return running[:, high] - running[:, low], (high - low) * (2 * half_doppler + 1)
