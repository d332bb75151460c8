"""How accurately fields represent a radar sequence, with baselines and oracles for every score.

python -m studies run field_fidelity --data <recordings>
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Any

from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fitting import FitRecipe as ScattererRecipe
from mmweaver.compression.signal_field import SignalField
from mmweaver.core.records import RadarCube
from studies.fields.field_signals import RECORDED, SIGNALS, StudySignal
from studies.fields.inr_variants import INRS, fit_inr
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scores.scorecard import scorecard
from studies.study import Reads

EXPERIMENT = "field_fidelity"
BYTES_PER_VALUE = 4  # float32
BYTES_PER_CELL = 8  # complex64
PAPER_VALUES = 10_018  # of the paper's INR over 20 frames
Fitter = Callable[[RadarCube], tuple[SignalField, float]]


def fidelity_row(signal: StudySignal, make: Fitter, seed: int = 0) -> dict[str, Any]:
    """Fits a field to one signal: its scores, its stored size and the size of the frames it represents."""
    field, seconds = make(signal.cube)
    metrics = scorecard(field.cube(), signal.cube, oracle=signal.realization).as_json()
    if signal.noise_free is not None:
        for name, entry in scorecard(signal.noise_free, signal.cube).as_json().items():
            metrics[name].setdefault("oracle", {})["noise_free"] = entry["value"]
    return {
        "dataset": {
            "name": signal.name,
            "origin": signal.origin,
            "split": "one sequence, fitted and scored on all its cells",
            "sha256": signal.digest,
            "shape": list(signal.cube.grid.shape),
        },
        "n": 1,
        "seeds": [seed],
        "seconds": {"fit": round(seconds, 2)},
        "size": size_of(field),
        "metrics": metrics,
    }


def size_of(field: SignalField) -> dict[str, Any]:
    """Bytes and data type of the field and of the frames it represents."""
    frames, *cell = field.grid.shape
    cells = frames * cell[0] * cell[1] * cell[2]
    return {
        "values": field.num_values,
        "bytes": BYTES_PER_VALUE * field.num_values,
        "dtype": "float32",
        "frames": frames,
        "cube_bytes": BYTES_PER_CELL * cells,
        "cube_dtype": "complex64",
        "ratio": round(BYTES_PER_CELL * cells / (BYTES_PER_VALUE * field.num_values), 3),
    }


def scatterer_recipe(cube: RadarCube) -> ScattererRecipe:
    """Scatterers, static layer and gains in at most as many values as the paper's INR of 20 frames."""
    return ScattererRecipe(
        num_points=PAPER_VALUES, num_values=PAPER_VALUES, with_static=len(cube.values) > 1, with_calibration=True
    )


def fit_scatterers(cube: RadarCube) -> tuple[ScattererField, float]:
    """Scatterers over a static layer, in at most as many values as the paper's INR; and the CPU seconds of the fit."""
    start = time.process_time()
    field = ScattererField.fit(cube, scatterer_recipe(cube))
    return field, time.process_time() - start


def measure_scatterers(run: StudyRun, signal_names: tuple[str, ...], data: Path | None) -> Path:
    """The scatterer field on every signal."""
    rows = [fidelity_row(SIGNALS[name](data), fit_scatterers) for name in signal_names]
    config = asdict(ScattererRecipe(num_points=PAPER_VALUES, num_values=PAPER_VALUES, with_calibration=True))
    return run.write(EXPERIMENT, "scatterers", config=config, rows=complete_rows(rows))


def measure_inr(
    run: StudyRun,
    inr_names: tuple[str, ...],
    signal_names: tuple[str, ...],
    data: Path | None,
) -> list[Path]:
    """Every INR on every signal; one file per INR."""
    signals = [SIGNALS[name](data) for name in signal_names]
    paths = []
    for name in inr_names:
        rows = [fidelity_row(signal, partial(fit_inr, name=name)) for signal in signals]
        config = {"field": INRS[name][0], **asdict(INRS[name][1])}
        paths.append(run.write(EXPERIMENT, f"inr_{name}", config=config, rows=complete_rows(rows)))
    return paths


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, default=None, help="folder of recordings (with radar/ in it)"
    )
    parser.add_argument("--inrs", nargs="*", default=["paper", "base", "modulated"], choices=list(INRS))
    parser.add_argument("--without-scatterers", action="store_true")
    parser.add_argument("--signals", nargs="*", default=None)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    every = [name for name in SIGNALS if options.data is not None or name not in RECORDED]
    names = tuple(options.signals or every)
    if options.inrs:
        measure_inr(run, tuple(options.inrs), names, options.data)
    if not options.without_scatterers:
        measure_scatterers(run, names, options.data)
