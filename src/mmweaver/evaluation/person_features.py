"""Features of a person: multipath energy behind the moving body, and slow time of a seated person."""

import numpy as np

from mmweaver.evaluation.finding import FrameValues, feature
from mmweaver.evaluation.signal_evidence import NEAREST_BODY_M, CannotSeeError, SignalEvidence, decibels
from mmweaver.signal.slow_time import moving_cells
from mmweaver.signal.windows import hann

BODY_HALF_M = 0.3
MIN_NOISE_SHARE = 0.1  # detection limit: energy relative to the noise in its bins
SLOW_OVER_REST = 100.0  # 20 dB: movement in a seated person's range bin relative to the median bin
SEATED_MPS = 0.3  # upper limit for a breathing chest
WINDOW_S = 8.0
MIN_SLOW_FRAMES = 32
MIN_HZ = 0.1


def behind_body(evidence: SignalEvidence, near_m: float, far_m: float) -> FrameValues:
    """Moving energy behind the strongest moving bin relative to that within 0.3 m of it.

    Multipath body -> room -> radar and the reciprocal path are longer than the direct one: their energy appears behind
    the body at the body's own Doppler.

    Args:
        evidence: The signal.
        near_m: Start of the interval behind the body in metres.
        far_m: End of the interval in metres.

    Returns:
        Ratio in dB per frame.

    Raises:
        CannotSeeError: Without movement 13 dB above the noise, or if the range window ends too early.
    """
    profile, noise = evidence.moving_profile
    if not (evidence.body_bin >= 0).any():
        raise CannotSeeError("no movement 13 dB above the noise")
    range_m, step_m = evidence.range_m, evidence.cube.config.range_resolution_m
    values, limited = np.full(len(profile), np.nan), np.zeros(len(profile), bool)
    for frame, body in enumerate(evidence.body_bin):
        behind_m = range_m - range_m[body]
        if body < 0 or behind_m[-1] < far_m - step_m:
            continue
        there = (behind_m >= near_m) & (behind_m <= far_m)
        least = MIN_NOISE_SHARE * float(noise[frame, there].sum())
        energy = float(profile[frame, there].sum())
        limited[frame] = energy < least
        values[frame] = decibels(max(energy, least) / profile[frame, np.abs(behind_m) <= BODY_HALF_M].sum())
    seen = np.isfinite(values)
    if not seen.any():
        raise CannotSeeError(f"the range window ends at {range_m[-1]:.1f} m, less than {far_m:g} m behind the body")
    return FrameValues(values, at_most=bool(limited[seen].mean() > 0.5))


def seated_slow_time(evidence: SignalEvidence, low_hz: float, high_hz: float) -> FrameValues:
    """Energy of a seated person's displacement in a frequency band relative to all above 0.1 Hz.

    Breathing lies below 0.6 Hz; above 3 Hz there are tremor, heart sounds and noise.

    Args:
        evidence: The signal.
        low_hz: Lower end of the band in Hz.
        high_hz: Upper end of the band in Hz.

    Returns:
        Ratio in dB, one value per 8 s.

    Raises:
        CannotSeeError: If the frame rate is too low, or no seated person is found.
    """
    period_s = evidence.cube.config.frame_period_s
    if 0.5 / period_s < high_hz:
        raise CannotSeeError(f"{1 / period_s:.1f} frames per second show nothing above {0.5 / period_s:.1f} Hz")
    from scipy.signal import detrend

    phase, values = _seated_phase(evidence), []
    for part in np.array_split(phase, max(1, int(len(phase) * period_s / WINDOW_S))):
        energy = np.abs(np.fft.rfft(detrend(part) * hann(len(part)))) ** 2
        hz = np.fft.rfftfreq(len(part), period_s)
        values.append(energy[(hz >= low_hz) & (hz < high_hz)].sum() / energy[hz >= MIN_HZ].sum())
    return FrameValues(decibels(np.array(values)))


def _seated_phase(evidence: SignalEvidence) -> np.ndarray:
    """Phase (frame,) of a seated person's range bin. Raises CannotSeeError if there is none."""
    duration_s = len(evidence.still) * evidence.cube.config.frame_period_s
    if len(evidence.still) < MIN_SLOW_FRAMES or duration_s < WINDOW_S:
        raise CannotSeeError(f"slow time needs {WINDOW_S:g} s, and this is {duration_s:.1f} s")
    if (evidence.body_bin >= 0).mean() > 0.5 and _speed_mps(evidence) > SEATED_MPS:
        raise CannotSeeError("the person moves about")
    profile = (np.abs(evidence.still - evidence.still.mean(axis=0)) ** 2).mean(axis=(0, 2))
    far = evidence.range_m >= NEAREST_BODY_M
    if not far.any() or profile[far].max() < SLOW_OVER_REST * np.median(profile[far]):
        raise CannotSeeError("no seated person breathes: no range bin moves 20 dB above the others")
    cells = [cell for cell in moving_cells(evidence.cube) if cell.range_m >= NEAREST_BODY_M]
    if not cells:
        raise CannotSeeError("no range bin has a peak of movement")
    return cells[0].phase_rad


def _speed_mps(evidence: SignalEvidence) -> float:
    """Median over frames of the speed of the strongest moving cell."""
    moving = np.abs(evidence.cube.grid.radial_velocity_mps) > 0
    frames = np.flatnonzero(evidence.body_bin >= 0)
    power = evidence.power[frames, evidence.body_bin[frames]][:, moving]
    speed = np.abs(evidence.cube.grid.radial_velocity_mps[moving])
    return float(np.median(speed[power.argmax(axis=1)]))


@feature("behind_body_near", "moving energy 0.6 to 1 m behind the body", "dB", 4.0)
def behind_body_near(evidence: SignalEvidence) -> FrameValues:
    """Moving energy 0.6 to 1 m behind the strongest moving range bin, over that within 0.3 m of it.

    Raises:
        CannotSeeError: As in `behind_body`.
    """
    return behind_body(evidence, 0.6, 1.0)


@feature("behind_body_far", "moving energy 1 to 2 m behind the body", "dB", 4.0)
def behind_body_far(evidence: SignalEvidence) -> FrameValues:
    """Moving energy 1 to 2 m behind the strongest moving range bin, over that within 0.3 m of it.

    Raises:
        CannotSeeError: As in `behind_body`.
    """
    return behind_body(evidence, 1.0, 2.0)


@feature("seated_3_to_5_hz", "seated person, 3 to 5 Hz", "dB", 4.0, whole_frames=True)
def seated_3_to_5_hz(evidence: SignalEvidence) -> FrameValues:
    """Energy of a seated person's displacement from 3 to 5 Hz, over all of it above 0.1 Hz.

    Raises:
        CannotSeeError: As in `seated_slow_time`.
    """
    return seated_slow_time(evidence, 3.0, 5.0)


@feature("seated_7_to_10_hz", "seated person, 7 to 10 Hz", "dB", 4.0, whole_frames=True)
def seated_7_to_10_hz(evidence: SignalEvidence) -> FrameValues:
    """Energy of a seated person's displacement from 7 to 10 Hz, over all of it above 0.1 Hz.

    Raises:
        CannotSeeError: As in `seated_slow_time`.
    """
    return seated_slow_time(evidence, 7.0, 10.0)
