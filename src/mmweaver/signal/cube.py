"""Conversion between ADC samples and the range-Doppler cube."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Complex

from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, RadarCube
from mmweaver.signal.windows import MIN_HANN_LOOPS, doppler_window, hann

# Singular values below this share of the largest are rounding errors.
MIN_SINGULAR_VALUE = 1e-9
FRAMES_A_BLOCK = 5  # fit into the cache
STATIC_REMOVALS = ("auto", "mean_chirp", "mean_frame", "none")


def radar_cube(adc: AdcCube, *, compensate_tdm: bool = True) -> RadarCube:
    """Range FFT, Doppler FFT and TDM phase compensation, both FFTs under a Hann window.

    Normalised so that a tone of amplitude a peaks at a (for a radar with real samples: a cosine of amplitude a).
    Keeps the configuration's range bins; Doppler bins increase with radial velocity.
    Reference: docs/radar_primer.md; Bechter et al., "Compensation of motion-induced phase errors in TDM MIMO radars".

    Args:
        adc: Samples (frame, loop, slot, rx, sample).
        compensate_tdm: Whether the phase that the velocity of a cell accumulates until each transmitter's chirp is
            removed; otherwise a moving target appears at a wrong angle.

    Returns:
        Cube (frame, range, doppler, antenna), complex64, with the scale of the samples.
    """
    config = adc.config
    values = np.empty((len(adc.samples), config.num_range_bins, config.num_loops, config.num_antennas), np.complex64)
    # in blocks, so that a long recording needs little more memory than its samples and its cube
    for start in range(0, len(values), FRAMES_A_BLOCK):
        block = slice(start, start + FRAMES_A_BLOCK)
        values[block] = cube_values(adc.samples[block], config, compensate_tdm=compensate_tdm)
    return RadarCube(values=values, grid=CubeGrid.of(config, len(values)), config=config, scale=adc.scale)


def cube_values(samples: Any, config: RadarConfig, *, compensate_tdm: bool = True) -> Any:
    """Values of `radar_cube`, for numpy arrays or torch tensors on any device.

    Args:
        samples: Samples (frame, loop, slot, rx, sample).
        config: The radar.
        compensate_tdm: As in `radar_cube`.

    Returns:
        Values (frame, range, doppler, antenna), complex64.
    """
    window = hann(config.num_samples)
    weight = (window / window.sum()).astype(np.float32)
    if config.complex_samples:
        spectrum = _fft(samples * _like(weight, samples), -1)
    else:
        spectrum = _fft(samples.real * _like(2 * weight, samples), -1)
    kept = spectrum[..., config.first_range_bin : config.first_range_bin + config.num_range_bins]
    frames, loops = kept.shape[:2]
    antennas = kept.reshape(frames, loops, config.num_slots * config.num_rx, config.num_range_bins)
    slow = antennas.swapaxes(1, 3).swapaxes(2, 3)  # (frame, range, loop, antenna)
    values = _fft(slow * _like(doppler_weight(loops)[:, None], samples), 2)
    values = values * _like(slot_compensation(config), samples) if compensate_tdm else values
    return decoded(values, config)


def cropped(cube: RadarCube, config: RadarConfig) -> RadarCube:
    """The part of a cube within another range window of its radar.

    Args:
        cube: The cube.
        config: The same radar with another range window.

    Returns:
        The cube with that window, labelled with `config`.

    Raises:
        InputError: If the cube does not contain the whole window.
    """
    own = cube.config
    first = config.first_range_bin - own.first_range_bin
    last = first + config.num_range_bins
    if first < 0 or last > own.num_range_bins:
        raise InputError(
            f"the cube holds {cube.grid.range_m[0]:.2f} to {cube.grid.range_m[-1]:.2f} m, not"
            f" {config.range_m[0]:.2f} to {config.range_m[-1]:.2f} m; process its samples again with this range"
        )
    grid = replace(cube.grid, range_m=cube.grid.range_m[first:last])
    return replace(cube, values=cube.values[:, first:last], grid=grid, config=config)


def adc_from_cube(cube: RadarCube) -> AdcCube:
    """The ADC samples of least energy whose `radar_cube` is this cube.

    What the cube does not contain is zero: range bins outside its window, and sample 0 and loop 0, where a Hann
    window is zero. A cube that no samples produce (a Doppler spectrum with energy in loop 0) is approximated in the
    least-squares sense.

    Args:
        cube: Cube with TDM compensation.

    Returns:
        Samples (frame, loop, slot, rx, sample), complex64.
    """
    config = cube.config
    turned = encoded(cube.values.astype(np.complex128), config) * slot_compensation(config).conj()
    loops = _inverse_fft(turned, 2)
    weight = doppler_weight(config.num_loops).astype(np.complex128)
    loops *= np.divide(1, weight, out=np.zeros_like(weight), where=np.abs(weight) > MIN_SINGULAR_VALUE)[:, None]
    samples = _samples_of_ranges(loops.transpose(0, 2, 3, 1), config)
    return AdcCube(samples=samples, config=config, scale=cube.scale)


def static_cube(still: np.ndarray, config: RadarConfig) -> RadarCube:
    """One frame of static clutter, from its values at zero Doppler.

    Args:
        still: Values (range, antenna) at zero Doppler, complex.
        config: The radar.

    Returns:
        Cube of one frame, with a scale of 1.
    """
    weight = doppler_weight(config.num_loops).astype(np.complex128)
    response = _fft(weight, 0)[:, None] * slot_compensation(config)
    slots = encoded(still.astype(np.complex128), config)
    values = decoded(slots[:, None, :] * (response / response[config.num_loops // 2]), config)
    return RadarCube(values=values[None].astype(np.complex64), grid=CubeGrid.of(config, 1), config=config, scale=1.0)


def static_samples(static: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Samples of least energy of static clutter, from its values at zero Doppler.

    Args:
        static: Values (range, antenna), complex.
        config: The radar.

    Returns:
        Samples (slot, rx, sample), complex64, the same in every loop.
    """
    return _samples_of_ranges(encoded(static.astype(np.complex128), config).T, config)


def _samples_of_ranges(spectrum: np.ndarray, config: RadarConfig) -> np.ndarray:
    """Range bins (..., slot * rx, range) to samples (..., slot, rx, sample) of least energy, complex64."""
    if not config.complex_samples:
        spectrum = np.concatenate([spectrum.real, spectrum.imag], axis=-1)
    inverse = _range_inverse(config.num_samples, config.first_range_bin, config.num_range_bins, config.complex_samples)
    samples = (spectrum @ inverse).astype(np.complex64)
    return samples.reshape(*spectrum.shape[:-2], config.num_slots, config.num_rx, config.num_samples)


def remove_static_adc(adc: AdcCube) -> AdcCube:
    """Subtracts the mean over the loops of each frame, which removes static clutter per antenna and sample.

    Args:
        adc: Samples (frame, loop, slot, rx, sample).
    """
    still = adc.samples.mean(axis=1, keepdims=True, dtype=np.complex128)
    return AdcCube(samples=(adc.samples - still).astype(np.complex64), config=adc.config, scale=adc.scale)


def remove_static(cube: RadarCube, how: str = "auto") -> RadarCube:
    """Removes static clutter from a cube.

    "mean_chirp" subtracts the mean over the loops of each frame, "mean_frame" the mean over all frames, "none" returns
    the cube unchanged; "auto" is mean_frame for radars with fewer than four loops per frame, otherwise mean_chirp. A
    person who stands still is removed, too.

    The mean over loops is that of the samples before the Doppler window, derived from the Doppler spectrum. It equals
    `remove_static_adc` before `radar_cube` except for the first loop, which a Hann window weights with zero.

    Args:
        cube: The cube.
        how: "auto", "mean_chirp", "mean_frame" or "none".

    Raises:
        InputError: For any other `how`.
    """
    if how not in STATIC_REMOVALS:
        raise InputError(f"unknown static removal {how!r}; known: {', '.join(STATIC_REMOVALS)}")
    if how == "none":
        return cube
    config = cube.config
    if how == "mean_frame" or (how == "auto" and config.num_loops < MIN_HANN_LOOPS):
        mean = cube.values.mean(axis=0, keepdims=True, dtype=np.complex128)
        return replace(cube, values=(cube.values - mean).astype(np.complex64))
    compensation = slot_compensation(config)
    weight = doppler_weight(config.num_loops).astype(np.complex128)
    seen = np.abs(weight) > MIN_SINGULAR_VALUE
    # mean of the loops with non-zero weight = sum over doppler of (mean_of_doppler * spectrum)
    share = np.divide(1, weight, out=np.zeros_like(weight), where=seen) / seen.sum()
    mean_of_doppler = _inverse_fft(share, 0)
    slots = encoded(cube.values, config)
    still = np.einsum("frda,da->fra", slots, mean_of_doppler[:, None] * compensation.conj(), optimize=True)
    response = _fft(weight.copy(), 0)[:, None] * compensation
    values = decoded(slots - still[:, :, None, :] * response, config)
    return RadarCube(values=values.astype(np.complex64), grid=cube.grid, config=config, scale=cube.scale)


def tdm_compensation(config: RadarConfig) -> Complex[np.ndarray, "doppler antenna"]:
    """Refers each virtual antenna's phase to the start of the loop: exp(-j 2 pi f_doppler delay of its transmitter).

    Args:
        config: The radar.

    Returns:
        Factors (doppler, antenna), complex64.
    """
    return _compensation(config, config.antenna_delay_s)


def slot_compensation(config: RadarConfig) -> Complex[np.ndarray, "doppler channel"]:
    """The same per slot and receiver before decoding, (doppler, slot * rx).

    Equal to `tdm_compensation` for TDM radars.
    """
    return _compensation(config, np.repeat(config.tx_delay_s, config.num_rx))


def _compensation(config: RadarConfig, delay_s: np.ndarray) -> np.ndarray:
    doppler_hz = 2 * config.radial_velocity_mps / config.wavelength_m
    return np.exp(-2j * np.pi * doppler_hz[:, None] * delay_s).astype(np.complex64)


def decoded(values: Any, config: RadarConfig) -> Any:
    """Separates simultaneous transmitters.

    Args:
        values: Values (..., slot * rx), an array or a tensor.
        config: The radar; those of a TDM radar are returned unchanged.

    Returns:
        Values (..., antenna).
    """
    return _through(config.tx_decoder, values, config) if config.is_coded else values


def encoded(values: Any, config: RadarConfig) -> Any:
    """The inverse of `decoded`, in the least-squares sense where there are more slots than transmitters.

    Args:
        values: Values (..., antenna), an array or a tensor.
        config: The radar; those of a TDM radar are returned unchanged.

    Returns:
        Values (..., slot * rx).
    """
    return _through(np.linalg.pinv(config.tx_decoder), values, config) if config.is_coded else values


def _through(matrix: np.ndarray, values: Any, config: RadarConfig) -> Any:
    """A matrix (out, in) applied to the transmitters of values (..., in * rx)."""
    apart = values.reshape(*values.shape[:-1], matrix.shape[1], config.num_rx)
    kind = np.complex128 if values.dtype == np.complex128 else np.complex64
    product = _like(matrix.astype(kind), values) @ apart
    return product.reshape(*values.shape[:-1], matrix.shape[0] * config.num_rx)


def _fft(values: Any, axis: int) -> Any:
    """FFT of complex values or real FFT of real ones; `values` may be overwritten.

    scipy keeps single precision and is several times faster than numpy.
    """
    if isinstance(values, np.ndarray):
        from scipy import fft

        if np.iscomplexobj(values):
            return np.asarray(fft.fft(values, axis=axis, overwrite_x=True))
        return np.asarray(fft.rfft(values, axis=axis))
    from torch import fft

    return fft.fft(values, dim=axis) if values.is_complex() else fft.rfft(values, dim=axis)


def _like(values: np.ndarray, samples: Any) -> Any:
    """The array itself for array samples, otherwise a tensor on their device."""
    if isinstance(samples, np.ndarray):
        return values
    import torch

    return torch.from_numpy(values).to(samples.device)


def _inverse_fft(values: np.ndarray, axis: int) -> np.ndarray:
    from scipy import fft

    return np.asarray(fft.ifft(values, axis=axis))


def doppler_weight(num_loops: int) -> Complex[np.ndarray, " loop"]:
    """Normalised Doppler window with the phase ramp that moves zero Doppler to bin num_loops // 2, (loop,)."""
    window = doppler_window(num_loops)
    loop = np.arange(num_loops)
    # reduced to exact integers before the 2 pi, so that zeros of its FFT are zero to rounding
    turn = np.exp(2j * np.pi * ((loop * (num_loops // 2)) % num_loops) / num_loops)
    return (window / window.sum() * turn).astype(np.complex64)


@lru_cache(maxsize=4)
def _range_inverse(num_samples: int, first_bin: int, num_bins: int, complex_samples: bool) -> np.ndarray:
    """Pseudo-inverse of the windowed range FFT, transposed: (range, sample), or (2 range, sample) for real samples."""
    window = hann(num_samples)
    bins = first_bin + np.arange(num_bins)
    turns = np.outer(bins, np.arange(num_samples)) % num_samples / num_samples
    forward = window / window.sum() * np.exp(-2j * np.pi * turns)
    if not complex_samples:
        forward = 2 * np.concatenate([forward.real, forward.imag])
    return np.linalg.pinv(forward, rcond=MIN_SINGULAR_VALUE).T
