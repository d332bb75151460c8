"""Picture of a fit: range-Doppler maps of signal and field at a frame, and the error during the fit."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.records import RadarCube
from mmweaver.signal.spectra import range_doppler_power
from mmweaver.viz.theme import colour_bar, label_axes, page

SPAN_DB = 60.0


def errors_db(made: RadarCube, truth: RadarCube) -> dict[str, float]:
    """Energy of the error over that of the signal, in all cells and where there is signal (active cells).

    Args:
        made: The field on the native grid.
        truth: The signal.
    """
    where = active_mask(truth.values)
    pairs = (made.values, truth.values), (made.values[where], truth.values[where])
    error, active = (_ratio_db(one - two, two) for one, two in pairs)
    return {"error_db": round(error, 2), "error_active_db": round(active, 2)}


def draw_fit(path: Path, truth: RadarCube, made: RadarCube, curve: Sequence[tuple[int, float]], title: str) -> None:
    """Draws a fit.

    Args:
        path: The PNG.
        truth: The signal.
        made: The field on its grid.
        curve: Steps and errors in dB; may be empty.
        title: What was fitted.
    """
    power = [range_doppler_power(cube) for cube in (truth, made)]
    frame, peak = len(power[0]) // 2, power[0].max()
    speed, ranges = truth.grid.radial_velocity_mps, truth.grid.range_m
    with page(path, title, 10.5, 3.6) as figure:
        left, middle, right = figure.subplots(1, 3)
        figure.subplots_adjust(left=0.06, right=0.98, bottom=0.16, top=0.78, wspace=0.42)
        for axes, own, name in ((left, power[0], "signal"), (middle, power[1], "field")):
            levels = 10 * np.log10(np.maximum(own[frame] / peak, 1e-12))
            image = axes.imshow(
                levels, origin="lower", aspect="auto", cmap="inferno", vmin=-SPAN_DB, vmax=0,
                extent=(speed[0], speed[-1], ranges[0], ranges[-1]),
            )  # fmt: skip
            label_axes(axes, f"{name}, frame {frame}", "radial velocity (m/s)", "range (m)")
        colour_bar(middle, image, "dB")
        label_axes(right, "error during the fit", "step", "error energy (dB)", grid=True)
        right.plot(*zip(*curve, strict=True) if curve else ([], []))


def _ratio_db(error: np.ndarray, truth: np.ndarray) -> float:
    energy, whole = (float(np.sum(np.abs(part) ** 2, dtype=np.float64)) for part in (error, truth))
    return 10 * np.log10(max(energy, 1e-30 * whole) / whole)
