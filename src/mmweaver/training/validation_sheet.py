"""Pictures of a training: range-Doppler and range-azimuth maps of ground truth and network, and their difference."""

from typing import Any

import numpy as np
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.evaluation.map_scores import log_map_difference_db
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.signal.spectra import azimuth_axis_rad

SPAN_DB = 50.0
MAX_ROWS = 3
MAPS = ("range_doppler", "range_doppler", "range_azimuth", "range_azimuth")  # alternating ground truth and network


def draw_sheet(truth: PowerMaps, network: PowerMaps, config: RadarConfig, made: str = "network, mean") -> np.ndarray:
    """Draws maps of ground truth and network, one row per sequence at its middle frame.

    Args:
        truth: Ground truth, (sequence, frame, range, other).
        network: Prediction of the same shape; each pair shares the peak of the ground truth.
        config: The radar.
        made: Title of the predictions. Default: "network, mean".

    Returns:
        Image, (row, column, 3) uint8.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    count = min(len(truth.range_doppler), MAX_ROWS)
    figure = Figure(figsize=(10.0, 0.5 + 2.4 * count), layout="constrained")
    canvas = FigureCanvasAgg(figure)
    grid = figure.subplots(count, len(MAPS), squeeze=False, sharey=True)
    near, far = config.range_m[0], config.range_m[-1]
    speeds, angles = config.radial_velocity_mps, np.degrees(azimuth_axis_rad())
    extents = {"range_doppler": (speeds[0], speeds[-1]), "range_azimuth": (angles[0], angles[-1])}
    image = None
    for row in range(count):
        for column, name in enumerate(MAPS):
            axes, own = grid[row][column], _middle(getattr(truth, name)[row])
            title, shown = ("ground truth", own) if column % 2 == 0 else (made, _middle(getattr(network, name)[row]))
            image = axes.imshow(
                10 * np.log10(np.maximum(shown / own.max(), 1e-12)),
                origin="lower",
                aspect="auto",
                cmap="inferno",
                vmin=-SPAN_DB,
                vmax=0,
                extent=(*extents[name], near, far),
                interpolation="nearest",
            )
            if row == 0:
                axes.set_title(f"{title}: {name.replace('_', '-')}", fontsize=9)
            if row == count - 1:
                axes.set_xlabel("radial velocity, m/s" if name == "range_doppler" else "azimuth, degrees", fontsize=8)
            if column == 0:
                axes.set_ylabel("range, m", fontsize=8)
            axes.tick_params(labelsize=7)
    assert image is not None
    figure.colorbar(image, ax=grid, shrink=0.8).set_label("dB relative to the peak of the ground truth", fontsize=8)
    return canvas_image(canvas)


def canvas_image(canvas: Any) -> np.ndarray:
    """A matplotlib canvas as image, (row, column, 3) uint8."""
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def differences_db(truth: PowerMaps, network: PowerMaps) -> dict[str, float]:
    """Mean map difference over sequences, see `map_scores.log_map_difference_db`.

    Args:
        truth: Ground truth, (sequence, frame, range, other).
        network: Prediction of the same shape.

    Returns:
        Difference in dB by map.
    """
    found = {}
    for name in ("range_doppler", "range_azimuth"):
        pairs = zip(getattr(network, name), getattr(truth, name), strict=True)
        found[name] = float(np.mean([log_map_difference_db(_numpy(own), _numpy(true)) for own, true in pairs]))
    return found


def _middle(maps: Tensor) -> np.ndarray:
    return _numpy(maps[len(maps) // 2])


def _numpy(values: Tensor) -> np.ndarray:
    return values.detach().float().cpu().numpy().astype(np.float64)


def draw_confusion(true: np.ndarray, answers: np.ndarray, names: tuple[str, ...]) -> np.ndarray:
    """Draws a row-normalised confusion matrix.

    Args:
        true: True classes, (n,).
        answers: Predicted classes, (n,).
        names: Names of the classes.

    Returns:
        Image, (row, column, 3) uint8.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    share = confusion(true, answers, len(names))
    figure = Figure(figsize=(7.0, 6.2), layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots()
    image = axes.imshow(share, cmap="Blues", vmin=0, vmax=1)
    for row, column in zip(*np.nonzero(share >= 0.005), strict=True):
        ink = "white" if share[row, column] > 0.6 else "black"
        axes.text(column, row, f"{100 * share[row, column]:.0f}", ha="center", va="center", color=ink, fontsize=8)
    axes.set_xticks(range(len(names)), names, rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(names)), names, fontsize=8)
    axes.set_xlabel("predicted")
    axes.set_ylabel("true")
    axes.set_title(f"{100 * float((true == answers).mean()):.1f} % of {len(true)} correct", fontsize=10)
    figure.colorbar(image, ax=axes, shrink=0.8).set_label("share of the true class", fontsize=8)
    return canvas_image(canvas)


def confusion(true: np.ndarray, answers: np.ndarray, count: int) -> np.ndarray:
    """Row-normalised confusion matrix.

    Args:
        true: True classes, (n,).
        answers: Predicted classes, (n,).
        count: Number of classes.

    Returns:
        Matrix (true, predicted); rows of absent classes are zero.
    """
    counts = np.zeros((count, count))
    np.add.at(counts, (true, answers), 1)
    return counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
