"""Chirps that were lost on the way from the radar to the file: they take no part in Doppler and angle.

Zeros in place of a chirp would modulate every echo over slow time, and differently per transmitter, which spreads it
over velocities and angles. A lost chirp is estimated instead from the intact chirps of the same transmitter, range bin
by range bin: the linear estimate of least squared error for the Doppler spectrum that the frame's intact chirps show.
Noise, which is the same at all velocities, contributes nothing to it, so the estimate neither adds nor moves echoes,
and the amplitude of a cell stays that of a complete frame.

Reference: Kay, "Fundamentals of Statistical Signal Processing: Estimation Theory", ch. 12 (linear MMSE estimation).
"""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Complex

from mmweaver.core.records import AdcCube
from mmweaver.core.shapes import LostChirps
from mmweaver.signal.windows import hann

NEAREST = 32  # intact loops that a lost chirp is estimated from
ABOVE_NOISE = 10.0  # a velocity whose power is this multiple of the frame's median holds echoes
LOADING = 1e-3  # relative to the power of the bin; bounds the gain of the estimate
MIN_WINDOW = 0.05  # below, samples at the ends of a chirp are not amplified further when the window is undone
MIN_INTACT = 0.5  # share of a transmitter's loops; below, a frame is left out


def without_lost_chirps(adc: AdcCube, is_lost: LostChirps) -> AdcCube:
    """Estimates lost chirps from intact ones; frames with too few intact chirps become zero.

    Args:
        adc: Samples (frame, loop, slot, rx, sample).
        is_lost: Whether any sample of a chirp is missing, (frame, loop, slot).

    Returns:
        Samples of the same shape; frames without losses are unchanged.
    """
    if not is_lost.any():
        return adc
    samples = adc.samples.copy()
    left_out = frames_left_out(is_lost)
    for frame in np.flatnonzero(is_lost.any(axis=(1, 2))):
        samples[frame] = 0 if left_out[frame] else _completed(samples[frame], is_lost[frame])
    return replace(adc, samples=samples)


def frames_left_out(is_lost: LostChirps) -> Bool[np.ndarray, " frame"]:
    """Frames in which a transmitter has fewer than half of its chirps: nothing can be estimated from them."""
    return (~is_lost).mean(axis=1).min(axis=1) < MIN_INTACT


def _completed(
    samples: Complex[np.ndarray, "loop slot rx sample"], is_lost: Bool[np.ndarray, "loop slot"]
) -> Complex[np.ndarray, "loop slot rx sample"]:
    """One frame with its lost chirps estimated."""
    window = hann(samples.shape[-1])
    # windowed, so that the estimate of a strong echo's range sidelobes does not hide weak echoes
    spectrum = np.fft.fft(samples * window, axis=-1)
    spectrum[is_lost] = 0
    correlation = _correlation(spectrum, ~is_lost)
    for loop, slot in zip(*np.nonzero(is_lost), strict=True):
        intact = np.flatnonzero(~is_lost[:, slot])
        near = intact[np.argsort(np.abs(intact - loop), kind="stable")[:NEAREST]]
        weight = _weights(correlation, loop - near, near[:, None] - near)
        spectrum[loop, slot] = np.einsum("nk,krn->rn", weight, spectrum[near, slot])
    estimate = np.fft.ifft(spectrum[is_lost], axis=-1) / np.maximum(window, MIN_WINDOW)
    completed = samples.copy()
    completed[is_lost] = estimate.real if not samples.imag.any() else estimate
    return completed


def _correlation(
    spectrum: Complex[np.ndarray, "loop slot rx range"], is_intact: Bool[np.ndarray, "loop slot"]
) -> Complex[np.ndarray, "lag range"]:
    """Correlation over slow time of each range bin, from its Doppler spectrum with white noise."""
    loops = len(spectrum)
    power = (np.abs(np.fft.fft(spectrum, 2 * loops, axis=0)) ** 2).sum(axis=(1, 2))
    pairs = (np.abs(np.fft.fft(is_intact.astype(float), 2 * loops, axis=0)) ** 2).sum(axis=1)
    count = np.fft.ifft(pairs).real[:loops, None] * spectrum.shape[2]
    lags = np.where(count > 0.5, np.fft.ifft(power, axis=0)[:loops] / np.maximum(count, 0.5), 0)
    lags = lags * (1 - np.arange(loops) / (2 * loops))[:, None]
    both = np.concatenate([lags, np.zeros_like(lags[:1]), lags[1:][::-1].conj()])
    doppler = np.fft.fft(both, axis=0).real
    noise = np.maximum(np.median(doppler, axis=0), 0)
    return np.fft.ifft(np.where(doppler > ABOVE_NOISE * noise, doppler, noise), axis=0)[:loops]


def _weights(correlation: np.ndarray, lag: np.ndarray, lags: np.ndarray) -> Complex[np.ndarray, "range loop"]:
    """Weights of the intact loops in the estimate of a lost one."""

    def at(lag: np.ndarray) -> np.ndarray:
        values = np.moveaxis(correlation[np.abs(lag)], -1, 0)
        return np.where(lag >= 0, values, values.conj())

    power = np.maximum(correlation[0].real, 1e-300)[:, None, None]
    matrix = at(lags) + LOADING * power * np.eye(len(lag))
    return np.linalg.solve(matrix.conj(), at(lag)[..., None])[..., 0]
