"""Features of the board: noise and IF response, TX-RX leakage, first chirp, drift."""

import numpy as np

from mmweaver.evaluation.finding import FrameValues, feature
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence, decibels
from mmweaver.signal.windows import hann, noise_share

LAST_SHARE, NEAR_BINS, MIDDLE = 0.05, slice(2, 7), (0.3, 0.8)
LEAKAGE_M = 0.15  # largest apparent range of leakage, through cables and radome
SKIRT_OVER_NOISE, COVERED_OVER_LOWEST = 2.0, 10.0
CHIRPS_AFTER = slice(2, 6)  # reference for the first chirp of a frame
UNITS, MAX_VARIATION = {"amplitude": "%", "phase": "mrad"}, {"amplitude": 0.3, "phase": 2.0}
STILL_SHARE = 1e-3  # maximum moving / static energy of a static range bin
MIN_DRIFT_FRAMES = 8
MIN_DRIFT_SPAN_M = 0.5  # range spanned by static cells
WRAPPED_BINS = 3  # last range bins, where window sidelobes of range 0 wrap around


@feature("if_last_of_band", "noise in the last 5 % of the band", "dB", 1.0)
def last_of_band(evidence: SignalEvidence) -> FrameValues:
    """Noise in the last 5 % of the beat frequencies over that from 30 to 80 % of them, in dB.

    The receiver's anti-aliasing filter rolls off there.

    Raises:
        CannotSeeError: If the cube does not contain all range bins, or there are too few loops.
    """
    noise = evidence.noise_of_band
    count = noise.shape[1]
    return FrameValues(decibels(np.median(noise[:, int((1 - LAST_SHARE) * count) :], axis=1) / _middle(noise)))


@feature("if_near_band", "noise in range bins 2 to 6", "dB", 1.0)
def near_band(evidence: SignalEvidence) -> FrameValues:
    """Noise in range bins 2 to 6 over that from 30 to 80 % of the band, in dB: the IF high-pass filter.

    Raises:
        CannotSeeError: If the cube does not contain all range bins, or there are too few loops.
    """
    noise = evidence.noise_of_band
    return FrameValues(decibels(np.median(noise[:, NEAR_BINS], axis=1) / _middle(noise)))


@feature("noise_level", "noise of a sample", "dBm", 3.0)
def noise_level(evidence: SignalEvidence) -> FrameValues:
    """Noise power of one ADC sample at the receiver's port in dBm. Raises CannotSeeError without a known scale.

    Raises:
        CannotSeeError: If the amplitude scale is unknown, or there are too few loops.
    """
    scale = evidence.cube.scale
    if not np.isfinite(scale):
        raise CannotSeeError("the amplitude scale of the recording is unknown")
    return FrameValues(decibels(evidence.noise / evidence.noise_share * scale**2))


@feature("strongest_over_noise", "strongest static bin over noise", "dB", 6.0)
def strongest_over_noise(evidence: SignalEvidence) -> FrameValues:
    """Strongest static range bin beyond 0.5 m over the noise of one ADC sample, in dB. Raises CannotSeeError.

    Raises:
        CannotSeeError: If no range bin lies beyond 0.5 m, or there are too few loops.
    """
    far = evidence.in_window & (evidence.range_m >= 0.5)
    if not far.any():
        raise CannotSeeError("no range bin beyond 0.5 m")
    return FrameValues(decibels(evidence.still_power[:, far].max(axis=1) / evidence.noise * evidence.noise_share))


@feature("leakage_level", "leakage near range 0 over noise", "dB", 4.0)
def leakage_level(evidence: SignalEvidence) -> FrameValues:
    """Strongest static power within 0.15 m over the noise of a chirp's range bin, in dB.

    Transmitters couple into receivers across the board and the radome. The reference is a single chirp, so that the
    number of loops does not matter: a cell of a frame with N loops has 10 log10(N / 1.5) dB less noise.

    Raises:
        CannotSeeError: If the range window does not start at 0, samples are real, or there are too few loops.
    """
    noise = evidence.noise_at_range_0 / noise_share(1, evidence.cube.config.num_loops)
    return FrameValues(decibels(evidence.still_power[:, evidence.range_m <= LEAKAGE_M].max(axis=1) / noise))


@feature("leakage_spread", "leakage, strongest over weakest pair", "dB", 4.0)
def leakage_spread(evidence: SignalEvidence) -> FrameValues:
    """Strongest over weakest pair of transmitter and receiver within 0.15 m, in dB. Raises CannotSeeError.

    Raises:
        CannotSeeError: If the range window does not start at 0, samples are real, or there are too few loops.
    """
    _ = evidence.noise_at_range_0
    pairs = (np.abs(evidence.still[:, evidence.range_m <= LEAKAGE_M]) ** 2).max(axis=1)
    return FrameValues(decibels(pairs.max(axis=1) / np.maximum(pairs.min(axis=1), 1e-300)))


@feature("leakage_skirt", "end of the leakage's skirt", "m", 0.2, whole_frames=True)
def leakage_skirt(evidence: SignalEvidence) -> FrameValues:
    """Range in m at which the skirt of the leakage has fallen to 3 dB over the noise of a cell.

    Raises:
        CannotSeeError: If an echo covers the end of the skirt, or the signal does not show leakage.
    """
    noise = evidence.noise_at_range_0
    power = evidence.still_power / noise[:, None]
    first = evidence.still_power[:, evidence.range_m <= LEAKAGE_M].argmax(axis=1)
    values = np.full(len(power), np.nan)
    covered_m = []
    for frame, (own, start) in enumerate(zip(power, first, strict=True)):
        lowest = np.minimum.accumulate(own[start:])
        quiet = np.flatnonzero(own[start:] <= SKIRT_OVER_NOISE)
        echo = np.flatnonzero(own[start:] > COVERED_OVER_LOWEST * lowest)
        if len(echo) and (not len(quiet) or echo[0] < quiet[0]):
            covered_m.append(evidence.range_m[start + echo[0]])
        elif len(quiet):
            values[frame] = evidence.range_m[start + quiet[0]]
    if not np.isfinite(values).any():
        where = f"an echo at {np.median(covered_m):.2f} m covers" if covered_m else "the range window ends before"
        raise CannotSeeError(f"{where} its end")
    return FrameValues(values)


def first_chirp(evidence: SignalEvidence) -> tuple[np.ndarray, np.ndarray]:
    """Deviation of a frame's first chirp from the third to sixth of its transmitter, in static cells.

    Deviations of other transmitters in the same loop are movement and are subtracted.

    Args:
        evidence: Signal with raw samples.

    Returns:
        Amplitude in % and phase in mrad, (frame,) each.

    Raises:
        CannotSeeError: Without raw samples, with too few loops or static range bins, or if later chirps vary too much.
    """
    adc = evidence.signal.adc
    if adc is None:
        raise CannotSeeError("the windowed cube is blind to the first chirp; it takes raw samples")
    if not evidence.has_doppler:
        raise CannotSeeError(f"{adc.config.num_loops} loops per frame are too few")
    frames = len(evidence.still)
    loops = adc.samples[:frames, : CHIRPS_AFTER.stop]
    spectrum = np.fft.fft(loops * hann(adc.config.num_samples), axis=-1)[..., _still_bins(evidence)]
    later = spectrum[:, CHIRPS_AFTER].mean(axis=1, keepdims=True)
    own = (spectrum * later.conj()).sum(axis=(3, 4)) / (np.abs(later) ** 2).sum(axis=(3, 4))  # (frame, loop, slot)
    first = 0 if adc.config.is_coded else adc.config.tx_order[0]
    rest = [slot for slot in range(own.shape[2]) if slot != first]
    found = []
    for value, name in ((100 * (np.abs(own) - 1), "amplitude"), (1e3 * np.angle(own), "phase")):
        alone = value[:, :, first] - (value[:, :, rest].mean(axis=2) if rest else 0)
        varies = float(np.median(alone[:, CHIRPS_AFTER].std(axis=1))) / np.sqrt(frames)
        if varies > MAX_VARIATION[name]:
            raise CannotSeeError(f"the {name} of its other chirps varies by {varies:.2g} {UNITS[name]}")
        found.append(alone[:, 0])
    return found[0], found[1]


@feature("first_chirp_amplitude", "first chirp of a frame, amplitude", "%", 0.1, whole_frames=True)
def first_chirp_amplitude(evidence: SignalEvidence) -> FrameValues:
    """Amplitude of a frame's first chirp over the third to sixth, minus that of other transmitters.

    Raises:
        CannotSeeError: As in `first_chirp`.
    """
    return FrameValues(first_chirp(evidence)[0])


@feature("first_chirp_phase", "first chirp of a frame, phase", "mrad", 0.5, whole_frames=True)
def first_chirp_phase(evidence: SignalEvidence) -> FrameValues:
    """Phase of a frame's first chirp against the third to sixth, minus that of other transmitters.

    Raises:
        CannotSeeError: As in `first_chirp`.
    """
    return FrameValues(first_chirp(evidence)[1])


@feature("drift", "drift of static cells over frames", "mrad/m", 0.5, whole_frames=True)
def drift(evidence: SignalEvidence) -> FrameValues:
    """Phase of static cells that grows with range, against its mean over the frames: absolute slope in mrad/m.

    A relative oscillator error e rotates a cell at range r by 4 pi r e / wavelength.

    Raises:
        CannotSeeError: As in `drift_slopes`.
    """
    slope, error = drift_slopes(evidence)
    return FrameValues(np.abs(slope), at_most=bool(np.median(np.abs(slope)) < 2 * np.median(error)))


def drift_slopes(evidence: SignalEvidence) -> tuple[np.ndarray, np.ndarray]:
    """Phase slope of static cells over range against the mean of all frames, by weighted least squares.

    Args:
        evidence: Signal of at least eight frames.

    Returns:
        Slope and standard error in mrad/m, (frame,) each.

    Raises:
        CannotSeeError: With too few frames, or static cells that span less than half a metre.
    """
    still = evidence.still
    if len(still) < MIN_DRIFT_FRAMES:
        raise CannotSeeError(f"it takes {MIN_DRIFT_FRAMES} frames, and these are {len(still)}")
    mean = still.mean(axis=0)
    level = (np.abs(mean) ** 2).mean(axis=1)
    moves = (np.abs(still - mean) ** 2).mean(axis=(0, 2))
    config = evidence.cube.config
    wraps = config.first_range_bin + np.arange(still.shape[1]) >= config.num_unambiguous_range_bins - WRAPPED_BINS
    steady = np.flatnonzero((moves < 0.01 * level) & (evidence.range_m > 0.25) & ~wraps)
    range_m = evidence.range_m[steady]
    if len(steady) < 4 or np.ptp(range_m) < MIN_DRIFT_SPAN_M:
        raise CannotSeeError("static cells span less than half a metre")
    phase = np.angle((still[:, steady] * mean[steady].conj()).sum(axis=2))
    weight = np.sqrt(level[steady] / np.maximum(moves[steady], 1e-30 + 1e-9 * level[steady]))
    design = np.stack([np.ones(len(range_m)), range_m], axis=1) * weight[:, None]
    fitted = np.linalg.lstsq(design, (phase * weight).T, rcond=None)[0]
    rest = (phase * weight).T - design @ fitted
    error = np.sqrt(np.linalg.inv(design.T @ design)[1, 1] * (rest**2).sum(axis=0) / (len(range_m) - 2))
    return 1e3 * fitted[1], 1e3 * error


def _middle(noise: np.ndarray) -> np.ndarray:
    low, high = (int(share * noise.shape[1]) for share in MIDDLE)
    return np.median(noise[:, low:high], axis=1)


def _still_bins(evidence: SignalEvidence) -> np.ndarray:
    """Range bins without movement. Raises CannotSeeError if there are none."""
    moving = evidence.moving_profile[0].mean(axis=0)
    still = np.flatnonzero(moving < STILL_SHARE * evidence.still_power.mean(axis=0))
    if not len(still):
        raise CannotSeeError("no range bin is static to a thousandth of its energy")
    return still
