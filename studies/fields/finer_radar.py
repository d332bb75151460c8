"""Radars with finer physical resolution than a given one, and the baselines of a coarse radar: its own spectrum between
the bins (zero padding) and linear interpolation.
"""

from dataclasses import replace

import numpy as np

from mmweaver.compression.signal_field import antenna_at, coordinates_on
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PoseSequence, RadarCube
from mmweaver.core.shapes import CubeValues
from mmweaver.signal.windows import hann

NO_LIMITS_HZ = (1e9, 1e12)  # a finer radar exists in simulation alone


def more_bandwidth(config: RadarConfig, factor: float) -> RadarConfig:
    """The same centre frequency, times and range axis, `factor` times the bandwidth, so range bins are finer."""
    slope = config.chirp_slope_hz_per_s * factor
    middle_s = config.adc_start_time_s + config.num_samples / config.sample_rate_hz / 2
    return replace(
        config,
        chirp_slope_hz_per_s=slope,
        start_frequency_hz=config.centre_frequency_hz - slope * middle_s,
        num_samples=_whole(config.num_samples * factor),
        sample_rate_hz=config.sample_rate_hz * factor,
        first_range_bin=_whole(config.first_range_bin * factor),
        num_range_bins=_whole(config.num_range_bins * factor),
        frequency_limits_hz=NO_LIMITS_HZ,
    )


def more_loops(config: RadarConfig, factor: float) -> RadarConfig:
    """`factor` times the loops a frame, so Doppler bins are finer; frames get longer where they must."""
    num_loops = _whole(config.num_loops * factor)
    frame_s = max(config.frame_period_s, num_loops * config.loop_period_s)
    return replace(config, num_loops=num_loops, frame_period_s=frame_s)


def more_antennas(config: RadarConfig, factor: float) -> RadarConfig:
    """Receivers `factor` times as dense on the same line; the transmitters stay."""
    rx = np.asarray(config.rx_position_m)
    num = int((len(rx) - 1) * factor + 1e-9) + 1
    dense = antenna_at(rx, np.arange(num) / factor)
    return replace(config, rx_position_m=tuple((float(x), float(y), float(z)) for x, y, z in dense))


def starting_later(pose: PoseSequence, delay_s: float) -> PoseSequence:
    """The same motion on the clock of a radar that starts `delay_s` later."""
    return replace(pose, time_s=pose.time_s - delay_s)


def middle_delay_s(config: RadarConfig, finer: RadarConfig) -> float:
    """How much later the coarse radar must start for the middles of both frames to coincide."""
    return (finer.active_time_s - config.active_time_s) / 2


def spectrum_on(adc: AdcCube, grid: CubeGrid) -> CubeValues:
    """The windowed spectrum of the radar at any ranges and velocities: zero padding at any factor.

    Exact between the bins, and no finer in resolution. Antennas that the radar lacks are interpolated linearly. Complex
    samples only. Raises InputError for a radar with real samples.
    """
    config = adc.config
    if not config.complex_samples:
        raise InputError("spectra between the bins are for radars with complex samples")
    fast, slow = hann(config.num_samples), hann(config.num_loops)
    range_bin = grid.range_m / config.range_resolution_m
    doppler_bin = grid.radial_velocity_mps / config.velocity_resolution_mps
    to_range = _fourier(range_bin, fast)
    to_doppler = _fourier(doppler_bin, slow)
    doppler_hz = 2 * grid.radial_velocity_mps / config.wavelength_m
    turn = np.exp(-2j * np.pi * doppler_hz[:, None] * np.repeat(config.tx_delay_s, config.num_rx))
    native = CubeGrid.of(config, len(adc.samples))
    mix = _linear_mix(coordinates_on(native, grid)[3], config.num_antennas)
    values = np.empty((len(adc.samples), *grid.shape[1:]), np.complex64)
    for frame, samples in enumerate(adc.samples):
        loops = samples.reshape(config.num_loops, config.num_antennas, -1) @ to_range.T
        spectrum = np.einsum("dl,lar->rda", to_doppler, loops, optimize=True) * turn
        values[frame] = spectrum @ mix.T
    return values


def interpolated(cube: RadarCube, grid: CubeGrid, *, is_centred: bool) -> CubeValues:
    """Linear interpolation of the cube along every axis, on the raw or on the phase-centred cube."""
    values = (centred(cube) if is_centred else cube).values
    for axis, at in enumerate(coordinates_on(cube.grid, grid)):
        mix = _linear_mix(at, cube.grid.shape[axis])
        values = np.moveaxis(np.tensordot(mix.astype(np.float32), values, axes=(1, axis)), 0, axis)
    return values * centring_phasor(cube.config, grid).conj()[None, :, :, None] if is_centred else values


def _fourier(bins: np.ndarray, window: np.ndarray) -> np.ndarray:
    """Matrix (bin, sample) whose rows give the windowed spectrum at one position."""
    turns = np.outer(bins, np.arange(len(window))) / len(window)
    return (window / window.sum() * np.exp(-2j * np.pi * turns)).astype(np.complex64)


def _linear_mix(at: np.ndarray, num: int) -> np.ndarray:
    """Matrix (wanted, given) of the weights of the two neighbours; beyond the last cell its value is repeated."""
    return np.stack([np.interp(at, np.arange(num), row) for row in np.eye(num)], axis=1)


def _whole(number: float) -> int:
    if abs(number - round(number)) > 1e-6:
        raise InputError(f"{number:g} is no whole number of samples, loops or bins; choose another factor")
    return round(number)


def centring_phasor(config: RadarConfig, grid: CubeGrid) -> np.ndarray:
    """exp(+j pi r) exp(+j pi d) at the cells of a grid, with r and d in bins of the radar's own transforms.

    The phase of the DFT of a window centred on sample N/2 rotates by -pi per bin; referred to the middle of the window
    instead, a cube is smooth. r counts range bins of the radar's full transform, and d from zero Doppler, so cubes of
    radars with the same centre frequency agree after centring.
    """
    range_bin = grid.range_m / config.range_resolution_m
    doppler_bin = grid.radial_velocity_mps / config.velocity_resolution_mps
    return np.exp(1j * np.pi * (range_bin[:, None] + doppler_bin[None, :])).astype(np.complex64)


def centred(cube: RadarCube) -> RadarCube:
    """The cube with its phase referred to the middle of the chirp and of the frame; lossless."""
    phasor = centring_phasor(cube.config, cube.grid)
    return replace(cube, values=cube.values * phasor[None, :, :, None])
