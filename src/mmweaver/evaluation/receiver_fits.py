"""The receiver from any recording: IF response and noise figure from noise, leakage from the bins near range 0.

The room may be unknown. Noise is measured in the outer Doppler bins, which contain no movement. It has passed the IF
filter and shows its power response, but not its phase.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import torch

from mmweaver.core.constants import BOLTZMANN_J_PER_K, NOISE_TEMPERATURE_K
from mmweaver.core.radar_config import RadarConfig
from mmweaver.evaluation.finding import Finding, measured, signal_fit
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence, decibels
from mmweaver.propagation.cube_rendering import CubeRenderer

MIDDLE = (0.3, 0.8)  # flat part of the band
NEAREST_NOISE_BIN = 2  # nearer bins contain leakage and the ADC's DC offset
NARROW_BINS, NUM_WIDE, NUM_END, LAST_SHARE = 12, 24, 25, 0.9  # knots: each near bin, wide ones, fine ones at the end
SKIRT_LIMIT_M, LEAKAGE_M = 1.5, 0.15
OVER_NOISE, OVER_LOWEST = 2.0, 10.0  # end of a skirt; an echo of the room
MIN_SHARE = 1e-3  # relative to the largest singular value; weaker taps are noise


def sample_noise(evidence: Sequence[SignalEvidence]) -> np.ndarray:
    """Noise power of one ADC sample as a function of range bin.

    Args:
        evidence: Recordings of one radar.

    Returns:
        Median over all frames, (range,).

    Raises:
        CannotSeeError: If a cube does not contain all range bins, or there are too few loops.
    """
    return np.median(np.concatenate([one.noise_of_band[~one.is_lost] / one.noise_share for one in evidence]), axis=0)


@signal_fit("IF response")
def fit_filter(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates the IF power response relative to mid-band from the noise.

    Args:
        evidence: Recordings of one radar.

    Returns:
        `if_share`, `if_gain_db` and zero `if_phase_deg`.

    Raises:
        CannotSeeError: If noise is not available in every range bin.
    """
    noise = sample_noise(evidence)
    count, config = len(noise), evidence[0].cube.config
    level_db = decibels(noise / _middle(noise))
    if not np.isfinite(level_db).all():
        raise CannotSeeError("its noise is zero in some range bins: the samples were filtered or cut")
    edges = _knot_edges(count)
    centre = np.array([(low + high - 1) / 2 for low, high in edges])
    gain_db = np.array([np.median(level_db[low:high]) for low, high in edges])
    share = np.concatenate([[0.0], centre, [count]]) / config.num_samples
    gain_db = np.concatenate([gain_db[:1], gain_db, gain_db[-1:]])
    fields = {"if_share": share, "if_gain_db": gain_db, "if_phase_deg": np.zeros(len(share))}
    last, near = np.median(level_db[int(0.95 * count) :]), np.median(level_db[2:7])
    cells = sum(int(one.far_doppler.sum()) * one.still.shape[0] * one.still.shape[2] for one in evidence)
    error_db = 4.34 / np.sqrt(cells)
    return Finding(
        fields=fields,
        text=f"{last:+.1f} dB in the last 5 % of the band, {near:+.1f} dB in range bins 2 to 6 (+-{error_db:.2f} a"
        " bin); its phase is not in the noise",
    )


def _knot_edges(count: int) -> list[tuple[int, int]]:
    """Range bins (first, end) of each knot."""
    near = [(at, at + 1) for at in range(NEAREST_NOISE_BIN, min(NARROW_BINS, count))]
    wide = np.unique(np.linspace(min(NARROW_BINS, count), LAST_SHARE * count, NUM_WIDE + 1).astype(int))
    end = np.unique(np.linspace(wide[-1], count, NUM_END + 1).astype(int))
    return near + [(int(low), int(high)) for part in (wide, end) for low, high in pairwise(part)]


def _middle(noise: np.ndarray) -> float:
    low, high = (int(share * len(noise)) for share in MIDDLE)
    return float(np.median(noise[low:high]))


@signal_fit("noise figure")
def fit_noise_figure(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates the noise figure if the amplitude scale is known.

    Args:
        evidence: Recordings of one radar.

    Returns:
        `noise_figure_db`.

    Raises:
        CannotSeeError: If the scale is unknown, or there is no noise.
    """
    scale = evidence[0].cube.scale
    if not np.isfinite(scale):
        raise CannotSeeError("the recording's amplitudes have no known scale")
    power = _middle(sample_noise(evidence))
    config = evidence[0].cube.config
    power /= 1 - 1 / (3 * config.num_antennas)  # median / mean of the antenna-averaged noise power
    thermal_mw = BOLTZMANN_J_PER_K * NOISE_TEMPERATURE_K * config.sample_rate_hz * 1e3
    figure_db = float(decibels(power * scale**2 / thermal_mw))
    if not np.isfinite(figure_db):
        raise CannotSeeError("it holds no noise")
    return Finding(
        fields={"noise_figure_db": round(figure_db, 3)},
        text=f"{figure_db:.1f} dB, given the receiver gain of {config.rx_gain_db:g} dB and the converter's range",
    )


def noise_unit(evidence: SignalEvidence) -> float:
    """Amplitude of 1.0 in the recording in sqrt(mW).

    Args:
        evidence: The recording.

    Returns:
        Its own scale, or the one that gives it the nominal noise power of the radar.

    Raises:
        CannotSeeError: If the scale is unknown and there is no noise.
    """
    cube = evidence.cube
    if np.isfinite(cube.scale):
        return float(cube.scale)
    own = float(np.median(evidence.noise)) / evidence.noise_share
    if own <= 0:
        raise CannotSeeError("its scale is unknown, and it holds no noise")
    return float(np.sqrt(cube.config.noise_power_mw / own))


@signal_fit("leakage")
def fit_leakage(evidence: Sequence[SignalEvidence]) -> Finding:
    """Estimates TX-RX leakage and its skirt per antenna pair, from the recording with the longest visible skirt.

    Args:
        evidence: Recordings of one radar.

    Returns:
        `leakage_range_m` (tap,), `leakage_level_db` and `leakage_phase_deg` (tap, tx, rx).

    Raises:
        CannotSeeError: If no recording shows leakage, or transmitters are coded.
    """
    return max(measured(evidence, _leakage), key=lambda one: len(one.fields["leakage_range_m"]))


def _leakage(evidence: SignalEvidence) -> Finding:
    config = evidence.cube.config
    noise = float(np.median(evidence.noise_at_range_0))
    if config.is_coded:
        raise CannotSeeError("simultaneous transmitters do not show it separately")
    unit = noise_unit(evidence)
    still = evidence.mean_still
    end, how = skirt_end((np.abs(still) ** 2).mean(axis=1), noise, evidence.range_m)
    taps_m = np.arange(end) * config.range_resolution_m
    response = tap_response(config, taps_m)[: end + 1]
    taps = np.linalg.pinv(response, rcond=MIN_SHARE) @ still[: end + 1]  # (tap, antenna)
    amplitude = np.maximum(np.abs(taps), 1e-3 * np.sqrt(noise)) * unit
    shape = (len(taps_m), config.num_tx, config.num_rx)
    peak = (np.abs(still[evidence.range_m <= LEAKAGE_M]) ** 2).max(axis=0)
    chirp_noise = noise * config.num_loops / 1.5
    return Finding(
        fields={
            "leakage_range_m": taps_m,
            "leakage_level_db": (20 * np.log10(amplitude) - config.tx_power_dbm).reshape(shape),
            "leakage_phase_deg": np.degrees(np.angle(taps)).reshape(shape),
        },
        text=f"{decibels(peak.mean() / chirp_noise):.1f} dB over the noise of a chirp,"
        f" {decibels(peak.max() / max(peak.min(), 1e-300)):.1f} dB from the weakest to the strongest antenna pair; its"
        f" skirt to {taps_m[-1]:.2f} m, where {how}",
    )


def skirt_end(power: np.ndarray, noise: float, range_m: np.ndarray) -> tuple[int, str]:
    """Finds the end of leakage and its skirt.

    Args:
        power: Static power, (range,).
        noise: Noise power of a cell.
        range_m: Ranges of the bins in metres, (range,).

    Returns:
        Number of range bins, and what ends the skirt: noise, an echo of the room, or the limit.
    """
    first = int(power[range_m <= LEAKAGE_M].argmax())
    most = max(first + 2, int(np.searchsorted(range_m, SKIRT_LIMIT_M)))
    lowest = np.minimum.accumulate(power[first:])
    quiet = np.flatnonzero(power[first:] <= OVER_NOISE * noise)
    echo = np.flatnonzero(power[first:] > OVER_LOWEST * lowest)
    ends = [(most - first, f"{SKIRT_LIMIT_M:g} m are looked at")]
    if len(quiet):
        ends.append((int(quiet[0]), "it falls to the noise of a cell"))
    if len(echo):
        at = int(power[first : first + echo[0] + 1].argmin())  # start of the room's echo
        ends.append((at, f"an echo at {range_m[first + echo[0]]:.2f} m covers the rest"))
    end, how = min(ends)
    return max(first + end, 1), how


def tap_response(config: RadarConfig, range_m: np.ndarray) -> np.ndarray:
    """Response of the range bins at zero Doppler to leakage.

    Args:
        config: The radar.
        range_m: Ranges of the taps in metres, (tap,).

    Returns:
        Response, complex128 (range, tap).
    """
    renderer = CubeRenderer(config)
    return renderer.leakage_response(torch.from_numpy(2 * np.asarray(range_m, float))).T.numpy().astype(complex)
