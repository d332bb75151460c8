"""Features of static clutter: distribution over range, angle and antennas, and sparsity of the maps."""

import numpy as np

from mmweaver.core.virtual_array import azimuth_row
from mmweaver.evaluation.finding import FrameValues, feature
from mmweaver.evaluation.signal_evidence import CannotSeeError, SignalEvidence, decibels
from mmweaver.signal.plane_waves import best_wave_share, plane_waves
from mmweaver.signal.spectra import azimuth_axis_rad, range_azimuth_power

CLUTTER_M = (0.7, 3.5)
MIN_COVERED = 0.85  # share of CLUTTER_M
NEAREST_CELL_M = 0.5  # excludes leakage
STRONG_CELLS = 20
SPARSE_RANGE_M = (0.5, 6.0)
MIN_BINS = 8


@feature("clutter_peak_over_median", "static clutter, peak over median bin", "dB", 3.0)
def clutter_peak_over_median(evidence: SignalEvidence) -> FrameValues:
    """Strongest over median range bin of static clutter from 0.7 to 3.5 m, in dB: rooms fill every range cell.

    Raises:
        CannotSeeError: If the range window does not cover 0.7 to 3.5 m.
    """
    step_m = evidence.cube.config.range_resolution_m
    inside = (evidence.range_m >= CLUTTER_M[0]) & (evidence.range_m <= CLUTTER_M[1])
    if inside.sum() * step_m < MIN_COVERED * (CLUTTER_M[1] - CLUTTER_M[0]):
        shown = f"{evidence.range_m[0]:.2f} to {evidence.range_m[-1]:.2f} m"
        raise CannotSeeError(f"the range window, {shown}, does not cover 0.7 to 3.5 m")
    power = evidence.still_power[:, inside]
    return FrameValues(decibels(power.max(axis=1) / np.median(power, axis=1)))


@feature("plane_wave_share", "best plane wave in a strong cell", "share", 0.1)
def plane_wave_share(evidence: SignalEvidence) -> FrameValues:
    """Share of the best plane wave in the 20 strongest static range bins, their median: 1 for a lone far scatterer.

    Several scatterers per cell and channel imbalance lower it.

    Raises:
        CannotSeeError: With fewer than three antennas, or too few range bins.
    """
    if evidence.cube.config.num_antennas < 3:
        raise CannotSeeError("fewer than three antennas")
    waves = plane_waves(evidence.cube.config)
    return FrameValues(np.array([np.median(best_wave_share(cells, waves)) for cells in _strong_cells(evidence)]))


@feature("antenna_spread", "spread of a static cell over antennas", "dB", 0.7)
def antenna_spread(evidence: SignalEvidence) -> FrameValues:
    """Standard deviation over the antennas of a static cell's level in dB; median of the 20 strongest range bins.

    Raises:
        CannotSeeError: With fewer than three antennas, or too few range bins.
    """
    if evidence.cube.config.num_antennas < 3:
        raise CannotSeeError("fewer than three antennas")
    return FrameValues(
        np.array(
            [
                np.median(20 * np.log10(np.maximum(np.abs(cells), 1e-30)).std(axis=1))
                for cells in _strong_cells(evidence)
            ]
        )
    )


@feature("range_doppler_sparsity", "energy in 1 % of range-Doppler cells", "share", 0.1)
def range_doppler_sparsity(evidence: SignalEvidence) -> FrameValues:
    """Share of the energy in the strongest 1 % of the range-Doppler cells. Raises CannotSeeError.

    Raises:
        CannotSeeError: With too few loops per frame, or too few range bins.
    """
    if evidence.cube.config.num_loops < MIN_BINS:
        raise CannotSeeError(f"{evidence.cube.config.num_loops} loops per frame make no Doppler axis")
    return FrameValues(_strongest_share(evidence.power[:, _shown(evidence)], 0.01))


@feature("range_azimuth_sparsity", "energy in 5 % of range-azimuth cells", "share", 0.1)
def range_azimuth_sparsity(evidence: SignalEvidence) -> FrameValues:
    """Share of the energy in the strongest 5 % of the range-azimuth cells (61 azimuths to +-60 degrees).

    Raises:
        CannotSeeError: With fewer than three antennas in the azimuth row, or too few range bins.
    """
    grid = evidence.cube.grid
    if len(azimuth_row(grid.antenna_position_m, grid.wavelength_m)) < 3:
        raise CannotSeeError("the array's row has fewer than three antennas")
    shown = _shown(evidence)
    return FrameValues(_strongest_share(range_azimuth_power(evidence.cube, azimuth_axis_rad(61))[:, shown], 0.05))


def _strong_cells(evidence: SignalEvidence) -> list[np.ndarray]:
    """Strongest static range bins (cell, antenna) of each frame. Raises CannotSeeError."""
    far = np.flatnonzero((evidence.range_m >= NEAREST_CELL_M) & evidence.in_window)
    if len(far) < MIN_BINS:
        raise CannotSeeError(f"fewer than {MIN_BINS} range bins beyond {NEAREST_CELL_M} m")
    count = min(STRONG_CELLS, len(far) // 2)
    order = np.argsort(-evidence.still_power[:, far], axis=1)[:, :count]
    return [frame[far[own]] for frame, own in zip(evidence.still, order, strict=True)]


def _shown(evidence: SignalEvidence) -> np.ndarray:
    shown = evidence.in_window & (evidence.range_m >= SPARSE_RANGE_M[0]) & (evidence.range_m <= SPARSE_RANGE_M[1])
    if shown.sum() < MIN_BINS:
        raise CannotSeeError(f"fewer than {MIN_BINS} range bins beyond {SPARSE_RANGE_M[0]} m")
    return shown


def _strongest_share(power: np.ndarray, share: float) -> np.ndarray:
    """Energy of the strongest `share` of the cells of each frame relative to the total."""
    flat = np.sort(power.reshape(len(power), -1), axis=1)
    count = max(1, round(share * flat.shape[1]))
    return flat[:, -count:].sum(axis=1) / np.maximum(flat.sum(axis=1), 1e-300)
