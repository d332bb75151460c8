"""Pictures of field fidelity: range-Doppler maps of the original, of each field and of its error.

python -m studies run field_pictures --signal two_people --out docs/images/fields.png --data <recordings>
python -m studies run field_pictures --signal walking --out docs/images/fields_simulated.png
python -m studies run field_pictures --super-resolution 3 --out docs/images/super_resolution.png
"""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.core.atomic_files import atomic_file
from mmweaver.core.records import RadarCube
from mmweaver.dsp.cube import radar_cube
from mmweaver.dsp.spectra import range_doppler_power
from mmweaver.figures.theme import POWER_MAP
from mmweaver.metrics.map_scores import SHOWN_DB, shown_db
from studies.fields.field_fidelity import fit_scatterers
from studies.fields.field_signals import SIGNALS
from studies.fields.finer_radar import middle_delay_s
from studies.fields.phase_centring import centring_phasor
from studies.fields.super_resolution import finer_truths, methods
from studies.manifest import StudyRun
from studies.paper.single_signal import RECIPES, fit
from studies.scores.cube_scores import cells_of, nmse_db
from studies.study import Reads

ZOOM_MPS, ZOOM_M = 2.0, 0.7


def draw_fields(
    path: Path,
    truth: RadarCube,
    fields: dict[str, RadarCube],
    frame: int,
    *,
    title: str = "original",
    zoom: bool = False,
) -> None:
    """Writes a PNG: the original, then a column for each field with its map above the map of its error.

    All maps share one scale, 50 dB below the peak of the original over all frames. `zoom` shows only the surroundings
    of the strongest cell of the frame.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    cells, peak = cells_of(truth), float(range_doppler_power(truth).max())
    columns: dict[str, tuple[RadarCube, RadarCube | None]] = {title: (truth, None)}
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
    if zoom:
        power = range_doppler_power(truth)[frame]
        row, column = np.unravel_index(int(power.argmax()), power.shape)
        axes[0, 0].set_xlim(velocity[column] - ZOOM_MPS, velocity[column] + ZOOM_MPS)
        axes[0, 0].set_ylim(distance[row] - ZOOM_M, distance[row] + ZOOM_M)
    axes[0, 0].set_ylabel("range (m)")
    figure.supxlabel("radial velocity (m/s), positive = moving away", fontsize=8)
    assert image is not None
    figure.colorbar(image, ax=axes, label="dB below the original's peak", shrink=0.8)
    with atomic_file(path) as temporary:
        figure.savefig(temporary, format="png", dpi=100)


def draw_super_resolution(path: Path, factor: float, recipe: str, frame: int) -> None:
    """The same picture for a radar of `factor` times the bandwidth, and its reconstructions by coarse methods."""
    coarse, finer_cubes = finer_truths((factor,), ("more_bandwidth",))
    cube, truth = radar_cube(coarse), finer_cubes["more_bandwidth", factor]
    turn = centring_phasor(truth.config, truth.grid).conj() * centring_phasor(cube.config, truth.grid)
    shown = {}
    for method in methods((recipe,)):
        if method.name in ("zero_padding", f"inr_{recipe}") and method.make is not None:
            values = method.make(cube)(truth.grid) * turn[None, :, :, None]
            name = "zero padding" if method.name == "zero_padding" else f"INR, recipe {recipe}"
            shown[name] = replace(truth, values=values.astype(np.complex64))
        elif method.make_renderer is not None:
            late_s = -middle_delay_s(cube.config, truth.config)
            shown["scatterers, rendered"] = replace(method.make_renderer(cube)(truth.config, late_s), grid=truth.grid)
    draw_fields(path, truth, shown, frame, title=f"{factor:g} times the bandwidth", zoom=True)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--signal", default="walking_alone")
    parser.add_argument("--recipes", nargs="*", default=["paper", "smooth_short"])
    parser.add_argument("--frame", type=int, default=6)
    parser.add_argument("--super-resolution", type=float, default=None, help="so many times the bandwidth instead")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument(
        "--data", type=Path, action=Reads, default=None, help="folder of recordings (with radar/ in it)"
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    if options.super_resolution is not None:
        draw_super_resolution(options.out, options.super_resolution, options.recipes[-1], options.frame)
        return
    cube = SIGNALS[options.signal](options.data).cube
    fields = {f"INR, recipe {name}": fit(cube, RECIPES[name]).field.cube() for name in options.recipes}
    fields["scatterers"] = fit_scatterers(cube)[0].cube()
    draw_fields(options.out, cube, fields, options.frame)
