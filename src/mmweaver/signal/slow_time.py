"""Slow time across frames, for radars with few loops per frame or for slow motion: Doppler, phase and displacement.

Each frame gives one complex value per range bin and antenna, its value at zero Doppler. A displacement within a range
bin changes the phase of its cell by 4 pi / wavelength per metre; displacement is positive away from the radar.
Reference: docs/radar_primer.md, equation 7; Taubin, "Estimation of planar curves...", IEEE PAMI 13, 1991 (circle fit).
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float
from scipy import fft

from mmweaver.core.records import RadarCube
from mmweaver.signal.windows import hann

MIN_FRAMES = 8
MIN_BINS = 2.5
MIN_MOVING_SHARE = 1e-3  # moving power of a cell relative to the strongest
MAX_RESIDUAL = 0.35  # of a circle fit, relative to the radius
MAX_RADIUS = 10.0  # relative to the spread of the points; on a larger circle the arc is too short to fit


@dataclass(frozen=True, kw_only=True)
class SlowTimeCell:
    """One range bin over the frames of a recording, with its antennas combined for the strongest motion."""

    range_m: float
    moving_power: float  # mean power after subtraction of the mean, in squared units of the cube
    signal: Complex[np.ndarray, " frame"]
    phase_rad: Float[np.ndarray, " frame"]  # unwrapped, about the centre of its circle
    displacement_m: Float[np.ndarray, " frame"]  # relative to its mean, positive = away
    has_centre: bool  # whether a circle was found; otherwise the phase is about zero or the mean


def zero_doppler(cube: RadarCube) -> Complex[np.ndarray, "frame range antenna"]:
    """Values at zero Doppler, the windowed mean over the loops of each frame, (frame, range, antenna)."""
    return cube.values[:, :, cube.config.num_loops // 2]


def slow_time_doppler(cube: RadarCube) -> tuple[Float[np.ndarray, "range doppler"], Float[np.ndarray, " doppler"]]:
    """Doppler spectrum over all frames of a recording, averaged over the antennas.

    The mean over the frames is removed first. Velocities reach +- wavelength / (4 frame period).

    Args:
        cube: The cube.

    Returns:
        Power (range, doppler), and its velocities (doppler,) in m/s, increasing.
    """
    still = zero_doppler(cube)
    moving = still - still.mean(axis=0)
    window = hann(len(moving)) if len(moving) > 3 else np.ones(len(moving))
    spectrum = np.fft.fftshift(np.asarray(fft.fft(moving * (window / window.sum())[:, None, None], axis=0)), axes=0)
    frequency_hz = np.fft.fftshift(np.fft.fftfreq(len(moving), cube.config.frame_period_s))
    power = (np.abs(spectrum) ** 2).mean(axis=2).T
    return power, frequency_hz * cube.grid.wavelength_m / 2


def moving_cells(cube: RadarCube, count: int = 3) -> list[SlowTimeCell]:
    """The range bins with the strongest motion across frames, strongest first, each a local maximum along range.

    Args:
        cube: Cube of at least 8 frames; shorter ones give no cells.
        count: Maximum number of cells.
    """
    still = zero_doppler(cube)
    if len(still) < MIN_FRAMES:
        return []
    moving = still - still.mean(axis=0)
    power = (np.abs(moving) ** 2).mean(axis=(0, 2))
    padded = np.pad(power, 1)
    # the first bins contain the TX-RX leakage, and at zero beat frequency real samples have no phase
    is_far = cube.grid.range_m >= MIN_BINS * cube.config.range_resolution_m
    is_peak = (
        is_far
        & (power > 0)
        & (power >= padded[:-2])
        & (power > padded[2:])
        & (power >= MIN_MOVING_SHARE * power[is_far].max(initial=0.0))
    )
    order = [index for index in np.argsort(-power) if is_peak[index]][:count]
    return [_cell(cube, still[:, index], int(index), float(power[index])) for index in order]


def _cell(cube: RadarCube, values: np.ndarray, index: int, power: float) -> SlowTimeCell:
    """The cell of one range bin's values (frame, antenna)."""
    moving = (values - values.mean(axis=0)).astype(np.complex128)
    _, vectors = np.linalg.eigh(moving.conj().T @ moving)
    signal = values @ vectors[:, -1]
    centre = circle_centre(signal)
    around = _steadier(signal) if centre is None else centre
    phase = np.unwrap(np.angle(signal - around))
    displacement = phase * cube.grid.wavelength_m / (4 * np.pi)
    return SlowTimeCell(
        range_m=float(cube.grid.range_m[index]),
        moving_power=power,
        signal=signal,
        phase_rad=phase,
        displacement_m=displacement - displacement.mean(),
        has_centre=centre is not None,
    )


def _steadier(signal: np.ndarray) -> complex:
    """Zero or the mean of the values, whichever they keep the steadier distance from."""
    mean = complex(signal.mean())
    spread = [np.abs(signal - one).std() / max(float(np.abs(signal - one).mean()), 1e-30) for one in (0.0, mean)]
    return mean if spread[1] < spread[0] else 0j


def circle_centre(signal: Complex[np.ndarray, " sample"]) -> complex | None:
    """Centre of the circle on which complex values lie, by Taubin's fit.

    Args:
        signal: Values (sample,).

    Returns:
        The centre; None where the values do not lie on a circle.

    >>> turn = np.exp(1j * np.linspace(0, 2, 50))
    >>> complex(np.round(circle_centre(3 + 1j + 2 * turn), 6))
    (3+1j)
    """
    mean = signal.mean()
    x, y = (signal - mean).real.astype(float), (signal - mean).imag.astype(float)
    square = x**2 + y**2
    spread = float(np.sqrt(square.mean()))
    if spread == 0:
        return None
    level = square.mean()
    design = np.stack([(square - level) / (2 * np.sqrt(level)), x, y], axis=1)
    a, b, c = np.linalg.svd(design, full_matrices=False)[2][-1]
    if abs(a) < 1e-12:
        return None
    a = a / (2 * np.sqrt(level))
    offset = complex(-b / (2 * a), -c / (2 * a))
    distance = np.abs(x + 1j * y - offset)
    radius = float(distance.mean())
    if radius > MAX_RADIUS * spread or distance.std() > MAX_RESIDUAL * radius:
        return None
    return complex(mean + offset)
