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
    """Guard area around the cell under test, and the training ring around it, as half extents (range, doppler) in bins.

    The defaults are wide enough that a body, which covers some 8 by 8 cells of 4.4 cm and 0.27 m/s, does not mask
    itself.
    """

    guard: tuple[int, int] = (4, 4)
    training: tuple[int, int] = (12, 8)

    def within(self, num_doppler: int) -> "CfarCells":
        """The same areas, limited to a Doppler axis of `num_doppler` bins.

        The axis is cyclic, so the limit prevents a cell from being its own training cell.
        """
        most = (num_doppler - 1) // 2
        if num_doppler >= 2 * self.training[1]:
            return self
        return CfarCells(
            guard=(self.guard[0], min(self.guard[1], most)), training=(self.training[0], min(self.training[1], most))
        )

    def half_extents(self, num_doppler: int) -> tuple[tuple[int, int], tuple[int, int]]:
        """Half extents (range, doppler) in bins of the guard area, and of guard area and ring together.

        They are limited so that no cell occurs twice on a Doppler axis of `num_doppler` bins.
        """
        limit = (num_doppler - 1) // 2
        guard = min(self.guard[1], limit)
        whole = min(guard + self.training[1], limit)
        return (self.guard[0], guard), (self.guard[0] + self.training[0], whole)


@dataclass(frozen=True, kw_only=True)
class CfarResult:
    """Detections and noise estimates.

    Attributes:
        is_detected: Mask (frame, range, doppler).
        noise_power: Mean power of the training cells of each cell, (frame, range, doppler).
    """

    is_detected: RangeDopplerMask
    noise_power: RangeDopplerMap


def ca_cfar(
    power: RangeDopplerMap,
    *,
    false_alarm_rate: float = 1e-4,
    num_looks: int = 1,
    cells: CfarCells = CfarCells(),
) -> CfarResult:
    """Cell-averaging CFAR: a cell is detected where it exceeds a factor times the mean of its training cells.

    Doppler is cyclic; near the ends of range the ring is truncated.

    Args:
        power: Power (frame, range, doppler) under Hann windows, in any linear unit.
        false_alarm_rate: Probability that a cell of noise is detected, between 0 and 1.
        num_looks: Number of antennas averaged in `power`.
        cells: Guard area and training ring.

    Returns:
        Detections and noise estimates of all cells.

    Raises:
        InputError: For an impossible rate, or a map too small for any training cell.
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
    """Threshold relative to the mean of the training cells.

    Exact for independent gamma-distributed cells (F distribution). For one look it equals the textbook's
    N (rate^(-1/N) - 1):

    >>> round(ca_factor(1e-4, 16.0, 1), 6) == round(16 * (1e-4 ** (-1 / 16) - 1), 6)
    True

    Args:
        false_alarm_rate: Probability that a cell of noise is detected.
        num_training: Number of independent training cells.
        num_looks: Number of antennas averaged.
    """
    from scipy.special import betaincinv

    share = betaincinv(num_looks * num_training, num_looks, false_alarm_rate)
    return float(num_training * (1 - share) / share)


@lru_cache(maxsize=32)
def _independent_cells(num_range: int, num_doppler: int, cells: CfarCells) -> list[float]:
    """Effective number of independent training cells per range bin: N^2 over the sum of their correlations."""
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
    """Sums over (2 half + 1)^2 boxes, wrapped in Doppler, cut in range; and the number of cells per range bin."""
    num_range = power.shape[1]
    padded = np.pad(power, ((0, 0), (0, 0), (half_doppler + 1, half_doppler)), mode="wrap")
    running = np.cumsum(padded, axis=2, dtype=np.float64)
    rows = running[:, :, 2 * half_doppler + 1 :] - running[:, :, : -2 * half_doppler - 1]
    running = np.concatenate([np.zeros_like(rows[:, :1]), np.cumsum(rows, axis=1)], axis=1)
    low = np.maximum(np.arange(num_range) - half_range, 0)
    high = np.minimum(np.arange(num_range) + half_range + 1, num_range)
    return running[:, high] - running[:, low], (high - low) * (2 * half_doppler + 1)
