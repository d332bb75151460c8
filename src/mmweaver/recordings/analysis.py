"""Analysis of a recording beyond its cube: slow movement, vital signs, micro-Doppler and people."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import AdcCube, PointCloud, RadarCube
from mmweaver.signal.doppler_spectrogram import MicroDoppler, micro_doppler
from mmweaver.signal.points import point_cloud
from mmweaver.signal.slow_time import SlowTimeCell, moving_cells, slow_time_doppler
from mmweaver.signal.spectra import moving_doppler, range_doppler_power
from mmweaver.signal.tracking import PersonTrack, track_people
from mmweaver.signal.vital_signs import Rate, breathing_rate, heart_rate

MIN_VITAL_S = 8.0
MIN_CONTRAST = 20.0  # peak / median of a spectrogram; below this it is noise
FASTEST_DB = -20.0  # relative to the peak of the spectrogram: threshold for the fastest movement


@dataclass(frozen=True, kw_only=True)
class VitalSigns:
    """Breathing and heart rate of a seated person at a range; None if a rate could not be estimated."""

    range_m: float
    breathing: Rate | None
    heart: Rate | None


@dataclass(frozen=True, kw_only=True)
class RecordingAnalysis:
    """Results of `mmweaver process` beyond cube and points; parts that are not available are None or empty."""

    slow_doppler: np.ndarray | None  # (range, doppler), power over all frames
    slow_velocity_mps: np.ndarray | None
    cells: tuple[SlowTimeCell, ...]  # range bins with the most movement, strongest first
    vital_signs: VitalSigns | None
    micro_doppler: MicroDoppler | None
    people: tuple[PersonTrack, ...]
    static_share: float  # share of the energy that is static clutter

    def meta(self) -> dict[str, Any]:
        """Scalar results for meta.json."""
        return {
            "static_share": round(self.static_share, 4),
            "moving_cells": [
                {
                    "range_m": cell.range_m,
                    "moving_power": cell.moving_power,
                    "displacement_peak_to_peak_m": float(np.ptp(cell.displacement_m)),
                    "has_centre": cell.has_centre,
                }
                for cell in self.cells
            ],
            "vital_signs": self.vital_signs,
            "fastest_mps": None if self.micro_doppler is None else _fastest(self.micro_doppler),
            "people": [
                {
                    "first_s": float(one.time_s[0]),
                    "last_s": float(one.time_s[-1]),
                    "from_m": one.place_m[0],
                    "to_m": one.place_m[-1],
                    "mean_speed_mps": one.mean_speed_mps,
                    "height_m": one.height_m,
                    "points": one.num_points,
                }
                for one in self.people
            ],
        }

    def arrays(self) -> dict[str, np.ndarray]:
        """Arrays for analysis.npz, in SI units, by name."""
        found: dict[str, np.ndarray] = {}
        if self.slow_doppler is not None and self.slow_velocity_mps is not None:
            found |= {"slow_doppler_power": self.slow_doppler, "slow_velocity_mps": self.slow_velocity_mps}
        if self.cells:
            found["cell_range_m"] = np.array([cell.range_m for cell in self.cells])
            found["cell_signal"] = np.stack([cell.signal for cell in self.cells])
            found["cell_phase_rad"] = np.stack([cell.phase_rad for cell in self.cells])
            found["cell_displacement_m"] = np.stack([cell.displacement_m for cell in self.cells])
        if self.micro_doppler is not None:
            found["micro_doppler_power"] = self.micro_doppler.power.astype(np.float32)
            found["micro_doppler_time_s"] = self.micro_doppler.time_s
            found["micro_doppler_velocity_mps"] = self.micro_doppler.radial_velocity_mps
        if self.people:
            found["track"] = np.concatenate([np.full(len(one.frame), at) for at, one in enumerate(self.people)])
            found["track_time_s"] = np.concatenate([one.time_s for one in self.people])
            found["track_place_m"] = np.concatenate([one.place_m for one in self.people])
            found["track_velocity_mps"] = np.concatenate([one.velocity_mps for one in self.people])
        return found


def analyse_recording(cube: RadarCube, adc: AdcCube | None) -> RecordingAnalysis:
    """Runs every analysis that the length of a recording and its loops per frame permit.

    Args:
        cube: Radar cube.
        adc: Raw samples, required for micro-Doppler; None if the recording has none.

    Returns:
        The analysis; parts that are not available are None or empty.
    """
    people = point_cloud(cube, moving_only=True) if _may_show_people(cube) else None
    return recording_analysis(cube, _micro_doppler(adc), people, range_doppler_power(cube).sum(axis=1))


def recording_analysis(
    cube: RadarCube, spectrogram: MicroDoppler | None, moving: PointCloud | None, power: np.ndarray
) -> RecordingAnalysis:
    """Puts an analysis together.

    Args:
        cube: Radar cube, of which only values at zero Doppler are used.
        spectrogram: Micro-Doppler; None if it is not available.
        moving: Points without static clutter; None if people cannot be tracked.
        power: Doppler spectrum of each frame, summed over range, (frame, doppler).

    Returns:
        The analysis; parts that are not available are None or empty.
    """
    slow = slow_time_doppler(cube) if len(cube.values) > 1 else None
    cells, total = tuple(moving_cells(cube)), power.sum(axis=0)
    static = float(total[~moving_doppler(cube)].sum())
    is_tracked = moving is not None and len(cube.values) > 1
    return RecordingAnalysis(
        slow_doppler=None if slow is None else slow[0],
        slow_velocity_mps=None if slow is None else slow[1],
        cells=cells,
        vital_signs=_vital_signs(cells, cube.config.frame_period_s),
        micro_doppler=clear_spectrogram(spectrogram),
        people=tuple(track_people(moving, cube.grid.frame_time_s)) if is_tracked else (),
        static_share=static / float(total.sum()) if total.sum() > 0 else 0.0,
    )


def _vital_signs(cells: tuple[SlowTimeCell, ...], period_s: float) -> VitalSigns | None:
    """Vital signs in the cell with the clearest breathing; None if no cell shows any."""
    found: list[VitalSigns] = []
    for cell in cells:
        if len(cell.displacement_m) * period_s < MIN_VITAL_S:
            return None
        breathing = breathing_rate(cell.displacement_m, period_s)
        if breathing is not None and breathing.is_clear:
            heart = heart_rate(cell.displacement_m, period_s, breathing)
            found.append(VitalSigns(range_m=cell.range_m, breathing=breathing, heart=heart))
    return max(found, key=lambda one: one.breathing.confidence if one.breathing else 0.0, default=None)


def _micro_doppler(adc: AdcCube | None) -> MicroDoppler | None:
    """Micro-Doppler spectrogram; None without samples or with too few loops."""
    if adc is None:
        return None
    try:
        return micro_doppler(adc)
    except InputError:  # too few loops
        return None


def clear_spectrogram(found: MicroDoppler | None) -> MicroDoppler | None:
    """The spectrogram; None if it shows only noise."""
    return found if found is not None and found.power.max() > MIN_CONTRAST * np.median(found.power) else None


def _may_show_people(cube: RadarCube) -> bool:
    """Whether there are several frames and enough moving Doppler bins."""
    return len(cube.values) >= 2 and bool(moving_doppler(cube).sum() >= 2)


def _fastest(spectrogram: MicroDoppler) -> float:
    """Highest speed in the spectrogram above -20 dB of its peak."""
    level = spectrogram.power.max(axis=0)
    shown = level >= level.max() * 10 ** (FASTEST_DB / 10)
    return float(np.abs(spectrogram.radial_velocity_mps[shown]).max())
