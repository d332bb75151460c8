"""Micro-Doppler: the Doppler spectrum over time, by short-time Fourier transforms over the chirps.

The velocity range is that of the chirps of one transmitter, and the time step is a fraction of a frame; a spectrum
over frames has neither. Where frames follow each other without a pause, windows continue across frames.
Reference: Chen, "The Micro-Doppler Effect in Radar", 2nd ed., ch. 2.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import fft

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, RadarCube
from mmweaver.signal.cube import remove_static_adc
from mmweaver.signal.spectra import range_doppler_power
from mmweaver.signal.windows import MIN_HANN_LOOPS, doppler_window, hann

MAX_WINDOW = 64  # loops
OVERLAP = 4  # windows per window length
MIN_WEIGHT = 1e-3  # lower bound when a Doppler window is undone: a Hann window is zero at the first loop
SIGNAL_DB = 15.0  # range bins down to this level below the strongest are used
FRAMES_A_BLOCK = 20


@dataclass(frozen=True, kw_only=True)
class MicroDoppler:
    """A spectrogram: power (time, doppler), mean of the antennas, over the range bins that hold movement."""

    power: Float[np.ndarray, "time doppler"]
    time_s: Float[np.ndarray, " time"]  # middle of each window
    radial_velocity_mps: Float[np.ndarray, " doppler"]  # ascending
    range_m: tuple[float, float]  # of the nearest and farthest range bin used


def micro_doppler(adc: AdcCube, *, window_loops: int | None = None) -> MicroDoppler:
    """Spectrogram of a recording without its static clutter, over the range bins that contain motion.

    Clutter is the mean chirp of each frame, or of the recording where windows continue across frames.

    Args:
        adc: Samples (frame, loop, slot, rx, sample).
        window_loops: Window length in loops; by default the loops of a frame, at most 64.

    Returns:
        Power in the squared unit of the samples; windows overlap by three quarters.

    Raises:
        InputError: For radars with fewer than four loops per frame and a pause between frames (see `signal.slow_time`).
    """
    config = adc.config
    pause_s = config.frame_period_s - config.active_time_s
    runs_on = pause_s < 0.5 * config.loop_period_s
    longest = config.num_loops * (len(adc.samples) if runs_on else 1)
    width = min(window_loops or min(config.num_loops, MAX_WINDOW), longest)
    if width < MIN_HANN_LOOPS:
        raise InputError(
            f"radar {config.name!r} has {config.num_loops} loops per frame, too few for a micro-Doppler spectrum"
        )
    if not runs_on:
        span = moving_bins(chirp_levels(adc))
        return spectrogram_of_frames(adc, width, span, frame_powers(adc, width, span))
    still = adc.samples.mean(axis=(0, 1), dtype=np.complex128).astype(np.complex64)
    span = moving_bins(chirp_levels(adc, still))
    chirps = np.concatenate([block[..., span] for block in _profiles(adc, still)])
    chirps = chirps.reshape(1, -1, *chirps.shape[2:])
    power = np.stack(
        [one.sum(axis=2) for one in _window_powers(chirps, width, max(1, width // OVERLAP))], 1, dtype=np.float64
    )
    return spectrogram_of_frames(adc, width, span, power)


def window_loops_of(config: RadarConfig) -> int | None:
    """Loops of a window that stays within a frame; None if a frame is too short or windows continue across frames."""
    width = min(config.num_loops, MAX_WINDOW)
    runs_on = config.frame_period_s - config.active_time_s < 0.5 * config.loop_period_s
    return None if runs_on or width < MIN_HANN_LOOPS else width


def frame_powers(adc: AdcCube, width: int, span: slice) -> Float[np.ndarray, "frame window doppler"]:
    """Power of the windows within each frame, mean of the antennas, summed over the range bins of `span`."""
    parts = [
        np.stack([one.sum(axis=2) for one in _window_powers(block[..., span], width, max(1, width // OVERLAP))], 1)
        for block in _profiles(adc, None)
    ]
    return np.concatenate(parts).astype(np.float64)


def spectrogram_of_frames(
    adc: AdcCube, width: int, span: slice, power: Float[np.ndarray, "frame window doppler"]
) -> MicroDoppler:
    """Spectrogram of the powers of all frames.

    Args:
        adc: Samples of any frames, for the radar.
        width: Loops of a window.
        span: Range bins that hold movement, of those that the radar keeps.
        power: Powers of all frames, or of one row of windows across them.
    """
    config = adc.config
    bins = config.first_range_bin + np.array([span.start, span.stop - 1])
    frame_s = np.arange(len(power)) * config.frame_period_s
    return _spectrogram(power, frame_s, config, bins * config.range_resolution_m)


def chirp_levels(adc: AdcCube, still: np.ndarray | None = None) -> Float[np.ndarray, "block range"]:
    """Energy of the range profiles without clutter, of each FRAMES_A_BLOCK frames.

    Args:
        adc: Samples.
        still: Clutter (slot, rx, sample). Default: the mean chirp of each frame.
    """
    return np.stack([(np.abs(block) ** 2).sum(axis=(0, 1, 2)) for block in _profiles(adc, still)])


def moving_bins(levels: Float[np.ndarray, "block range"]) -> slice:
    """Range bins that hold movement, from the energy of all blocks."""
    level = sum(levels)
    near = np.flatnonzero(level >= np.max(level) * 10 ** (-SIGNAL_DB / 10))
    return slice(int(near[0]), int(near[-1]) + 1)


def cube_spectrogram(cube: RadarCube, width: int, hop: int) -> Float[np.ndarray, "frame window range doppler"]:
    """Short-time spectra within each frame, averaged over the antennas. The cube's own Doppler window is undone first.

    Args:
        cube: The cube.
        width: Window length in loops.
        hop: Step between windows in loops.

    Returns:
        Power (frame, window, range, doppler); a windowed tone of amplitude a gives a^2.
    """
    loops = cube.values.shape[2]
    if width == loops:
        return range_doppler_power(cube)[:, None]
    own = doppler_window(loops) / doppler_window(loops).sum()
    own = np.maximum(own, MIN_WEIGHT * own.max()).astype(np.float32)[:, None]
    chirps = (np.asarray(fft.ifft(np.fft.ifftshift(one, axes=1), axis=1)) / own for one in cube.values)
    return np.array([list(_window_powers(one, width, hop)) for one in chirps], np.float64)


def micro_doppler_of_cube(cube: RadarCube) -> MicroDoppler:
    """Spectrogram of a cube: the strongest range bin at each time and velocity, with the windows of `micro_doppler`.

    Args:
        cube: Cube without static clutter (`signal.cube.remove_static`).
    """
    width = min(cube.config.num_loops, MAX_WINDOW)
    power = cube_spectrogram(cube, width, max(1, width // OVERLAP)).max(axis=2)
    return _spectrogram(power, cube.grid.frame_time_s, cube.config, cube.grid.range_m)


def _window_powers(chirps: np.ndarray, width: int, hop: int) -> Iterator[np.ndarray]:
    """Power (first, doppler, ...) of each window over chirps (first, loop, antenna, ...), mean over the antennas."""
    window = (doppler_window(width) / doppler_window(width).sum()).astype(np.float32)
    window = window.reshape(-1, *[1] * (chirps.ndim - 2))
    for start in range(0, chirps.shape[1] - width + 1, hop):
        spectrum = np.asarray(fft.fft(chirps[:, start : start + width] * window, axis=1))
        yield (np.abs(np.fft.fftshift(spectrum, axes=1)) ** 2).mean(axis=2)


def _spectrogram(power: np.ndarray, frame_s: np.ndarray, config: RadarConfig, range_m: np.ndarray) -> MicroDoppler:
    """Spectrogram of power (frame, window, doppler) of frames that begin at `frame_s`."""
    _, windows, width = power.shape
    middle_s = (np.arange(windows) * max(1, width // OVERLAP) + width / 2) * config.loop_period_s
    step_mps = config.wavelength_m / (2 * width * config.loop_period_s)
    return MicroDoppler(
        power=power.reshape(-1, width),
        time_s=(frame_s[:, None] + middle_s).ravel(),
        radial_velocity_mps=(np.arange(width) - width // 2) * step_mps,
        range_m=(float(range_m[0]), float(range_m[-1])),
    )


def _profiles(adc: AdcCube, still: np.ndarray | None) -> Iterator[np.ndarray]:
    """Range profiles of every chirp without clutter, (frame, loop, slot * rx, range), block by block.

    `still` (slot, rx, sample) is subtracted; without it the mean chirp of each frame.
    """
    config = adc.config
    window = hann(config.num_samples)
    weight = (window / window.sum()).astype(np.float32)
    kept = slice(config.first_range_bin, config.first_range_bin + config.num_range_bins)
    for start in range(0, len(adc.samples), FRAMES_A_BLOCK):
        part = AdcCube(samples=adc.samples[start : start + FRAMES_A_BLOCK], config=config, scale=adc.scale)
        moving = remove_static_adc(part).samples if still is None else part.samples - still
        profile = np.asarray(fft.fft(moving * weight, axis=-1))[..., kept]
        yield profile.reshape(*profile.shape[:2], -1, profile.shape[-1])
