"""Point clouds: CFAR detections with interpolated range, velocity, azimuth and elevation.

Constant false alarm rate (CFAR) detection on range-Doppler power, with thresholds from noise statistics.

The mean of |.|^2 of noise over M antennas ("looks") is gamma distributed with shape M. Hann windows correlate
neighbouring cells, so a ring of N training cells has fewer effective independent ones; both are accounted for.

Reference: Richards, Fundamentals of Radar Signal Processing, ch. 6.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Bool, Complex, Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.core.shapes import RangeDopplerMap, RangeDopplerMask
from mmweaver.core.virtual_array import azimuth_row, elevation_rows
from mmweaver.signal.spectra import moving_doppler, range_doppler_power, steering
from mmweaver.signal.windows import MIN_HANN_LOOPS

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


LAST_SHARE = 0.95  # usable share of the range axis of complex samples; TI's receivers pass 0.9 of the sampling rate
AZIMUTH_PEAK_DB, MAX_AZIMUTH_PEAKS = 6.0, 3  # below the highest peak of a cell; per cell
NUM_DIRECTION_COSINES = 129  # spaced by a sixteenth of the beamwidth of eight antennas


@dataclass(frozen=True, kw_only=True)
class _Cells:
    """Detected cells, one row each."""

    frame: Int[np.ndarray, " cell"]
    range_m: Float[np.ndarray, " cell"]
    radial_velocity_mps: Float[np.ndarray, " cell"]
    snr_db: Float[np.ndarray, " cell"]
    signal: Complex[np.ndarray, "cell antenna"]


def point_cloud(
    cube: RadarCube,
    *,
    false_alarm_rate: float = 1e-4,
    max_points_per_frame: int = 128,
    moving_only: bool = False,
) -> PointCloud:
    """Detections in the radar's coordinates, with range, velocity and azimuth interpolated between bins.

    1. Cell-averaging CFAR on the range-Doppler power; a detection counts where it peaks along range or along Doppler.
    2. Azimuth by beamforming on the horizontal row: every peak within 6 dB of the highest of the cell is a separate
       point, up to three.
    3. Elevation from the phase between two rows, 0 where the array has none.

    Args:
        cube: The cube.
        false_alarm_rate: Probability that a cell of noise is detected.
        max_points_per_frame: Limit; the points of highest SNR are kept.
        moving_only: Whether the Doppler bins of static clutter are omitted.

    Returns:
        Points of all frames, in each frame by decreasing SNR.

    Raises:
        InputError: For a limit below 1.
    """
    if max_points_per_frame < 1:
        raise InputError(f"max_points_per_frame must be at least 1, not {max_points_per_frame}")
    power = range_doppler_power(cube)
    used_bins = moving_doppler(cube) if moving_only else np.ones(power.shape[2], bool)
    found = ca_cfar(
        power[:, :, used_bins],
        false_alarm_rate=false_alarm_rate,
        num_looks=cube.values.shape[-1],
        cells=CfarCells().within(power.shape[2]),
    )
    detections = _detected_cells(cube, power, found, used_bins)
    which, direction, gain_db = _azimuth_peaks(cube, detections.signal)
    up = _elevation(cube, detections.signal[which], direction)
    ahead_squared = 1 - direction**2 - up**2
    snr_db = detections.snr_db[which] + gain_db
    strongest = _strongest(detections.frame[which], snr_db, ahead_squared > 0, max_points_per_frame)
    which, direction, up = which[strongest], direction[strongest], up[strongest]
    range_m = detections.range_m[which]
    return PointCloud(
        frame=detections.frame[which],
        x_m=range_m * direction,
        y_m=range_m * np.sqrt(ahead_squared[strongest]),
        z_m=range_m * up,
        radial_velocity_mps=detections.radial_velocity_mps[which],
        snr_db=snr_db[strongest],
    )


def _detected_cells(cube: RadarCube, power: RangeDopplerMap, found: CfarResult, used_bins: np.ndarray) -> _Cells:
    """Interpolated peaks of the detections, with the residual TDM phase of their antenna signals removed."""
    candidates = found.is_detected & _peaks(power)[:, :, used_bins] & ~_is_wrapped(cube.config)[:, None]
    frame, row, column = np.nonzero(candidates)
    snr = power[:, :, used_bins][frame, row, column] / np.maximum(found.noise_power[frame, row, column], 1e-300)
    doppler = np.flatnonzero(used_bins)[column]
    config = cube.config
    num_range, num_doppler = power.shape[1:]
    at = power[frame, row, doppler]
    nearer, farther = (
        power[frame, np.maximum(row - 1, 0), doppler],
        power[frame, np.minimum(row + 1, num_range - 1), doppler],
    )
    range_offset = np.where((row > 0) & (row < num_range - 1), _parabola(nearer, at, farther), 0.0)
    slower, faster = power[frame, row, doppler - 1], power[frame, row, (doppler + 1) % num_doppler]
    doppler_offset = _parabola(slower, at, faster) if num_doppler > 2 else np.zeros(len(at))
    step_mps = config.velocity_resolution_mps
    velocity = cube.grid.radial_velocity_mps[doppler] + doppler_offset * step_mps
    delay_s = config.antenna_delay_s
    residual_hz = 2 * doppler_offset * step_mps / cube.grid.wavelength_m
    signal = cube.values[frame, row, doppler].astype(np.complex128)
    return _Cells(
        frame=frame,
        range_m=cube.grid.range_m[row] + range_offset * config.range_resolution_m,
        radial_velocity_mps=(velocity + config.max_velocity_mps) % (2 * config.max_velocity_mps)
        - config.max_velocity_mps,
        snr_db=10 * np.log10(snr),
        signal=signal * np.exp(-2j * np.pi * residual_hz[:, None] * delay_s),
    )


def _is_wrapped(config: RadarConfig) -> Bool[np.ndarray, " range"]:
    """The end of the range axis of complex samples.

    It is adjacent to range 0 by aliasing, repeats its leakage, and lies outside the receiver's passband.
    """
    bins = config.first_range_bin + np.arange(config.num_range_bins)
    return (bins >= LAST_SHARE * config.num_samples) & config.complex_samples


def _peaks(power: RangeDopplerMap) -> RangeDopplerMask:
    """Local maxima along range or along Doppler (cyclic).

    With fewer than four loops the strongest of each range bin.
    """
    padded = np.pad(power, ((0, 0), (1, 1), (0, 0)))
    along_range = (power >= padded[:, :-2]) & (power >= padded[:, 2:])
    if power.shape[2] < MIN_HANN_LOOPS:
        return along_range & (power == power.max(axis=2, keepdims=True))
    along_doppler = (power >= np.roll(power, 1, 2)) & (power >= np.roll(power, -1, 2))
    return along_range | along_doppler


def _parabola(before: np.ndarray, at: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Vertex of the parabola through three levels in dB, in bins from the middle, at most half a bin away.

    A cell on a slope shifts towards the adjacent peak; 0 at a minimum.
    """
    low, middle, high = (np.log(np.maximum(level, 1e-300)) for level in (before, at, after))
    bend = low - 2 * middle + high
    return np.where(bend < 0, np.clip(0.5 * (low - high) / np.where(bend < 0, bend, -1), -0.5, 0.5), 0.0)


def _azimuth_peaks(
    cube: RadarCube, signal: Complex[np.ndarray, "cell antenna"]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(index of the cell, direction cosine to the right, dB relative to the cell's highest peak), each (peak,)."""
    row = azimuth_row(cube.grid.antenna_position_m, cube.grid.wavelength_m)
    if len(row) < 2 or not len(signal):
        return np.arange(len(signal)), np.zeros(len(signal)), np.zeros(len(signal))
    cosine = np.linspace(-1, 1, NUM_DIRECTION_COSINES)
    direction = np.stack([cosine, np.zeros_like(cosine), np.zeros_like(cosine)])
    # Not BLAS: on some processors a row of its product depends on the number of rows.
    spectrum = np.abs(np.einsum("ca,ad->cd", signal[:, row], steering(cube, row, direction))) ** 2
    inner = spectrum[:, 1:-1]
    is_peak = (inner >= spectrum[:, :-2]) & (inner > spectrum[:, 2:])
    level = np.where(is_peak, inner, 0)
    highest = level.max(axis=1, keepdims=True)
    order = np.argsort(-level, axis=1)[:, :MAX_AZIMUTH_PEAKS]
    ordered = np.take_along_axis(level, order, axis=1)
    which, rank = np.nonzero((ordered > 0) & (ordered >= highest * 10 ** (-AZIMUTH_PEAK_DB / 10)))
    at = order[which, rank] + 1
    offset = _parabola(spectrum[which, at - 1], spectrum[which, at], spectrum[which, at + 1])
    gain_db = 10 * np.log10(spectrum[which, at] / highest[which, 0])
    return which, cosine[at] + offset * (cosine[1] - cosine[0]), gain_db


def _elevation(cube: RadarCube, signal: Complex[np.ndarray, "point antenna"], right: np.ndarray) -> np.ndarray:
    """Direction cosine upwards (point,), from the phase between two rows steered to each point's azimuth."""
    pair = elevation_rows(cube.grid.antenna_position_m, cube.grid.wavelength_m)
    if pair is None:
        return np.zeros(len(signal))
    per_metre = 2j * np.pi / cube.grid.wavelength_m
    column_m = cube.grid.antenna_position_m[:, 0]
    low, high = (
        np.sum(signal[:, row] * np.exp(per_metre * right[:, None] * column_m[row]), axis=1)
        for row in (pair.lower, pair.upper)
    )
    return -np.angle(high * low.conj()) / (2 * np.pi) * cube.grid.wavelength_m / pair.spacing_m


def _strongest(frame: np.ndarray, snr_db: np.ndarray, is_possible: np.ndarray, most: int) -> np.ndarray:
    """Indices of up to `most` valid points of each frame, by frame and decreasing SNR."""
    index = np.flatnonzero(is_possible)
    index = index[np.lexsort((-snr_db[index], frame[index]))]
    _, first, count = np.unique(frame[index], return_index=True, return_counts=True)
    rank = np.arange(len(index)) - np.repeat(first, count)
    return index[rank < most]
