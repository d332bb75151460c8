"""Scores of complex cubes: NMSE, PSNR, complex SSIM. Pure functions of arrays."""

import numpy as np
from jaxtyping import Complex

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import CubeValues, RangeDopplerMask
from mmweaver.metrics.ssim import ssim_map

AnyComplex = Complex[np.ndarray, "*any"]


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
