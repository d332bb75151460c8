"""One picture of micro-Doppler: recorded above, library below; walking, running, jumping."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.figures.theme import GROUND_TRUTH, INK, POWER_MAP, STYLE, colour_bar, label_axes
from studies.physics.micro_doppler_measures import Spectrogram

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN_MPS = {"walking": (-1.5, 6.0), "running": (-1.5, 9.0), "jumping": (-4.0, 4.0)}
SPAN_DB = 45.0


def draw(shown: dict[str, tuple[Spectrogram, Spectrogram]], path: Path) -> None:
    """Recorded and generated spectrogram towards the radar of each activity; writes a .png."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.style import context

    with context(STYLE):
        figure = Figure(figsize=(9.6, 5.0), layout="constrained")
        FigureCanvasAgg(figure)
        grid = figure.subplots(2, len(shown), squeeze=False)
        image: Any = None
        for column, (activity, pair) in enumerate(shown.items()):
            for row, (who, seen) in enumerate(zip(("recorded (CMU)", "library"), pair, strict=True)):
                axes = grid[row][column]
                image = _spectrogram(axes, seen)
                axes.set_ylim(*SHOWN_MPS[activity])
                axes.set_xlim(0, max(float(one.time_s[-1]) for one in pair))
                label_axes(axes, f"{activity}, {who}", "time (s)" if row else "", "" if column else "ahead (m/s)")
        for row in range(2):
            colour_bar(grid[row][-1], image, "dB of the peak")
        figure.suptitle("Towards the radar: power of the body's echo; dashed: the pelvis's true velocity", color=INK)
        with atomic_file(path) as temporary:
            figure.savefig(temporary, dpi=100, format="png")


def _spectrogram(axes: "Axes", seen: Spectrogram) -> Any:
    power = 10 * np.log10(np.maximum(seen.share / seen.share.max(), 1e-12))
    image = axes.pcolormesh(
        seen.time_s, seen.velocity_mps, power.T, cmap=POWER_MAP, vmin=-SPAN_DB, vmax=0, shading="nearest",
        rasterized=True,
    )  # fmt: skip
    axes.plot(seen.time_s, seen.pelvis_mps, color=GROUND_TRUTH, linewidth=0.8, linestyle="--")
    return image
