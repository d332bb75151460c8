"""Pictures of a training: range-Doppler and range-azimuth maps of ground truth and network, and their difference."""

from typing import Any

import numpy as np
from torch import Tensor

from mmweaver.core.radar_config import RadarConfig
from mmweaver.dsp.spectra import azimuth_axis_rad
from mmweaver.metrics.map_scores import log_map_difference_db
from mmweaver.paths.mean_power import PowerMaps

SPAN_DB = 50.0
MOST_ROWS = 3
MAPS = ("range_doppler", "range_doppler", "range_azimuth", "range_azimuth")  # alternately ground truth and network


def draw_sheet(truth: PowerMaps, network: PowerMaps, config: RadarConfig, made: str = "network, mean") -> np.ndarray:
    """A row per sequence, its middle frame; image (row, column, 3) uint8. Pairs share the peak of the ground truth."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    count = min(len(truth.range_doppler), MOST_ROWS)
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
                10 * np.log10(np.maximum(shown / own.max(), 1e-12)), origin="lower", aspect="auto", cmap="inferno",
                vmin=-SPAN_DB, vmax=0, extent=(*extents[name], near, far), interpolation="nearest",
            )  # fmt: skip
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
    """A canvas of matplotlib as an image (row, column, 3) uint8."""
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def differences_db(truth: PowerMaps, network: PowerMaps) -> dict[str, float]:
    """Mean difference in dB over the non-zero cells of the ground truth and over the sequences, by map."""
    found = {}
    for name in ("range_doppler", "range_azimuth"):
        pairs = zip(getattr(network, name), getattr(truth, name), strict=True)
        found[name] = float(np.mean([log_map_difference_db(_numpy(own), _numpy(true)) for own, true in pairs]))
    return found


def _middle(maps: Tensor) -> np.ndarray:
    return _numpy(maps[len(maps) // 2])


def _numpy(values: Tensor) -> np.ndarray:
    return values.detach().float().cpu().numpy().astype(np.float64)
