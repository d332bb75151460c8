"""Constant false alarm rate (CFAR) detection on range-Doppler power, with thresholds from noise statistics.

The mean of |.|^2 of noise over M antennas ("looks") is gamma distributed with shape M. Hann windows correlate
neighbouring cells, so a ring of N training cells has fewer effective independent ones; both are accounted for.

Reference: Richards, Fundamentals of Radar Signal Processing, ch. 6; Rohling 1983 (OS-CFAR).
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import RangeDopplerMap, RangeDopplerMask

# Correlation of the power of noise in cells 0, 1, 2 bins apart under a Hann window: (1, 2/3, 1/6) squared.
HANN_CORRELATION = np.array([1.0, 4 / 9, 1 / 36])
POWER_CORRELATION = np.outer(HANN_CORRELATION, HANN_CORRELATION)  # (range bins, Doppler bins) apart
OS_QUANTILE = 0.75


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


@dataclass(frozen=True, kw_only=True)
class CfarResult:
    """Detections, and the noise power estimated around each cell, (frame, range, doppler)."""

    is_detected: RangeDopplerMask
    noise_power: RangeDopplerMap


@dataclass(frozen=True, kw_only=True)
class _Ring:
    """The training cells of one range bin, as offsets."""

    range_offset: np.ndarray
    doppler_offset: np.ndarray
    num_independent: float


def ca_cfar(
    power: RangeDopplerMap,
    *,
    false_alarm_rate: float = 1e-4,
    num_looks: int = 1,
    cells: CfarCells = CfarCells(),
    hann_windowed: bool = True,
) -> CfarResult:
    """Cell averaging: a cell is detected where it exceeds a factor times the mean of its training cells.

    `num_looks` = antennas averaged in `power`; `hann_windowed`: neighbouring cells are correlated by Hann windows
    (False: independent cells). Doppler is cyclic; near the ends of range the ring is truncated. Raises InputError for a
    rate outside (0, 1) or a map too small for any training cell.
    """
    _check(power, false_alarm_rate)
    rings = _rings(power.shape[1], power.shape[2], cells, POWER_CORRELATION if hann_windowed else None)
    mean = _ring_mean(power, cells)
    factor = np.array([ca_factor(false_alarm_rate, ring.num_independent, num_looks) for ring in rings])
    return CfarResult(is_detected=power > factor[:, None] * mean, noise_power=mean)


def os_cfar(
    power: RangeDopplerMap,
    *,
    false_alarm_rate: float = 1e-4,
    num_looks: int = 1,
    cells: CfarCells = CfarCells(),
    hann_windowed: bool = True,
) -> CfarResult:
    """Ordered statistic: as `ca_cfar`, but against the 75 % quantile of the training cells.

    Other targets among the training cells do not raise the threshold as long as they fill less than a quarter.
    """
    _check(power, false_alarm_rate)
    num_range, num_doppler = power.shape[1:]
    noise = np.empty_like(power)
    factor = np.empty(num_range)
    correlation = _exceedance_correlation(num_looks) if hann_windowed else None
    for at, ring in enumerate(_rings(num_range, num_doppler, cells, correlation)):
        num = len(ring.range_offset)
        rank = max(1, round(OS_QUANTILE * num))
        columns = (np.arange(num_doppler)[:, None] + ring.doppler_offset) % num_doppler
        training = power[:, at + ring.range_offset[None, :], columns]
        ordered = np.partition(training, rank - 1, axis=-1)[..., rank - 1]
        # fewer independent cells widen the distribution of the ranked one, but keep its mean, rank / (num + 1)
        independent_rank = rank * (ring.num_independent + 1) / (num + 1)
        level, factor[at] = os_factor(false_alarm_rate, independent_rank, ring.num_independent, num_looks)
        noise[:, at] = ordered / level
    return CfarResult(is_detected=power > factor[:, None] * noise, noise_power=noise)


CFAR_METHODS = {"ca": ca_cfar, "os": os_cfar}


def ca_factor(false_alarm_rate: float, num_training: float, num_looks: int) -> float:
    """Threshold over the mean of the training cells, exact for independent gamma cells (an F distribution).

    For one look it is the textbook's N (rate^(-1/N) - 1):

    >>> round(ca_factor(1e-4, 16.0, 1), 6) == round(16 * (1e-4 ** (-1 / 16) - 1), 6)
    True
    """
    from scipy.special import betaincinv

    share = betaincinv(num_looks * num_training, num_looks, false_alarm_rate)
    return float(num_training * (1 - share) / share)


@lru_cache(maxsize=256)
def os_factor(false_alarm_rate: float, rank: float, num_training: float, num_looks: int) -> tuple[float, float]:
    """(level of the ranked training cell in units of the mean noise, threshold over that mean).

    Exact for independent gamma cells: the rate is the mean of P(cell > threshold z) over the ranked cell's density.
    For one look it is Rohling's product over i < rank of (N - i) / (N - i + T).
    """
    from scipy.optimize import brentq
    from scipy.special import betaln, gammainc, gammaincc, gammaincinv, gammaln

    above = num_training - rank + 1
    log_z = np.linspace(np.log(1e-6), np.log(1e3), 4000) + np.log(num_looks)
    z = np.exp(log_z)
    below, beyond = np.maximum(gammainc(num_looks, z), 1e-300), np.maximum(gammaincc(num_looks, z), 1e-300)
    log_density = (
        (rank - 1) * np.log(below) + (above - 1) * np.log(beyond) - betaln(rank, above)
        + num_looks * log_z - z - gammaln(num_looks)
    )  # fmt: skip
    density = np.exp(log_density) * (log_z[1] - log_z[0])

    def excess(log_factor: float) -> float:
        rate = float(density @ gammaincc(num_looks, np.exp(log_factor) * z))
        return np.log(max(rate, 1e-300)) - np.log(false_alarm_rate)

    over_ranked = math.exp(float(np.asarray(brentq(excess, math.log(1e-3), math.log(1e6)))))
    level = float(gammaincinv(num_looks, rank / (num_training + 1)) / num_looks)
    return level, over_ranked * level


def _check(power: RangeDopplerMap, false_alarm_rate: float) -> None:
    if not 0 < false_alarm_rate < 1:
        raise InputError(f"the false alarm rate must lie between 0 and 1, not {false_alarm_rate}")
    if power.shape[1] * power.shape[2] < 2:
        raise InputError("a range-Doppler map of one cell has no training cells")


def _half_extents(num_doppler: int, cells: CfarCells) -> tuple[int, int]:
    """Guard and total half extents in Doppler, limited so that no cell occurs twice on the cyclic axis."""
    limit = (num_doppler - 1) // 2
    guard = min(cells.guard[1], limit)
    return guard, min(guard + cells.training[1], limit)


def _rings(num_range: int, num_doppler: int, cells: CfarCells, correlation: np.ndarray | None) -> list[_Ring]:
    """The training ring of each range bin."""
    flat = None if correlation is None else tuple(correlation.ravel().tolist())
    return _known_rings(num_range, num_doppler, cells, flat)


@lru_cache(maxsize=32)
def _known_rings(num_range: int, num_doppler: int, cells: CfarCells, flat: tuple[float, ...] | None) -> list[_Ring]:
    """The rings, which maps of one size share: they take as long as all else of CFAR in ten frames."""
    correlation = None if flat is None else np.array(flat).reshape(POWER_CORRELATION.shape)
    guard, whole = cells.guard[0], cells.guard[0] + cells.training[0]
    extents = (guard, *_half_extents(num_doppler, cells))
    known: dict[tuple[int, int], _Ring] = {}
    rings = []
    for at in range(num_range):
        cut = (min(at, whole), min(num_range - 1 - at, whole))
        if cut not in known:
            known[cut] = _ring(cut, extents, correlation)
        rings.append(known[cut])
    return rings


def _ring(cut: tuple[int, int], extents: tuple[int, int, int], correlation: np.ndarray | None) -> _Ring:
    """The ring from the available bins nearer and farther, and half extents (guard range, guard and total Doppler)."""
    guard, guard_doppler, whole_doppler = extents
    in_range, in_doppler = np.arange(-cut[0], cut[1] + 1), np.arange(-whole_doppler, whole_doppler + 1)
    is_training = (np.abs(in_range)[:, None] > guard) | (np.abs(in_doppler)[None, :] > guard_doppler)
    row, column = np.nonzero(is_training)
    if not len(row):
        raise InputError("the range-Doppler map is too small for training cells; use fewer guard cells")
    independent = float(len(row)) if correlation is None else _num_independent(is_training, correlation)
    return _Ring(range_offset=in_range[row], doppler_offset=in_doppler[column], num_independent=independent)


def _num_independent(is_training: np.ndarray, correlation: np.ndarray) -> float:
    """Effective number of independent cells: N^2 over the sum of all pairwise correlations."""
    mask = np.pad(is_training.astype(float), ((2, 2), (2, 2)))
    pairs = 0.0
    for rows in range(-2, 3):
        for columns in range(-2, 3):
            both = mask * np.roll(mask, (rows, columns), (0, 1))
            pairs += float(correlation[abs(rows), abs(columns)] * both.sum())
    return float(mask.sum()) ** 2 / pairs


@lru_cache(maxsize=16)
def _exceedance_correlation(num_looks: int) -> np.ndarray:
    """As POWER_CORRELATION, but of the event that a cell exceeds the OS quantile, which governs an ordered cell.

    Kibble's expansion of two correlated gamma variables in Laguerre polynomials; integrated from the quantile up,
    each term is r^n c_n^2.
    """
    from scipy.special import eval_genlaguerre, gammaincinv, gammaln

    order = np.arange(1, 60)
    level = gammaincinv(num_looks, OS_QUANTILE)
    log_scale = num_looks * math.log(level) - level - 0.5 * gammaln(num_looks)
    log_norm = 0.5 * (gammaln(order + 1) - gammaln(num_looks + order)) - np.log(order)
    term = (eval_genlaguerre(order - 1, num_looks, level) * np.exp(log_norm + log_scale)) ** 2
    shared = np.sum(term * POWER_CORRELATION[..., None] ** order, axis=-1) / (OS_QUANTILE * (1 - OS_QUANTILE))
    shared[0, 0] = 1.0
    return shared


def _ring_mean(power: RangeDopplerMap, cells: CfarCells) -> RangeDopplerMap:
    """Mean of the training cells, from box sums."""
    guard, whole = cells.guard[0], cells.guard[0] + cells.training[0]
    guard_doppler, whole_doppler = _half_extents(power.shape[2], cells)
    outer, outer_count = _box_sum(power, whole, whole_doppler)
    inner, inner_count = _box_sum(power, guard, guard_doppler)
    return np.maximum(outer - inner, 0) / (outer_count - inner_count)[:, None]


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
