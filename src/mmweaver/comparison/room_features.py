"""Features of static clutter: how it is spread over range, angle and antennas, and how full the maps are."""

import numpy as np

from mmweaver.comparison.measured_feature import CannotSeeError, Feature, FrameValues, decibels
from mmweaver.comparison.signal_evidence import SignalEvidence
from mmweaver.core.virtual_array import azimuth_row
from mmweaver.dsp.plane_waves import best_wave_share, plane_waves
from mmweaver.dsp.spectra import azimuth_axis_rad, range_azimuth_power

CLUTTER_M = (0.7, 3.5)
LEAST_COVERED = 0.85  # of these metres
NEAREST_CELL_M = 0.5  # leakage lies nearer
STRONG_CELLS = 20
SPARSE_RANGE_M = (0.5, 6.0)
FEWEST_BINS = 8


def clutter_peak_over_median(evidence: SignalEvidence) -> FrameValues:
    """Strongest over median range bin of static clutter from 0.7 to 3.5 m, in dB: rooms fill every range cell.

    Raises CannotSeeError.
    """
    step_m = evidence.cube.config.range_resolution_m
    inside = (evidence.range_m >= CLUTTER_M[0]) & (evidence.range_m <= CLUTTER_M[1])
    if inside.sum() * step_m < LEAST_COVERED * (CLUTTER_M[1] - CLUTTER_M[0]):
        shown = f"{evidence.range_m[0]:.2f} to {evidence.range_m[-1]:.2f} m"
        raise CannotSeeError(f"the range window, {shown}, does not cover 0.7 to 3.5 m")
    power = evidence.still_power[:, inside]
    return FrameValues(decibels(power.max(axis=1) / np.median(power, axis=1)))


def plane_wave_share(evidence: SignalEvidence) -> FrameValues:
    """Share of the best plane wave in the 20 strongest static range bins, their median: 1 for a lone far scatterer.

    Several scatterers in a cell, and gains and phases of real channels, make it less. Raises CannotSeeError.
    """
    if evidence.cube.config.num_antennas < 3:
        raise CannotSeeError("fewer than three antennas")
    waves = plane_waves(evidence.cube.config)
    return FrameValues(np.array([np.median(best_wave_share(cells, waves)) for cells in _strong_cells(evidence)]))


def antenna_spread(evidence: SignalEvidence) -> FrameValues:
    """Standard deviation over the antennas of a static cell's level in dB; median of the 20 strongest range bins.

    Raises CannotSeeError.
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


def range_doppler_sparsity(evidence: SignalEvidence) -> FrameValues:
    """Share of the energy in the strongest 1 % of the range-Doppler cells. Raises CannotSeeError."""
    if evidence.cube.config.num_loops < FEWEST_BINS:
        raise CannotSeeError(f"{evidence.cube.config.num_loops} loops a frame make no Doppler axis")
    return FrameValues(_strongest_share(evidence.power[:, _shown(evidence)], 0.01))


def range_azimuth_sparsity(evidence: SignalEvidence) -> FrameValues:
    """Share of the energy in the strongest 5 % of the range-azimuth cells (61 azimuths to +-60 degrees).

    Raises CannotSeeError.
    """
    grid = evidence.cube.grid
    if len(azimuth_row(grid.antenna_position_m, grid.wavelength_m)) < 3:
        raise CannotSeeError("the array's row has fewer than three antennas")
    shown = _shown(evidence)
    return FrameValues(_strongest_share(range_azimuth_power(evidence.cube, azimuth_axis_rad(61))[:, shown], 0.05))


def _strong_cells(evidence: SignalEvidence) -> list[np.ndarray]:
    """The values (cell, antenna) of the strongest static range bins of each frame. Raises CannotSeeError."""
    far = np.flatnonzero((evidence.range_m >= NEAREST_CELL_M) & evidence.in_window)
    if len(far) < FEWEST_BINS:
        raise CannotSeeError(f"fewer than {FEWEST_BINS} range bins beyond {NEAREST_CELL_M} m")
    count = min(STRONG_CELLS, len(far) // 2)
    order = np.argsort(-evidence.still_power[:, far], axis=1)[:, :count]
    return [frame[far[own]] for frame, own in zip(evidence.still, order, strict=True)]


def _shown(evidence: SignalEvidence) -> np.ndarray:
    shown = evidence.in_window & (evidence.range_m >= SPARSE_RANGE_M[0]) & (evidence.range_m <= SPARSE_RANGE_M[1])
    if shown.sum() < FEWEST_BINS:
        raise CannotSeeError(f"fewer than {FEWEST_BINS} range bins beyond {SPARSE_RANGE_M[0]} m")
    return shown


def _strongest_share(power: np.ndarray, share: float) -> np.ndarray:
    """Energy of the strongest `share` of the cells of each frame, over all of it."""
    flat = np.sort(power.reshape(len(power), -1), axis=1)
    count = max(1, round(share * flat.shape[1]))
    return flat[:, -count:].sum(axis=1) / np.maximum(flat.sum(axis=1), 1e-300)


FEATURES = (
    Feature(
        name="clutter_peak_over_median", title="static clutter, peak over median bin", unit="dB", tolerance=3.0,
        definition="strongest over median range bin of static clutter from 0.7 to 3.5 m",
        measure=clutter_peak_over_median,
    ),
    Feature(
        name="plane_wave_share", title="best plane wave in a strong cell", unit="share", tolerance=0.1,
        definition="share of the best plane wave in the 20 strongest static range bins beyond 0.5 m, median",
        measure=plane_wave_share,
    ),
    Feature(
        name="antenna_spread", title="spread of a static cell over antennas", unit="dB", tolerance=0.7,
        definition="standard deviation over the antennas of the level of the 20 strongest static range bins, median",
        measure=antenna_spread,
    ),
    Feature(
        name="range_doppler_sparsity", title="energy in 1 % of range-Doppler cells", unit="share", tolerance=0.1,
        definition="share of the energy in the strongest 1 % of range-Doppler cells from 0.5 to 6 m",
        measure=range_doppler_sparsity,
    ),
    Feature(
        name="range_azimuth_sparsity", title="energy in 5 % of range-azimuth cells", unit="share", tolerance=0.1,
        definition="share of the energy in the strongest 5 % of range-azimuth cells from 0.5 to 6 m",
        measure=range_azimuth_sparsity,
    ),
)  # fmt: skip
