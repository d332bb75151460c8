"""Scores of complex cubes (NMSE, PSNR, complex SSIM, phase over antennas), the cells that count, and baselines."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Complex

from mmweaver.core.errors import InputError
from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import CubeValues, RangeDopplerMap, RangeDopplerMask
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from studies.scores.map_similarity import ssim_map

AnyComplex = Complex[np.ndarray, "*any"]
CHANCE_RAD = np.pi / 2  # mean absolute error of a uniformly random phase
ACTIVE_DB = 12.0  # above the noise floor


def nmse_db(prediction: CubeValues, truth: CubeValues, where: RangeDopplerMask | None = None) -> float:
    """Energy of the error over energy of the ground truth in dB, over the cells `where` (default: all), all antennas.

    All zeros score 0 dB, lower is better, -inf is perfect; nan where the ground truth has no energy.

    >>> truth = np.ones((1, 2, 2, 1), complex)
    >>> nmse_db(0 * truth, truth), round(nmse_db(0.9 * truth, truth), 9)
    (0.0, -20.0)
    """
    p, t = (prediction, truth) if where is None else (prediction[where], truth[where])
    energy = _energy(t)
    if energy == 0:
        return float("nan")
    error = _energy(p.astype(np.complex128) - t)
    return float(10 * np.log10(error / energy)) if error > 0 else float("-inf")


def psnr_db(prediction: AnyComplex, truth: AnyComplex, *, peak: float) -> float:
    """Peak signal-to-noise ratio in dB: peak^2 over the mean squared error of I and Q together.

    `peak` is the largest |I| or |Q| that counts, see `peak_of`. inf is perfect. On a sparse cube all zeros score
    30 dB and more, so this is not a headline metric: compare it with its baseline.

    >>> truth = np.array([1.0 + 0j, 0, 0, 0])
    >>> round(psnr_db(0 * truth, truth, peak=1.0), 3)
    9.031
    """
    if not peak > 0:
        raise InputError(f"PSNR needs a peak above 0, not {peak}")
    error = _energy(prediction.astype(np.complex128) - truth) / (2 * truth.size)
    return float(10 * np.log10(peak**2 / error)) if error > 0 else float("inf")


def peak_of(truth: AnyComplex) -> float:
    """The largest |I| or |Q|: the data range of the peak-normalised PSNR."""
    return float(max(np.abs(np.real(truth)).max(), np.abs(np.imag(truth)).max()))


def span_of(truth: AnyComplex) -> float:
    """Largest minus smallest value among all I and Q: the data range of the complex SSIM."""
    real, imaginary = np.real(truth), np.imag(truth)
    return float(max(real.max(), imaginary.max()) - min(real.min(), imaginary.min()))


def complex_ssim(prediction: CubeValues, truth: CubeValues, *, data_range: float) -> float:
    """cSSIM: mean SSIM of the (range, doppler) maps of I and of Q over all frames and antennas; 1 is perfect.

    `data_range` is that of the whole cube, see `span_of`. On a sparse cube all zeros score 0.9 and more.
    """
    total = 0.0
    for part in (np.real, np.imag):
        maps = (np.moveaxis(part(values), 3, 1) for values in (prediction, truth))
        total += float(ssim_map(*maps, data_range=data_range).mean())
    return total / 2


def _energy(values: AnyComplex) -> float:
    return float(
        np.sum(np.square(np.real(values), dtype=np.float64)) + np.sum(np.square(np.imag(values), dtype=np.float64))
    )


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


# active cells
@dataclass(frozen=True, kw_only=True)
class Cells:
    """Masks (frame, range, doppler); a cell comprises all its antennas."""

    is_active: RangeDopplerMask  # power more than 12 dB above the noise floor
    is_moving: RangeDopplerMask  # active, outside zero Doppler and its two neighbours
    floor_power: float


def cells_of(cube: RadarCube) -> Cells:
    """The active and the moving cells of a cube.

    Power is the mean of |.|^2 over the antennas. The noise floor is its median over all cells, which is valid as long
    as most cells contain only noise.
    """
    power = range_doppler_power(cube)
    floor = noise_floor(power)
    is_active = power > floor * 10 ** (ACTIVE_DB / 10)
    return Cells(is_active=is_active, is_moving=is_active & moving_doppler(cube), floor_power=floor)


def noise_floor(power: RangeDopplerMap) -> float:
    """Median power over all cells."""
    return float(np.median(power))


# baselines
def all_zeros(truth: RadarCube) -> RadarCube:
    """A cube of zeros."""
    return replace(truth, values=np.zeros_like(truth.values))


def static_mean(truth: RadarCube) -> RadarCube:
    """The mean over the frames of the ground truth, repeated: exact static clutter, no motion."""
    mean = truth.values.mean(axis=0, keepdims=True, dtype=np.complex128).astype(np.complex64)
    return replace(truth, values=np.repeat(mean, len(truth.values), axis=0))


BASELINES = {"zeros": all_zeros, "static_mean": static_mean}
