"""Is a field that is sampled more finely any finer? Compared with the radar's own spectrum, and with finer radars.

Questions that "super-resolution" mixes:

- between_bins: does the field give what the same radar's spectrum shows between its bins? Ground truth: the transform
  of the noise-free samples at the finer positions; only the new positions are scored.
- sampled_places: the same for positions sampled from [j, j + radius / 8] in range and Doppler (the paper's
  augmentation).
- more_bandwidth, more_loops, more_antennas: does it give what a physically finer radar would record? Ground truth: the
  simulator with that radar, frames about the same instant, both cubes phase-centred (they then agree in phase).

Baselines: zero padding (the coarse radar's own spectrum) and linear interpolation. Scatterers have two rows: sampled
more finely, as every field, and rendered as the finer radar would see them (scatterers_rendered).

    python -m studies run super_resolution
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fitting import FitRecipe as ScattererRecipe
from mmweaver.compression.signal_field import SignalField, finer_grid, sampled_grid
from mmweaver.core.boards import AWR1843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, CubeGrid, PoseSequence, RadarCube
from mmweaver.core.shapes import CubeValues, RangeDopplerMask
from mmweaver.propagation.receiver import IDEAL
from mmweaver.signal.cube import adc_from_cube, radar_cube
from studies.fields.field_fidelity import PAPER_VALUES
from studies.fields.field_signals import pose_of, sample_scene, simulator_of, without_room
from studies.fields.finer_radar import (
    centred,
    centring_phasor,
    interpolated,
    middle_delay_s,
    more_antennas,
    more_bandwidth,
    more_loops,
    spectrum_on,
    starting_later,
)
from studies.fields.inr_variants import INRS, fit_inr
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.scores.cube_scores import BASELINES, cells_of, nmse_db
from studies.scores.scorecard import METRICS, scorecard

FACTORS = (1.5, 2.0, 3.0, 4.0)
RADII = (1, 2, 3, 4, 5, 6, 7)
FINER_RADARS: dict[str, Callable[[RadarConfig, float], RadarConfig]] = {
    "more_bandwidth": more_bandwidth,
    "more_loops": more_loops,
    "more_antennas": more_antennas,
}
NUM_FRAMES = 8
PAPER_FRAMES = 20
INR_NAMES = ("paper", "raw_short", "relu_short", "tuned_short", "smooth_short", "siren_short", "modulated")
Sampler = Callable[[CubeGrid], CubeValues]
Renderer = Callable[[RadarConfig, float], RadarCube]  # another radar, its first frame so much later (s)
Row = dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class UpsamplingMethod:
    """A method to evaluate a cube at any position, made from the cube alone; `settings` go into the result's config.

    A method with `make_renderer` renders what a finer radar would record, and only those questions apply to it.
    """

    name: str
    make: Callable[[RadarCube], Sampler] | None = None
    make_renderer: Callable[[RadarCube], Renderer] | None = None
    settings: dict[str, Any]


def _zero_padding(cube: RadarCube) -> Sampler:
    return partial(spectrum_on, adc_from_cube(cube))


def _lines(cube: RadarCube, is_centred: bool) -> Sampler:
    return lambda grid: interpolated(cube, grid, is_centred=is_centred)


def field_method(name: str, settings: dict[str, Any], make: Callable[[RadarCube], SignalField]) -> UpsamplingMethod:
    """Any field as a method of this study."""
    return UpsamplingMethod(name=name, make=lambda cube: make(cube).values_on, settings=settings)


def methods(inr_names: tuple[str, ...]) -> list[UpsamplingMethod]:
    """The baselines, and INRs by name."""
    baselines = [
        UpsamplingMethod(name="zero_padding", make=_zero_padding, settings={}),
        UpsamplingMethod(name="linear_raw", make=partial(_lines, is_centred=False), settings={}),
        UpsamplingMethod(name="linear_centred", make=partial(_lines, is_centred=True), settings={}),
    ]
    settings = asdict(_scatterer_recipe(NUM_FRAMES))
    baselines += [
        field_method("scatterers", settings, _scatterers),
        UpsamplingMethod(name="scatterers_rendered", make_renderer=_scatterer_renderer, settings=settings),
    ]
    return baselines + [
        field_method(f"inr_{name}", asdict(INRS[name][1]), lambda cube, name=name: fit_inr(cube, name)[0])
        for name in inr_names
    ]


def _scatterer_recipe(num_frames: int) -> ScattererRecipe:
    """As many parameters per frame as the paper's INR has over 20 frames."""
    num_values = PAPER_VALUES * num_frames // PAPER_FRAMES
    return ScattererRecipe(num_points=num_values, num_values=num_values, with_static=False)


def _scatterers(cube: RadarCube) -> ScattererField:
    return ScattererField.fit(cube, _scatterer_recipe(len(cube.values)))


def _scatterer_renderer(cube: RadarCube) -> Renderer:
    field = _scatterers(cube)
    return lambda config, late_s: field.for_radar(config, len(cube.values), first_frame_s=late_s)


def between_bins(sampler: Sampler, cube: RadarCube, adc: AdcCube, factor: float) -> Row:
    """Errors at the new places of a grid `factor` times finer in range and Doppler."""
    grid = finer_grid(cube.grid, n_r=factor, n_d=factor)
    truth = replace(cube, values=spectrum_on(adc, grid), grid=grid)
    prediction = sampler(grid)
    is_old = np.ones(truth.values.shape[:3], bool)
    for axis, (new, old) in enumerate(
        ((grid.range_m, cube.grid.range_m), (grid.radial_velocity_mps, cube.grid.radial_velocity_mps)), start=1
    ):
        known = np.abs(new[:, None] - old[None]).min(axis=1) < 1e-6 * (old[1] - old[0])
        is_old &= np.expand_dims(known, [at for at in range(3) if at != axis])
    cells = cells_of(truth)
    masks = {
        "nmse_db": ~is_old,
        "nmse_active_db": ~is_old & cells.is_active,
        "nmse_moving_db": ~is_old & cells.is_moving,
    }
    scores = {name: _entry(name, prediction, truth, "new positions only", mask) for name, mask in masks.items()}
    return _row("between_bins", factor, scores)


def sampled_places(sampler: Sampler, cube: RadarCube, adc: AdcCube, radius: int) -> Row:
    """Errors at ranges and velocities sampled within the paper's sampling radius, against the spectrum there."""
    grid = replace(sampled_grid(cube.grid, radius / 8, seed=0), antenna_position_m=cube.grid.antenna_position_m)
    truth = replace(cube, values=spectrum_on(adc, grid), grid=grid)
    return _row(
        "sampled_places", float(radius), {"nmse_db": _entry("nmse_db", sampler(grid), truth, "sampled positions")}
    )


def against_finer_radar(sampler: Sampler, truth: RadarCube, coarse: RadarConfig) -> dict[str, Any]:
    """The scorecard of a coarse cube's sampler on the grid of a finer radar's cube, both phase-centred."""
    values = sampler(truth.grid) * centring_phasor(coarse, truth.grid)[None, :, :, None]
    prediction = replace(truth, values=values.astype(np.complex64))
    return scorecard(prediction, centred(truth)).as_json()


def measure(run: StudyRun, inr_names: tuple[str, ...], factors: tuple[float, ...] = FACTORS) -> list[Path]:
    """Scores every method on every question and writes one file each."""
    coarse, finer_cubes = finer_truths(factors)
    return [_run_method(method, coarse, finer_cubes, factors, run) for method in methods(inr_names)]


def finer_truths(
    factors: tuple[float, ...], kinds: tuple[str, ...] = tuple(FINER_RADARS)
) -> tuple[AdcCube, dict[tuple[str, float], RadarCube]]:
    """A walker recorded by the awr1843, and by finer radars, with the middles of all frames at the same instants."""
    finer = {(kind, factor): FINER_RADARS[kind](AWR1843, factor) for kind in kinds for factor in factors}
    delay_s = max(middle_delay_s(AWR1843, config) for config in finer.values())
    pose = pose_of("walking", seconds=NUM_FRAMES * AWR1843.frame_period_s + delay_s + 0.1)
    coarse = _record(AWR1843, starting_later(pose, delay_s))
    finer_cubes = {
        key: radar_cube(_record(config, starting_later(pose, delay_s - middle_delay_s(AWR1843, config))))
        for key, config in finer.items()
    }
    return coarse, finer_cubes


def _run_method(
    method: UpsamplingMethod,
    coarse: AdcCube,
    finer_cubes: dict[tuple[str, float], RadarCube],
    factors: tuple[float, ...],
    run: StudyRun,
) -> Path:
    start = time.perf_counter()
    cube = radar_cube(coarse)
    rows: list[Row] = []
    if method.make is not None:
        sampler = method.make(cube)
        seconds = time.perf_counter() - start
        at_cells = _entry("nmse_db", sampler(cube.grid), cube, "the cube's own cells")
        rows.append(_row("own_cells", 1.0, {"nmse_db": at_cells}))
        rows += [between_bins(sampler, cube, coarse, factor) for factor in factors]
        rows += [sampled_places(sampler, cube, coarse, radius) for radius in RADII]
        for (kind, factor), truth in finer_cubes.items():
            rows.append(_row(kind, factor, against_finer_radar(sampler, truth, coarse.config)))
    else:
        assert method.make_renderer is not None
        renderer = method.make_renderer(cube)
        seconds = time.perf_counter() - start
        for (kind, factor), truth in finer_cubes.items():
            prediction = renderer(truth.config, -middle_delay_s(coarse.config, truth.config))
            prediction = replace(prediction, grid=truth.grid)
            rows.append(_row(kind, factor, scorecard(prediction, truth).as_json()))
    for row in rows:
        row |= {"n": 1, "seeds": [0], "seconds": {"prepare": round(seconds, 3)}}
    unknown = {"dataset.sha256": "simulated anew in every run"}
    rows = complete_rows(rows, unknown=unknown)
    return run.write("super_resolution", method.name, config=method.settings, rows=rows)


def _record(config: RadarConfig, pose: PoseSequence) -> AdcCube:
    """Noise-free samples of the person alone."""
    simulator = simulator_of(without_room(sample_scene()), config, IDEAL)
    return simulator.run(pose, num_frames=NUM_FRAMES, seed=0).adc


def _row(truth: str, factor: float, metrics: dict[str, Any]) -> Row:
    return {"dataset": {"name": "walking_alone_noise_free", "truth": truth, "factor": factor}, "metrics": metrics}


def _entry(
    name: str, prediction: CubeValues, truth: RadarCube, cells: str, where: RangeDopplerMask | None = None
) -> dict[str, Any]:
    """An NMSE over some cells, and its baselines."""
    metric = METRICS[name]
    value = nmse_db(prediction, truth.values, where)
    return {
        "value": value if np.isfinite(value) else None,
        "unit": metric.unit,
        "definition": f"{metric.definition}; {cells}",
        "version": metric.version,
        "is_headline": metric.is_headline,
        "baseline": {name: nmse_db(make(truth).values, truth.values, where) for name, make in BASELINES.items()},
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--recipes", nargs="*", default=list(INR_NAMES))


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(run, tuple(options.recipes))
