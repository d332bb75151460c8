"""What fields keep of a signal, to look at: range-Doppler maps of the original, of each field and of its error.

python -m mmweaver.experiments.field_pictures --signal two_people --out docs/images/fields.png --data <recordings>
"""

import argparse
from dataclasses import replace
from pathlib import Path

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.records import RadarCube
from mmweaver.dsp.spectra import range_doppler_power
from mmweaver.experiments.signals import SIGNALS
from mmweaver.metrics.cells import cells_of
from mmweaver.metrics.maps import SHOWN_DB, shown_db
from mmweaver.metrics.signal import nmse_db
from mmweaver.pictures.theme import POWER_MAP
from mmweaver.training.single_signal import RECIPES, fit


def draw_fields(path: Path, truth: RadarCube, fields: dict[str, RadarCube], frame: int) -> None:
    """Writes a PNG: the original above, then a column a field with its map over the map of its error.

    All maps share one scale, 50 dB below the original's peak over all frames.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    cells, peak = cells_of(truth), float(range_doppler_power(truth).max())
    columns: dict[str, tuple[RadarCube, RadarCube | None]] = {"original": (truth, None)}
    for name, cube in fields.items():
        columns[name] = (cube, replace(truth, values=cube.values - truth.values))
    figure = Figure(figsize=(2.6 * len(columns) + 0.8, 5.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots(2, len(columns), sharex=True, sharey=True, squeeze=False)
    velocity, distance = truth.grid.radial_velocity_mps, truth.grid.range_m
    extent = (float(velocity[0]), float(velocity[-1]), float(distance[0]), float(distance[-1]))
    image = None
    for column, (name, shown) in enumerate(columns.items()):
        for row, cube in enumerate(shown):
            ax = axes[row, column]
            if cube is None:
                ax.axis("off")
                continue
            decibels = shown_db(range_doppler_power(cube), peak)[frame] - SHOWN_DB
            image = ax.imshow(
                decibels, origin="lower", aspect="auto", extent=extent, vmin=-SHOWN_DB, vmax=0, cmap=POWER_MAP
            )
            if row:
                active, moving = (
                    nmse_db(columns[name][0].values, truth.values, where)
                    for where in (cells.is_active, cells.is_moving)
                )
                ax.set_title(f"error {active:.1f} dB active, {moving:.1f} moving", fontsize=7)
            else:
                ax.set_title(name, fontsize=9)
    axes[0, 0].set_ylabel("range (m)")
    figure.supxlabel("radial velocity (m/s), positive = moving away", fontsize=8)
    assert image is not None
    figure.colorbar(image, ax=axes, label="dB below the original's peak", shrink=0.8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png", dpi=100)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--signal", default="walking_alone")
    parser.add_argument("--recipes", nargs="*", default=["paper", "smooth_short"])
    parser.add_argument("--frame", type=int, default=10)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--data", type=Path, default=None, help="folder of recordings (with radar/ in it)")
    arguments = parser.parse_args()
    cube = SIGNALS[arguments.signal](arguments.data).cube
    fields = {f"INR, recipe {name}": fit(cube, RECIPES[name]).field.cube() for name in arguments.recipes}
    draw_fields(arguments.out, cube, fields, arguments.frame)


if __name__ == "__main__":
    main()
