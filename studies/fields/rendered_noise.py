"""Does a rendered cube with noise look like the capture? Level and distribution of the noise, and the point cloud.

python -m studies run rendered_noise --data <recordings>

The scatterer field stores the strength of the noise as one number; `ScattererField.with_noise` renders it.
"""

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.records import PointCloud, RadarCube
from mmweaver.dsp.points import point_cloud
from mmweaver.dsp.spectra import range_doppler_power
from studies.fields.field_fidelity import fit_scatterers, scatterer_recipe
from studies.fields.field_signals import RECORDED, SIGNALS, StudySignal
from studies.manifest import StudyRun
from studies.scores.cube_scores import cells_of, noise_floor
from studies.study import Reads

EXPERIMENT = "rendered_noise"
SEED = 0
NEAR_M = 0.3  # a point so near to one of the capture's, in the same frame, is that one
DEFINITIONS: dict[str, tuple[str, str]] = {
    "noise_floor_db": ("dB", "median power of the cells over that of the capture"),
    "distribution_distance": (
        "1",
        "Kolmogorov-Smirnov distance to the capture's distribution of power over its median, in the cells that are not"
        " active in the capture, each antenna by itself",
    ),
    "neighbour_correlation": ("1", "correlation of a cell that is not active with the next one along Doppler"),
    "points_a_frame": ("1", "points of the CFAR point cloud (1e-4) in a frame"),
    "false_points_a_frame": ("1", f"points farther than {NEAR_M} m from every point of the capture's frame"),
    "missed_points_a_frame": ("1", f"points of the capture farther than {NEAR_M} m from every point of the frame"),
}


def noise_scores(cube: RadarCube, capture: RadarCube) -> dict[str, float]:
    """The metrics of DEFINITIONS of one cube compared with the capture."""
    empty = ~cells_of(capture).is_active
    floors = [noise_floor(range_doppler_power(one)) for one in (cube, capture)]
    clouds = [point_cloud(one) for one in (cube, capture)]
    frames = len(cube.values)
    return {
        "noise_floor_db": float(10 * np.log10(max(floors[0], 1e-30) / floors[1])),
        "distribution_distance": _distribution_distance(cube.values[empty], capture.values[empty]),
        "neighbour_correlation": _neighbour_correlation(cube, empty),
        "points_a_frame": len(clouds[0].frame) / frames,
        "false_points_a_frame": far_points(clouds[0], clouds[1]) / frames,
        "missed_points_a_frame": far_points(clouds[1], clouds[0]) / frames,
    }


def far_points(cloud: PointCloud, other: PointCloud) -> int:
    """How many points of a cloud lie farther than NEAR_M from every point of the other's same frame."""
    own, others = (np.stack([one.x_m, one.y_m, one.z_m], axis=1) for one in (cloud, other))
    far = 0
    for frame in np.unique(cloud.frame):
        here, there = own[cloud.frame == frame], others[other.frame == frame]
        gap = np.linalg.norm(here[:, None] - there[None], axis=-1).min(axis=1, initial=np.inf)
        far += int((gap > NEAR_M).sum())
    return far


def _distribution_distance(one: np.ndarray, other: np.ndarray) -> float:
    powers = [np.sort(np.abs(values.ravel()).astype(np.float64) ** 2) for values in (one, other)]
    first, second = (power / max(float(np.median(power)), 1e-300) for power in powers)
    every = np.concatenate([first, second])
    below = [np.searchsorted(each, every, side="right") / len(each) for each in (first, second)]
    return float(np.abs(below[0] - below[1]).max())


def _neighbour_correlation(cube: RadarCube, empty: np.ndarray) -> float:
    both = empty[:, :, 1:] & empty[:, :, :-1]
    left, right = cube.values[:, :, :-1][both], cube.values[:, :, 1:][both]
    size = np.linalg.norm(left) * np.linalg.norm(right)
    return float(np.abs(np.vdot(left, right)) / size) if size else 0.0


def noise_row(signal: StudySignal) -> dict[str, Any]:
    """Scores of the rendered cube with noise; the baseline is rendered without, the oracle is the capture itself."""
    field, seconds = fit_scatterers(signal.cube)
    rendered = field.cube()
    scores = {
        "value": noise_scores(field.with_noise(rendered, SEED), signal.cube),
        "without_noise": noise_scores(rendered, signal.cube),
        "capture": noise_scores(signal.cube, signal.cube),
    }
    metrics = {
        name: {
            "value": scores["value"][name],
            "unit": unit,
            "definition": definition,
            "version": 1,
            "is_headline": False,
            "baseline": {"without_noise": scores["without_noise"][name]},
            "oracle": {"capture": scores["capture"][name]},
        }
        for name, (unit, definition) in DEFINITIONS.items()
    }
    return {
        "dataset": {"name": signal.name, "origin": signal.origin, "sha256": signal.digest},
        "n": len(signal.cube.values),
        "seeds": [SEED],
        "seconds": {"fit": round(seconds, 2)},
        "metrics": metrics,
    }


def measure(run: StudyRun, signal_names: tuple[str, ...], data: Path | None) -> Path:
    """Scores every signal; writes one result."""
    rows = [noise_row(SIGNALS[name](data)) for name in signal_names]
    config = asdict(scatterer_recipe(SIGNALS[signal_names[0]](data).cube))
    return run.write(EXPERIMENT, "scatterers", config=config, rows=rows)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data", type=Path, action=Reads, default=None, help="folder of recordings (with radar/ in it)"
    )


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    names = [name for name in SIGNALS if options.data is not None or name not in RECORDED]
    measure(run, tuple(names), options.data)
