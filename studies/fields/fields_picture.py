"""One signal held by each kind of field in at most 10,018 values: range-Doppler maps, error and CPU seconds.

python -m studies run fields_picture --signal walking --picture docs/images/fields.png
"""

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from mmweaver.compression.mmw_codec import compress_cube, values_of_bytes
from mmweaver.core.records import RadarCube
from mmweaver.inr import fit
from mmweaver.inr.fit_picture import errors_db
from mmweaver.signal.spectra import range_doppler_power
from mmweaver.viz.theme import label_axes, page
from studies.fields.field_signals import SIGNALS
from studies.fields.inr_variants import fit_inr
from studies.manifest import StudyRun
from studies.study import Reads

SPAN_DB = 60.0
BYTES = 4 * 10_018
HELD: dict[str, Callable[[RadarCube], np.ndarray]] = {
    "INR as the paper has it": lambda cube: fit_inr(cube, "paper")[0].cube().values,
    "base INR": lambda cube: fit_inr(cube, "base")[0].cube().values,
    "modulated INR": lambda cube: fit_inr(cube, "modulated")[0].cube().values,
    "scatterers": lambda cube: fit(cube, "scatterers").cube().values,
    ".mmw": lambda cube: values_of_bytes(compress_cube(cube, num_bytes=BYTES)),
}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--signal", default="walking", choices=list(SIGNALS))
    parser.add_argument("--data", type=Path, action=Reads, help="folder of recordings, for a recorded signal")
    parser.add_argument("--picture", type=Path, help="the PNG")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    cube = SIGNALS[options.signal](options.data).cube
    shown, frame = {"signal": cube.values}, len(cube.values) // 2
    for name, hold in HELD.items():
        start = time.process_time()
        shown[name] = hold(cube)
        made = RadarCube(values=shown[name], grid=cube.grid, config=cube.config, scale=cube.scale)
        errors = " ".join(f"{key} {value:.1f}" for key, value in errors_db(made, cube).items())
        print(f"{name}: {errors}, {time.process_time() - start:.1f} CPU s", flush=True)
    if options.picture is None:
        return
    speed, ranges = cube.grid.radial_velocity_mps, cube.grid.range_m
    with page(options.picture, f"{options.signal}: 983,040 numbers in 10,018", 14.0, 3.4) as figure:
        figure.subplots_adjust(left=0.05, right=0.99, bottom=0.17, top=0.78, wspace=0.12)
        row = figure.subplots(1, len(shown), sharey=True)
        peak = range_doppler_power(cube)[frame].max()
        for axes, (name, values) in zip(row, shown.items(), strict=True):
            power = (np.abs(values[frame]) ** 2).mean(-1)
            axes.imshow(
                10 * np.log10(np.maximum(power / peak, 1e-12)), origin="lower", aspect="auto", cmap="inferno",
                vmin=-SPAN_DB, vmax=0, extent=(speed[0], speed[-1], ranges[0], ranges[-1]),
            )  # fmt: skip
            label_axes(axes, name, "m/s", "range (m)" if name == "signal" else "")
