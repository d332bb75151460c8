"""FFT windows and their noise bandwidth.

Spectrum of a window that is symmetric about its middle: real, even and smooth.
"""

import numpy as np
import torch
from jaxtyping import Float
from torch import Tensor

STEPS_A_BIN = 32
PHASES = 16  # pieces per bin of the table for whole-bin steps, accurate to 3e-6


class WindowKernel:
    """Response K(x) of a window at x bins from a tone, with phase relative to the window's middle m; K(0) = 1.

    K(x) = sum_n w[n] cos(2 pi x (n - m) / N) / sum(w). m is N/2 for windows with w[n] = w[N - n] and w[0] = 0 (a
    periodic Hann), (N - 1)/2 for those with w[n] = w[N - 1 - n] (a rectangle). Piecewise cubic, accurate to 1e-6. The
    DFT of the window itself is exp(-j 2 pi x m / N) K(x).
    """

    def __init__(self, window: Float[np.ndarray, " num"]):
        """Tabulates the spectrum.

        Args:
            window: Window (num,), symmetric about its middle.

        Raises:
            ValueError: For a window that is not symmetric.
        """
        num = len(window)
        if np.allclose(window[1:], window[1:][::-1]) and abs(window[0]) <= 1e-9 * window.max():
            self.middle = num / 2
        elif np.allclose(window, window[::-1]):
            self.middle = (num - 1) / 2
        else:
            raise ValueError("the window is not symmetric about its middle")
        self.num = num
        self._window = np.asarray(window, np.float64)
        self._by_phase = np.zeros((PHASES, 4, 0), np.float32)
        self._changes_sign = round(2 * self.middle) % 2 == 1  # from one period to the next
        place = np.arange(0, num * STEPS_A_BIN // 2 + 2 * STEPS_A_BIN) / STEPS_A_BIN
        value, slope = _spectrum(self._window, self.middle, place)
        # (coefficient, piece): four short lookups are four times faster than one long one
        self._pieces = torch.from_numpy(_cubics(value, slope / STEPS_A_BIN).T.copy()).to(torch.float32)

    def __call__(self, x: Tensor) -> tuple[Tensor, Tensor]:
        """Value and slope (per bin) of K; differentiable.

        Args:
            x: Offsets (...) in bins, of any size.

        Returns:
            Values and slopes, (...) each.
        """
        periods = torch.round(x / self.num)
        folded = x - periods * self.num
        even = 1 - 2 * (periods % 2) if self._changes_sign else 1.0
        sign = torch.sign(folded) * even
        step = folded.abs() * STEPS_A_BIN
        index = step.detach().floor()
        t = step - index
        flat = index.flatten().int()
        c0, c1, c2, c3 = (piece.index_select(0, flat).view(x.shape) for piece in self._pieces.to(x))
        value = torch.addcmul(c0, t, torch.addcmul(c1, t, torch.addcmul(c2, t, c3)))
        slope = torch.addcmul(c1, t, torch.addcmul(2 * c2, t, c3, value=3)) * STEPS_A_BIN
        return value * even, slope * sign

    def bin_values(self, first: float, num: int, place: Float[np.ndarray, "*tone"]) -> Float[np.ndarray, "2 *tone bin"]:
        """Values and slopes (per bin) of tones at consecutive bins.

        All bins of a tone have the same position within their pieces, and the pieces are consecutive in the table.

        Args:
            first: First bin.
            num: Number of bins.
            place: Positions (*tone) in bins.

        Returns:
            Values and slopes (2, *tone, bin), float32.
        """
        period = 2 * self.num  # with its change of sign
        if self._by_phase.shape[2] < period + num:
            self._by_phase = self._table(period + num)
        start = (first - place).astype(np.float64)
        whole = np.floor(start)
        step = (start - whole) * PHASES
        phase = np.minimum(step.astype(np.int64), PHASES - 1)
        windows = np.lib.stride_tricks.sliding_window_view(self._by_phase, num, axis=2)
        c0, c1, c2, c3 = np.moveaxis(windows[phase, :, whole.astype(np.int64) % period], -2, 0)
        t = (step - phase).astype(np.float32)[..., None]
        out = np.empty((2, *c0.shape), np.float32)
        value, slope = out
        np.multiply(c3, t, out=value)
        np.multiply(value, 3, out=slope)
        slope += 2 * c2
        slope *= t
        slope += c1
        slope *= PHASES
        value += c2
        value *= t
        value += c1
        value *= t
        value += c0
        return out

    def _table(self, num: int) -> Float[np.ndarray, "phase coefficient bin"]:
        place = np.arange(num * PHASES + 1) / PHASES
        value, slope = _spectrum(self._window, self.middle, place, PHASES)
        pieces = _cubics(value, slope / PHASES).reshape(num, PHASES, 4)
        return np.ascontiguousarray(pieces.transpose(1, 2, 0), np.float32)


def _spectrum(
    window: np.ndarray, centre: float, place: np.ndarray, steps: int = STEPS_A_BIN
) -> tuple[np.ndarray, np.ndarray]:
    """K and dK/dx at x = k / steps, from one long FFT each."""
    num = len(window)
    middle = np.arange(num) - centre
    long = num * steps
    index = np.arange(len(place))
    phasor = np.exp(2j * np.pi * centre * index / long)
    weight = window / window.sum()
    value = np.real(np.resize(np.fft.fft(weight, long), len(place)) * phasor)
    slope = np.real(np.resize(np.fft.fft(-2j * np.pi / num * middle * weight, long), len(place)) * phasor)
    return value, slope


def _cubics(value: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Hermite pieces: coefficients (piece, 4) of 1, t, t^2, t^3."""
    rise = value[1:] - value[:-1]
    low, high = slope[:-1], slope[1:]
    return np.stack([value[:-1], low, 3 * rise - 2 * low - high, low + high - 2 * rise], axis=1)


MIN_HANN_LOOPS = 4  # loops; a shorter Hann window would discard a third of the chirps or more, and resolve nothing


def doppler_window(num_loops: int) -> Float[np.ndarray, " num_loops"]:
    """Window over the loops of a frame: Hann, or rectangular for fewer than four loops, which keeps all chirps.

    >>> doppler_window(2).tolist()
    [1.0, 1.0]
    """
    return hann(num_loops) if num_loops >= MIN_HANN_LOOPS else np.ones(num_loops)


def doppler_window_middle(num_loops: int) -> float:
    """Loop about which `doppler_window` is symmetric; a periodic Hann window has its zero at both ends."""
    return num_loops / 2 if num_loops >= MIN_HANN_LOOPS else (num_loops - 1) / 2


def noise_share(num_samples: int, num_loops: int) -> float:
    """Noise power per cell of the cube, for white noise of unit power per sample, after both normalised windows.

    Args:
        num_samples: Samples per chirp.
        num_loops: Loops per frame.
    """
    windows = hann(num_samples), doppler_window(num_loops)
    return float(np.prod([(window**2).sum() / window.sum() ** 2 for window in windows]))


def hann(num: int) -> Float[np.ndarray, " num"]:
    """Periodic Hann window, 0.5 - 0.5 cos(2 pi n / num); its spectrum has three bins, 1 and twice -1/2.

    Args:
        num: Length.

    >>> hann(4).round(12).tolist()
    [0.0, 0.5, 1.0, 0.5]
    >>> hann(1).tolist()
    [1.0]
    """
    if num == 1:
        return np.ones(1)
    return 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(num) / num)
