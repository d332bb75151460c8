"""Emulation of the point cloud of TI's out-of-box demo: windows, fixed-point arithmetic, CFAR, grouping and angles.

Based on the behaviour that TI documents (mmWave SDK User Guide; demo documentation of xWR14xx and xWR16xx); what is
known and what is assumed is listed in docs/decisions/firmware-points.md.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float, Int

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import MAX_OBJECTS, MAX_OBJECTS_3D, FirmwareSettings
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.core.shapes import PerIndex, PerPoint
from mmweaver.core.virtual_array import azimuth_row, elevation_rows
from mmweaver.signal.cube import adc_from_cube
from mmweaver.signal.firmware_cfar import cfar_detections, detection_matrix, is_local_peak, reported_share

AZIMUTH_BINS = 64
BLACKMAN = (0.42, 0.5, 0.08)
RANGE_SCALING = 4  # the last two stages of the range FFT divide by two
INT16 = 32767
FRAMES_A_BLOCK = 10

Spectrum = Complex[np.ndarray, "frame range doppler antenna"]


@dataclass(frozen=True, kw_only=True, repr=False)
class FirmwareCloud(PointCloud):
    """Points with the additional outputs of the firmware.

    Attributes:
        intensity: Magnitude in the device's counts, averaged over the antennas.
        snr_db: Level over the noise estimate of the range CFAR (of the Doppler CFAR if there is none in range), as the
            device reports it (`firmware_cfar.reported_share`).
        noise_db: That noise estimate in dB of one count, likewise.
        range_bin: Bin of the device's range FFT.
        doppler_bin: Doppler bin; num_loops // 2 is zero velocity.
    """

    intensity: PerPoint
    noise_db: PerPoint
    range_bin: Int[np.ndarray, " point"]
    doppler_bin: Int[np.ndarray, " point"]


def firmware_points(signal: AdcCube | RadarCube, settings: FirmwareSettings = FirmwareSettings()) -> FirmwareCloud:  # noqa: B008
    """Points of each frame, as the firmware of TI's demo would report them.

    1. Range FFT (Blackman window, next power of two of the samples, 16-bit results); `static_removal` subtracts the
       mean over the loops; Doppler FFT (Hann window, 16-bit results).
    2. Detection matrix: log2 magnitudes of all antennas, summed in the device's fixed-point format.
    3. CFAR in range, in Doppler, or in both: a cell must pass each. Then peak grouping, then the limit of the list,
       filled column by column from Doppler zero upwards.
    4. Azimuth: the highest of 64 bins of the FFT over the horizontal row, with Doppler compensation by the bin;
       elevation from the phase of the row above; a second azimuth peak where the settings allow.

    Nothing is interpolated between bins.

    Args:
        signal: Samples, or a cube, which is converted back to samples; bins that it does not contain are zero. Samples
            without an absolute scale are taken as ADC counts.
        settings: Settings of the firmware.

    Returns:
        Points in the order of the device's list, with the firmware's additional outputs.

    Raises:
        InputError: For a radar with real samples, simultaneous transmitters, or fewer than four loops.
    """
    adc = adc_from_cube(signal) if isinstance(signal, RadarCube) else signal
    config = adc.config
    check_firmware_radar(config)
    found: list[dict[str, np.ndarray]] = []
    for start in range(0, len(adc.samples), FRAMES_A_BLOCK):
        spectrum = firmware_spectrum(adc, settings, slice(start, start + FRAMES_A_BLOCK))
        matrix = detection_matrix(spectrum, settings.device)
        for index in range(len(spectrum)):
            objects = _objects(spectrum[index], matrix.level[index], matrix.counts_per_octave, config, settings)
            found.append({"frame": np.full(len(objects["range_bin"]), start + index), **objects})
    return _cloud(found, config)


def check_firmware_radar(config: RadarConfig) -> None:
    """Checks that the firmware supports a radar.

    Args:
        config: The radar.

    Raises:
        InputError: For a radar with real samples, simultaneous transmitters, or fewer than four loops.
    """
    if not config.complex_samples or config.num_loops < 4 or config.is_coded:
        raise InputError(
            f"firmware points are for TI radars with complex samples, four loops or more and TDM-MIMO; radar"
            f" {config.name!r} has others; use --points cfar"
        )


def num_range_bins(config: RadarConfig) -> int:
    """Length of the device's range FFT."""
    return 1 << (config.num_samples - 1).bit_length()


def range_step_m(config: RadarConfig) -> float:
    """Spacing of the device's range bins in metres: finer than the resolution where the FFT is zero-padded."""
    return config.range_resolution_m * config.num_samples / num_range_bins(config)


def firmware_spectrum(adc: AdcCube, settings: FirmwareSettings, frames: slice = slice(None)) -> Spectrum:
    """Range-Doppler spectrum in integer counts of the device.

    Args:
        adc: Samples (frame, loop, tx, rx, sample).
        settings: Settings of the firmware.
        frames: Frames to process; by default all.

    Returns:
        Spectrum (frame, range, doppler, antenna), complex64; Doppler bin num_loops // 2 is zero velocity.
    """
    config = adc.config
    counts = adc.samples[frames]
    if np.isfinite(adc.scale):
        counts = counts * np.float32(adc.scale / config.adc_count_sqrt_mw)
    window = _symmetric_window(config.num_samples, BLACKMAN).astype(np.float32)
    size = num_range_bins(config)
    one = _whole(_fft(counts * window, size, -1) / np.float32(RANGE_SCALING))
    if settings.static_removal:
        one = _whole(one - one.mean(axis=1, keepdims=True))
    loops = config.num_loops
    slow = one.reshape(len(one), loops, config.num_antennas, size).transpose(0, 3, 1, 2)
    weight = _symmetric_window(loops, (0.5, 0.5, 0.0)).astype(np.float32)[:, None]
    # every stage but the first divides by two; the Hann window already does once
    two = _fft(slow * weight, loops, 2) / np.float32(1 << max((loops - 1).bit_length() - 1, 0))
    return _whole(np.fft.fftshift(two, axes=2))


def _fft(values: np.ndarray, size: int, axis: int) -> np.ndarray:
    """FFT by scipy, which preserves single precision."""
    from scipy import fft

    return np.asarray(fft.fft(values, n=size, axis=axis))


def _symmetric_window(num: int, terms: tuple[float, float, float]) -> Float[np.ndarray, " num"]:
    phase = 2 * np.pi * np.arange(num) / (num - 1)
    return terms[0] - terms[1] * np.cos(phase) + terms[2] * np.cos(2 * phase)


def _whole(values: np.ndarray) -> np.ndarray:
    """Rounds to saturating 16-bit integers."""
    real, imaginary = (np.clip(np.rint(part), -INT16, INT16) for part in (np.real(values), np.imag(values)))
    return (real + 1j * imaginary).astype(np.complex64)


def _objects(
    spectrum: Complex[np.ndarray, "range doppler antenna"],
    level: np.ndarray,
    counts_per_octave: float,
    config: RadarConfig,
    settings: FirmwareSettings,
) -> dict[str, np.ndarray]:
    """Objects of one frame in the order of the device's list; `up` is the direction cosine in its half wavelengths."""
    passed, snr_db, noise_db = cfar_detections(level, settings, counts_per_octave)
    share = reported_share(settings.device, config.num_antennas)
    passed &= is_local_peak(level, settings)
    # the list is filled in FFT order: zero and positive velocities, then negative ones
    loops = config.num_loops
    column, row = np.nonzero(np.fft.ifftshift(passed, axes=1).T)
    column = (column + loops // 2) % loops
    pair = elevation_rows(config.antenna_position_m, config.wavelength_m)
    most = settings.most_objects or (MAX_OBJECTS if pair is None else MAX_OBJECTS_3D)
    row, column = row[:most], column[:most]
    delay_s = np.repeat(config.tx_delay_s, config.num_rx)
    doppler_hz = 2 * config.radial_velocity_mps[column] / config.wavelength_m
    signal = spectrum[row, column] * np.exp(-2j * np.pi * doppler_hz[:, None] * delay_s)
    across = azimuth_row(config.antenna_position_m, config.wavelength_m)
    beams = np.fft.ifft(signal[:, across], n=AZIMUTH_BINS, axis=1) * (AZIMUTH_BINS / len(across))
    first, second = _azimuth_peaks(np.abs(beams), settings.second_peak)
    also = np.flatnonzero(second >= 0)[: max(most - len(row), 0)]
    which = np.concatenate([np.arange(len(row)), also])
    azimuth = np.concatenate([first, second[also]])
    return {
        "range_bin": row[which],
        "doppler_bin": column[which],
        "azimuth_bin": azimuth,
        "up": _elevation(signal[which], beams[which, azimuth], azimuth, across, config),
        "intensity": np.abs(beams[which, azimuth]),
        "snr_db": share * snr_db[row, column][which],
        "noise_db": share * noise_db[row, column][which],
    }


def _azimuth_peaks(magnitude: Float[np.ndarray, "object azimuth"], share: float | None) -> tuple[PerIndex, PerIndex]:
    """Bin of the highest azimuth peak, and of a second one of at least `share` of it outside its main lobe (or -1)."""
    first = np.argmax(magnitude, axis=1) if len(magnitude) else np.zeros(0, np.intp)
    second = np.full(len(first), -1)
    if share is not None:
        for row, (line, top) in enumerate(zip(magnitude, first, strict=True)):
            # on either side the main lobe ends in a valley; the second peak lies beyond both valleys
            rotated = np.roll(line, -top)
            right = _first_rise(rotated)
            left = len(line) - _first_rise(np.roll(rotated[::-1], 1))
            if right <= left:
                at = right + int(np.argmax(rotated[right : left + 1]))
                if rotated[at % len(line)] > share * line[top]:
                    second[row] = (at + top) % len(line)
    return first, second


def _first_rise(line: np.ndarray) -> int:
    """Index of the first value higher than its predecessor; the length if there is none."""
    rises = np.flatnonzero(line[1:] > line[:-1])
    return int(rises[0]) + 1 if len(rises) else len(line)


def _elevation(
    signal: np.ndarray, beam: np.ndarray, azimuth_bin: np.ndarray, across: PerIndex, config: RadarConfig
) -> np.ndarray:
    """Direction cosine upwards in half wavelengths of the device; 0 without a second row."""
    pair = elevation_rows(config.antenna_position_m, config.wavelength_m)
    if pair is None:
        return np.zeros(len(signal))
    half_m = config.wavelength_m / 2
    position_m = config.antenna_position_m
    columns = (position_m[pair.upper, 0] - position_m[across[0], 0]) / half_m
    right = _signed(azimuth_bin) * 2 / AZIMUTH_BINS
    above = np.sum(signal[:, pair.upper] * np.exp(1j * np.pi * right[:, None] * columns), axis=1)
    return np.angle(beam * above.conj()) / np.pi * half_m / pair.spacing_m


def _signed(azimuth_bin: np.ndarray) -> np.ndarray:
    return np.where(azimuth_bin >= AZIMUTH_BINS // 2, azimuth_bin - AZIMUTH_BINS, azimuth_bin)


def _cloud(found: list[dict[str, np.ndarray]], config: RadarConfig) -> FirmwareCloud:
    """Objects of all frames with their positions; y is 0 for impossible angles, as on the device."""
    names = ("frame", "range_bin", "doppler_bin", "azimuth_bin", "up", "intensity", "snr_db", "noise_db")
    every = {name: np.concatenate([np.zeros(0), *(objects[name] for objects in found)]) for name in names}
    range_bin, doppler_bin = every["range_bin"].astype(int), every["doppler_bin"].astype(int)
    step_m = range_step_m(config)
    grain = 2.0 ** -np.ceil(np.log2(16 / step_m))  # the device's fixed point
    range_m = range_bin * step_m
    x_m = range_m * _signed(every["azimuth_bin"]) * 2 / AZIMUTH_BINS
    z_m = range_m * every["up"]
    y_m = np.sqrt(np.maximum(range_m**2 - x_m**2 - z_m**2, 0))
    x_m, y_m, z_m = (np.rint(value / grain) * grain for value in (x_m, y_m, z_m))
    return FirmwareCloud(
        frame=every["frame"].astype(int),
        x_m=x_m,
        y_m=y_m,
        z_m=z_m,
        radial_velocity_mps=config.radial_velocity_mps[doppler_bin],
        snr_db=every["snr_db"],
        intensity=every["intensity"],
        noise_db=every["noise_db"],
        range_bin=range_bin,
        doppler_bin=doppler_bin,
    )
