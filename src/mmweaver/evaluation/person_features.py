"""Features of a person: energy behind the moving body, and slow time of a seated one."""

import numpy as np

from mmweaver.evaluation.measured_feature import FrameValues, feature
from mmweaver.evaluation.signal_evidence import NEAREST_BODY_M, CannotSeeError, SignalEvidence, decibels
from mmweaver.signal.slow_time import moving_cells
from mmweaver.signal.windows import hann

BODY_HALF_M = 0.3
MIN_NOISE_SHARE = 0.1  # an energy below a tenth of the noise in its bins cannot be distinguished from none
SLOW_OVER_REST = 100.0  # 20 dB: movement of a seated person's range bin over the median bin
SEATED_MPS = 0.3  # a breathing chest is slower
WINDOW_S = 8.0
MIN_SLOW_FRAMES = 32
MIN_HZ = 0.1


def behind_body(evidence: SignalEvidence, near_m: float, far_m: float) -> FrameValues:
    """Moving energy from `near_m` to `far_m` behind the strongest moving bin over that within 0.3 m of it, in dB.

    Paths body -> room -> radar and back are longer than the direct one: their energy lies behind the body at its own
    Doppler. Raises CannotSeeError.
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
    """Displacement of a seated person from `low_hz` to `high_hz` over all of it, one value per 8 s, in dB.

    Breathing is below 0.6 Hz; what is above 3 Hz is tremor, heart sounds and noise. Raises CannotSeeError.
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
    """Phase (frame,) of the range bin of a seated person. Raises CannotSeeError."""
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
    """Median speed of the strongest moving cell of the frames."""
    moving = np.abs(evidence.cube.grid.radial_velocity_mps) > 0
    frames = np.flatnonzero(evidence.body_bin >= 0)
    power = evidence.power[frames, evidence.body_bin[frames]][:, moving]
    speed = np.abs(evidence.cube.grid.radial_velocity_mps[moving])
    return float(np.median(speed[power.argmax(axis=1)]))


@feature("behind_body_near", "moving energy 0.6 to 1 m behind the body", "dB", 4.0)
def behind_body_near(evidence: SignalEvidence) -> FrameValues:
    """Moving energy 0.6 to 1 m behind the strongest moving range bin, over that within 0.3 m of it."""
    return behind_body(evidence, 0.6, 1.0)


@feature("behind_body_far", "moving energy 1 to 2 m behind the body", "dB", 4.0)
def behind_body_far(evidence: SignalEvidence) -> FrameValues:
    """Moving energy 1 to 2 m behind the strongest moving range bin, over that within 0.3 m of it."""
    return behind_body(evidence, 1.0, 2.0)


@feature("seated_3_to_5_hz", "seated person, 3 to 5 Hz", "dB", 4.0, whole_frames=True)
def seated_3_to_5_hz(evidence: SignalEvidence) -> FrameValues:
    """Energy of a seated person's displacement from 3 to 5 Hz, over all of it above 0.1 Hz."""
    return seated_slow_time(evidence, 3.0, 5.0)


@feature("seated_7_to_10_hz", "seated person, 7 to 10 Hz", "dB", 4.0, whole_frames=True)
def seated_7_to_10_hz(evidence: SignalEvidence) -> FrameValues:
    """Energy of a seated person's displacement from 7 to 10 Hz, over all of it above 0.1 Hz."""
    return seated_slow_time(evidence, 7.0, 10.0)
