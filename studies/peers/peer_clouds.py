"""How near are RF-Genesis' point clouds to those of a real board, next to ours, from the same joints?

    python -m studies run peer_clouds --data shared/data/pointclouds/mars/subject1

The recordings and the detection chain of study `mars`, where the truth is nobody's simulator: a Kinect's joints through
RF-Genesis' tracer, the board's noise and the firmware's chain, against the recorded cloud of each frame. Where the
radar stands and how tall the person is were estimated by `mars`, whose result is read. RF-Genesis has neither a scale
nor noise: its gain and the CFAR's threshold are estimated on `validate` as ours were, by median intensity and number of
points, for each of its rows; thermal noise and converter are the preset's. `test` is only scored.
"""

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

import numpy as np
import torch

from mmweaver.core.errors import InputError
from mmweaver.core.presets import IWR1443_MARS
from mmweaver.core.records import AdcCube
from mmweaver.paths.receiver import IDEAL, Receiver, quantise
from studies.manifest import StudyRun
from studies.peers.rf_genesis import RfGenesis
from studies.physics.cloud_scores import score
from studies.physics.mars import (
    PIECE_FRAMES,
    PIECES,
    Clouds,
    MarsVariant,
    Setup,
    centroid_baseline,
    detect,
    levels,
    mars_digests,
    neighbour_oracle,
    random_frame_baseline,
    simulate,
    smoothed,
)
from studies.physics.mars_data import MarsStretch, read_mars
from studies.physics.mars_pieces import cut, pose_of
from studies.result_rows import complete_rows
from studies.study import Reads

PIECES_TO_ESTIMATE = 6
BASELINES, ORACLES = ("centroid", "random_real_frame"), ("neighbouring_frame",)
TRACERS = {
    "rf_genesis_as_released": RfGenesis(has_environment=False),
    "rf_genesis_repaired": RfGenesis(repaired=True, has_environment=False),
}


def traced(tracer: RfGenesis, pieces: list[MarsStretch], setup: Setup) -> list[AdcCube]:
    """RF-Genesis' samples of each piece, of unknown scale and without noise."""
    found = []
    for piece in pieces:
        still = replace(piece, joints_m=smoothed(piece.joints_m, MarsVariant().smoothing_frames))
        found.append(tracer.adc(pose_of(still, setup.shift_m, setup.height_m), IWR1443_MARS, int(piece.frame[-1]) + 1))
    return found


def received(adc: AdcCube, gain_db: float) -> AdcCube:
    """Samples times a gain, with the preset's thermal noise and converter."""
    receiver = Receiver(adc.config, replace(IDEAL, thermal_noise=True), seed=0)
    samples = adc.samples * np.float32(10 ** (gain_db / 20))
    for frame, values in enumerate(samples):
        values += receiver.noise(values.shape, frame)
    quantise(torch.from_numpy(samples), receiver.count_sqrt_mw)
    return replace(adc, samples=samples)


def clouds_of(adcs: list[AdcCube], pieces: list[MarsStretch], own: Setup, setup: Setup) -> Clouds:
    """The firmware's points with the gain of `setup` before the receiver, and our receiver's gain after it."""
    heard = [received(adc, setup.gain_db) for adc in adcs]
    return detect(heard, pieces, replace(own, threshold=setup.threshold), MarsVariant())


def as_loud(adcs: list[AdcCube], ours: list[AdcCube]) -> float:
    """The gain in dB that gives samples the power that ours have without their mean chirp: where the search begins."""
    power = [np.mean([np.var(one.samples, axis=1).mean() for one in each]) for each in (ours, adcs)]
    return round(float(10 * np.log10(power[0] / max(power[1], 1e-300))), 1)


def estimated(tracer: RfGenesis, pieces: list[MarsStretch], own: Setup) -> Setup:
    """Gain and threshold of a tracer, from recorded pieces; all else is ours."""
    adcs = traced(tracer, pieces, own)
    begin = replace(own, gain_db=as_loud(adcs, simulate(pieces, own, MarsVariant())))
    return levels(begin, [piece.clouds for piece in pieces], partial(clouds_of, adcs, pieces, own))


def own_setup(results: Path) -> Setup:
    """What study `mars` estimated. Raises InputError where its result is missing."""
    file = results / "mars" / "simulator.json"
    if not file.is_file():
        raise InputError(f"{file} is missing; run study mars first")
    values = json.loads(file.read_text(encoding="utf-8"))["config"]["estimated_on_validate"]
    x_m, y_m, z_m = values.pop("shift_m")
    return Setup(shift_m=(x_m, y_m, z_m), **values)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder of a MARS subject")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    validate, test = read_mars(options.data, "validate"), read_mars(options.data, "test")
    own = own_setup(options.results)
    pieces, known = cut(test, PIECE_FRAMES, PIECES), cut(validate, PIECE_FRAMES, PIECES_TO_ESTIMATE)
    setups = {name: estimated(tracer, known, own) for name, tracer in TRACERS.items()}
    methods: dict[str, Callable[[], Clouds]] = {
        "centroid": lambda: centroid_baseline(pieces, own),
        "random_real_frame": lambda: random_frame_baseline(pieces, validate),
        "simulator": lambda: detect(simulate(pieces, own, MarsVariant()), pieces, own, MarsVariant()),
        "neighbouring_frame": lambda: neighbour_oracle(pieces),
    }
    for name, tracer in TRACERS.items():
        methods[name] = lambda name=name, tracer=tracer: clouds_of(
            traced(tracer, pieces, own), pieces, own, setups[name]
        )
    rows = []
    real: Clouds = [piece.clouds for piece in pieces]
    scores = {}
    for name, method in methods.items():
        began = time.process_time()
        scores[name] = score(method(), real)
        seconds = round(time.process_time() - began, 1)
        print(f"{name:28s} {seconds:6.1f} CPU-s {scores[name].line()}", flush=True)
        metrics = scores[name].metrics(floor=scores["centroid"])
        rows.append({"method": name, "n": scores[name].num_frames, "seconds": {"cpu": seconds}, "metrics": metrics})
    run.write(
        "peer_clouds", "mars_test",
        config={"own": asdict(own), "estimated_on_validate": {name: asdict(one) for name, one in setups.items()},
                "frames_a_piece": PIECE_FRAMES, "pieces_to_estimate": PIECES_TO_ESTIMATE},
        rows=complete_rows(
            rows, dataset={"name": "MARS subject 1, test", "sha256": mars_digests(options.data)}, seeds=[0],
            baselines=BASELINES, oracles=ORACLES,
        ),
    )  # fmt: skip
