"""Breathing and heart rate from the displacement of a cell over time.

A rate is the strongest frequency in its band; it is valid where it stands out from the rest of the band and the
recording is long enough. Harmonics of the breathing are excluded from the search for the heart rate.
Reference: Alizadeh et al., "Remote monitoring of human vital signs using mm-wave FMCW radar", IEEE Access 7, 2019.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import signal as scipy_signal

BREATHING_HZ = (0.1, 0.7)
HEART_HZ = (0.8, 2.5)
CLEAR_DB = 8.0  # peak over the band's median; the heart is weaker, among more harmonics
CLEAR_HEART_DB = 12.0
MIN_PERIODS = 2.0
PAD = 8  # zero-padding factor of the spectra
HARMONICS = 12
MAX_BREATHING_M, MIN_BREATHING_M = 40e-3, 0.1e-3  # peak to peak: more is walking, anything below is noise


@dataclass(frozen=True, kw_only=True)
class Rate:
    """Rate of a vital sign; `is_clear` where it is reliable."""

    frequency_hz: float
    per_minute: float
    peak_over_median_db: float
    is_clear: bool


def breathing_rate(displacement_m: Float[np.ndarray, " frame"], period_s: float) -> Rate | None:
    """Breathing rate from the displacement of a chest.

    Args:
        displacement_m: Displacement (frame,) in metres.
        period_s: Frame period in seconds.

    Returns:
        The rate; None for a recording too short for two periods of the fastest breathing.
    """
    detrended = scipy_signal.detrend(displacement_m)
    found = _rate(detrended, period_s, BREATHING_HZ)
    if found is None:
        return None
    extent_m = float(np.ptp(_band(detrended, period_s, BREATHING_HZ)))
    is_breath = MIN_BREATHING_M <= extent_m <= MAX_BREATHING_M
    return found if is_breath else Rate(**{**vars(found), "is_clear": False})


def heart_rate(
    displacement_m: Float[np.ndarray, " frame"], period_s: float, breathing: Rate | None = None
) -> Rate | None:
    """Heart rate from the velocity of the skin, outside the harmonics of the breathing.

    Args:
        displacement_m: Displacement (frame,) of a chest in metres.
        period_s: Frame period in seconds.
        breathing: The breathing rate, if known.

    Returns:
        The rate; None where there are fewer than 5 frames per second, or too few frames.
    """
    if 1 / period_s < 2 * HEART_HZ[1]:
        return None
    speed = np.gradient(scipy_signal.detrend(displacement_m), period_s)
    avoided = () if breathing is None else tuple(k * breathing.frequency_hz for k in range(1, HARMONICS + 1))
    return _rate(speed, period_s, HEART_HZ, avoided, CLEAR_HEART_DB)


def _rate(
    values: np.ndarray,
    period_s: float,
    band_hz: tuple[float, float],
    avoided_hz: tuple[float, ...] = (),
    clear_db: float = CLEAR_DB,
) -> Rate | None:
    duration_s = len(values) * period_s
    if len(values) < 16 or duration_s * band_hz[1] < MIN_PERIODS:
        return None
    window = np.hanning(len(values))
    power = np.abs(np.fft.rfft(values * window, PAD * len(values))) ** 2
    frequency_hz = np.fft.rfftfreq(PAD * len(values), period_s)
    inside = (frequency_hz >= max(band_hz[0], MIN_PERIODS / duration_s)) & (frequency_hz <= band_hz[1])
    for avoided in avoided_hz:
        inside &= np.abs(frequency_hz - avoided) > 2 / duration_s
    if inside.sum() < 3:
        return None
    at = np.flatnonzero(inside)[power[inside].argmax()]
    peak_db = 10 * np.log10(power[at] / max(float(np.median(power[inside])), 1e-300))
    is_inner = at > 0 and at + 1 < len(power) and power[at] >= power[at - 1] and power[at] >= power[at + 1]
    return Rate(
        frequency_hz=float(frequency_hz[at]),
        per_minute=float(60 * frequency_hz[at]),
        peak_over_median_db=float(peak_db),
        is_clear=bool(is_inner and peak_db >= clear_db),
    )


def _band(values: np.ndarray, period_s: float, band_hz: tuple[float, float]) -> np.ndarray:
    """The components within a frequency band."""
    spectrum = np.fft.rfft(values)
    frequency_hz = np.fft.rfftfreq(len(values), period_s)
    spectrum[(frequency_hz < band_hz[0]) | (frequency_hz > band_hz[1])] = 0
    return np.fft.irfft(spectrum, len(values))
