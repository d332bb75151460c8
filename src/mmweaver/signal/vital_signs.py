"""Breathing and heart rate from the displacement of a cell over time.

A rate is the strongest frequency in its band. That of breathing has a confidence, fitted to generated people whose rate
is known; that of the heart is valid where it stands out from the rest of the band and the recording is long enough.
Harmonics of the breathing are excluded from the search for the heart rate.
Reference: Alizadeh et al., "Remote monitoring of human vital signs using mm-wave FMCW radar", IEEE Access 7, 2019.
"""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import signal as scipy_signal

BREATHING_HZ = (0.1, 0.7)
HEART_HZ = (0.8, 2.5)
CLEAR = 0.9  # least confidence of a clear breathing rate
# logistic regression on contrast in dB and duration in units of 10 s, fitted to 47 generated people (docs/things.md)
CONFIDENCE, MAX_CONTRAST_DB, MAX_DURATION_S = (-9.9, 0.85, 1.5), 20.0, 60.0
CLEAR_HEART_DB, CLEAR_HEART_CONTRAST_DB = 12.0, 8.0  # peak over the band's median, and over what competes with it
MIN_PERIODS = 2.0
LOBE_HZ = 0.08  # on either side of the breathing's peak
PAD = 8  # zero-padding factor of the spectra
HARMONICS = 12
MAX_BREATHING_M, MIN_BREATHING_M = 40e-3, 0.1e-3  # peak to peak: more is walking, anything below is noise


@dataclass(frozen=True, kw_only=True)
class Rate:
    """Rate of a vital sign.

    Attributes:
        frequency_hz: Frequency of the strongest peak in the band.
        per_minute: The same per minute.
        peak_over_median_db: Peak over the band's median.
        is_clear: Whether the rate is reliable: breathing with a confidence of at least CLEAR.
        contrast_db: Peak over the strongest other frequency that is not its harmonic.
        confidence: Of breathing, probability that the rate is right within 0.5 per minute; nan of the heart.
    """

    frequency_hz: float
    per_minute: float
    peak_over_median_db: float
    is_clear: bool
    contrast_db: float = float("nan")
    confidence: float = float("nan")


def breathing_rate(displacement_m: Float[np.ndarray, " frame"], period_s: float) -> Rate | None:
    """Breathing rate from the displacement of a chest.

    Args:
        displacement_m: Displacement (frame,) in metres.
        period_s: Frame period in seconds.

    Returns:
        The rate; None for a recording too short for two periods of the fastest breathing.
    """
    detrended = scipy_signal.detrend(displacement_m)
    # of the velocity, in which sway, whose amplitude falls with the frequency, has no peak
    velocity = np.gradient(detrended, period_s)
    found = _rate(velocity, period_s, BREATHING_HZ)
    if found is None:
        return None
    mean_hz = _mean_frequency(velocity, period_s, found.frequency_hz)
    found = replace(found, frequency_hz=mean_hz, per_minute=60 * mean_hz)
    extent_m = float(np.ptp(_band(detrended, period_s, BREATHING_HZ)))
    is_breath = MIN_BREATHING_M <= extent_m <= MAX_BREATHING_M
    return found if is_breath else replace(found, is_clear=False, confidence=0.0)


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
    clear_db: float | None = None,
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
    # what competes: any slower or other frequency but the peak's own lobe and its second harmonic
    other = (frequency_hz > 0.5 / duration_s) & (frequency_hz <= band_hz[1]) if clear_db is None else inside.copy()
    for own in (frequency_hz[at], 2 * frequency_hz[at]):
        other &= np.abs(frequency_hz - own) > 2 / duration_s
    contrast_db = 10 * np.log10(power[at] / max(float(power[other].max(initial=0.0)), 1e-300))
    confidence = float("nan")
    is_clear = is_inner and clear_db is not None and peak_db >= clear_db and contrast_db >= CLEAR_HEART_CONTRAST_DB
    if clear_db is None:
        confidence = _confidence(float(contrast_db), duration_s) if is_inner else 0.0
        is_clear = confidence >= CLEAR
    return Rate(
        frequency_hz=float(frequency_hz[at]),
        per_minute=float(60 * frequency_hz[at]),
        peak_over_median_db=float(peak_db),
        is_clear=bool(is_clear),
        contrast_db=float(contrast_db),
        confidence=confidence,
    )


def _confidence(contrast_db: float, duration_s: float) -> float:
    """Probability that a rate is right within 0.5 per minute."""
    values = 1.0, min(contrast_db, MAX_CONTRAST_DB), min(duration_s, MAX_DURATION_S) / 10
    return float(1 / (1 + np.exp(-np.dot(CONFIDENCE, values))))


def _mean_frequency(values: np.ndarray, period_s: float, near_hz: float) -> float:
    """Mean frequency of the component near a peak, from the slope of its phase: a peak is that of the middle."""
    half_hz = min(LOBE_HZ, near_hz / 2)
    spectrum, frequency_hz = np.fft.fft(values), np.fft.fftfreq(len(values), period_s)
    spectrum[np.abs(frequency_hz - near_hz) > half_hz] = 0
    inner = slice(len(values) // 20, len(values) - len(values) // 20)
    phase = np.unwrap(np.angle(np.fft.ifft(spectrum)))[inner]
    slope = np.polyfit(np.arange(len(values))[inner] * period_s, phase, 1)[0]
    return float(np.clip(slope / (2 * np.pi), near_hz - half_hz, near_hz + half_hz))


def _band(values: np.ndarray, period_s: float, band_hz: tuple[float, float]) -> np.ndarray:
    """The components within a frequency band."""
    spectrum = np.fft.rfft(values)
    frequency_hz = np.fft.rfftfreq(len(values), period_s)
    spectrum[(frequency_hz < band_hz[0]) | (frequency_hz > band_hz[1])] = 0
    return np.fft.irfft(spectrum, len(values))
