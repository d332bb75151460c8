"""Does sampling recordings between their bins help a recogniser: as augmentation, and as super-resolution?

    python -m studies run sampled_recordings --data train/ --unseen rooms/

The paper's augmentation samples a signal at places up to r eighths of a bin away in range and Doppler (antennas stay);
each recording gets a copy so sampled, by zero padding (exact), by linear interpolation of raw cells, or from a field of
scatterers fitted to it. Its super-resolution samples twice as many ranges. A CNN-LSTM (`studies/recognition/cnn_lstm`)
is trained on few recordings, all with the same steps, and tested in rooms of unseen kinds. Data sets as for study
`recogniser_gain`. Baselines: the recordings alone; as super-resolution, images of the radar's own bins. What an INR
costs to fit (9 to 37 CPU-seconds of 8 frames, study `super_resolution`) leaves it out here.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mmweaver.compression.scatterer_field import ScattererField
from mmweaver.compression.scatterers.fitting import FitRecipe
from mmweaver.compression.signal_field import finer_grid, sampled_grid
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.datasets.dataset_store import read_plan
from mmweaver.datasets.room_sequences import LabelledData, read_labelled
from mmweaver.models.activity_network import ACTIVITY_NAMES
from mmweaver.signal.cube import adc_from_cube
from mmweaver.training.activity_training import TRAIN_SPLITS, augmented, compute_log_maps
from studies.fields.field_fidelity import PAPER_VALUES
from studies.fields.finer_radar import interpolated, spectrum_on
from studies.manifest import StudyRun
from studies.network.activity_gain import few_of
from studies.network.learned_scores import interval
from studies.recognition.cnn_lstm import CnnLstm, range_angle_images, trained
from studies.result_rows import complete_rows, dataset_of
from studies.study import Reads

RECORDINGS, TESTED, RADII, FACTOR = 48, 96, (2, 7), 2
STEPS, BATCH, SEEDS = 250, 32, (0, 1)
ALONE, OWN_BINS = "recordings_alone", "own_bins"
Sampler = Callable[[CubeGrid], np.ndarray]


def _scatterers(cube: RadarCube) -> Sampler:
    recipe = FitRecipe(num_points=PAPER_VALUES, num_values=PAPER_VALUES, with_static=False)
    return ScattererField.fit(cube, recipe).values_on


SAMPLERS: dict[str, Callable[[RadarCube], Sampler]] = {
    "zero_padding": lambda cube: partial(spectrum_on, adc_from_cube(cube)),
    "linear_raw": lambda cube: partial(interpolated, cube, is_centred=False),
    "scatterers": _scatterers,
}


def at_radius(cube: RadarCube, sampler: Sampler, radius: int, seed: int) -> RadarCube:
    """A copy sampled up to `radius` eighths of a bin away in range and Doppler, on the bins of the original."""
    moved = replace(sampled_grid(cube.grid, radius / 8, seed), antenna_position_m=cube.grid.antenna_position_m)
    return replace(cube, values=np.asarray(sampler(moved), np.complex64))


def of_more_ranges(cube: RadarCube, sampler: Sampler) -> RadarCube:
    """The cube at `FACTOR` times as many ranges."""
    grid = finer_grid(cube.grid, n_r=FACTOR)
    return replace(cube, values=np.asarray(sampler(grid), np.complex64), grid=grid)


class SampledMaps:
    """Range-azimuth maps (sequence, frame, 2, range, azimuth) of sequences, sampled in every way, and their labels."""

    def __init__(self, data: LabelledData, splits: tuple[str, ...], count: int, *, is_training: bool):
        allowed = np.flatnonzero(np.isin(data.columns["split"], splits))
        chosen = allowed[few_of(data.columns["label"][allowed], count)]
        self.label = torch.from_numpy(data.columns["label"][chosen].astype(np.int64))
        self.rooms = [str(room) for room in data.columns["room"][chosen]]
        found: dict[str, list[Tensor]] = {}
        for number, index in enumerate(map(int, chosen)):
            for name, cube in self._sampled(data.cube(index), number, is_training):
                found.setdefault(name, []).append(compute_log_maps([cube], data.config)[1][0])
        self.angle = {name: torch.stack(maps) for name, maps in found.items()}

    @staticmethod
    def _sampled(cube: RadarCube, seed: int, is_training: bool) -> Any:
        yield ALONE, cube
        for name, make in SAMPLERS.items():
            if name == "scatterers" and not is_training:
                continue
            sampler = make(cube)
            if is_training:
                for radius in RADII:
                    yield f"{name}_{radius}", at_radius(cube, sampler, radius, seed)
            if name != "scatterers":
                yield f"{name}_finer", of_more_ranges(cube, sampler)


def hits(
    train: SampledMaps, test: SampledMaps, names: tuple[str, ...], bins: int, tested: str, seed: int
) -> np.ndarray:
    """Which test sequences a network recognises that learned from the maps named."""
    maps, label = torch.cat([train.angle[name] for name in names]), train.label.repeat(len(names))

    def draw(rng: np.random.Generator) -> tuple[Tensor, ...]:
        chosen = torch.from_numpy(rng.integers(len(label), size=BATCH))
        _, angle = augmented(maps[chosen], maps[chosen], rng)
        return range_angle_images(angle, bins), label[chosen]

    torch.manual_seed(seed)
    network = CnnLstm(len(ACTIVITY_NAMES))
    with torch.no_grad():
        network(range_angle_images(maps[:1], bins))  # sizes its lazy layer
    trained(network, draw, STEPS, seed)
    with torch.no_grad():
        return (network(range_angle_images(test.angle[tested], bins)).argmax(dim=1) == test.label).double().numpy()


def rows_of(train: SampledMaps, test: SampledMaps) -> list[dict[str, Any]]:
    """A row for each way of sampling; augmentation and super-resolution each with their own baseline."""
    ways = {ALONE: ((ALONE,), 2, ALONE, ALONE)}
    for name in SAMPLERS:
        for radius in RADII:
            ways[f"{name}_{radius}"] = ((ALONE, f"{name}_{radius}"), 2, ALONE, ALONE)
    ways[OWN_BINS] = ((ALONE,), 1, ALONE, OWN_BINS)
    for name in ("zero_padding", "linear_raw"):
        ways[f"{name}_finer"] = ((f"{name}_finer",), 2, f"{name}_finer", OWN_BINS)
    found: dict[str, np.ndarray] = {}
    rows = []
    for name, (learned, bins, tested, baseline) in ways.items():
        found[name] = np.mean([hits(train, test, learned, bins, tested, seed) for seed in SEEDS], axis=0)
        metrics: dict[str, dict[str, Any]] = {}
        for metric, values in (("accuracy", found[name]), ("gain", found[name] - found[baseline])):
            mean, low, high = interval(values, test.rooms)
            metrics[metric] = {"value": mean, "interval_95": [low, high], "unit": "1"}
        metrics["accuracy"]["baseline"] = {
            "chance": 1 / len(ACTIVITY_NAMES), baseline: interval(found[baseline], test.rooms)[0],
        }  # fmt: skip
        print(f"{name:20} {metrics['accuracy']['value']:.3f} {metrics['gain']['interval_95']}", flush=True)
        rows.append({"method": name, "n": len(test.rooms), "num_rooms": len(set(test.rooms)), "metrics": metrics})
    return rows


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="rooms and people to learn from")
    parser.add_argument("--unseen", type=Path, action=Reads, required=True, help="rooms of other kinds")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    torch.set_num_threads(1)
    train = SampledMaps(read_labelled(options.data), TRAIN_SPLITS, RECORDINGS, is_training=True)
    test = SampledMaps(read_labelled(options.unseen), ("test_room",), TESTED, is_training=False)
    rows = complete_rows(
        rows_of(train, test), dataset=dataset_of(options.unseen), seeds=list(SEEDS),
        unknown={
            "seconds": "see the manifest: all rows together", "metrics.gain.baseline": "it is a difference to one",
        },
    )  # fmt: skip
    config = {"recordings": RECORDINGS, "radii": RADII, "steps": STEPS, "factor": FACTOR,
              "data_plan": read_plan(options.data), "unseen_plan": read_plan(options.unseen)}  # fmt: skip
    run.write("sampled_recordings", "cnn_lstm", config=config, rows=rows)
