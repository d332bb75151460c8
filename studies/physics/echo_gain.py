"""How much weaker are people's echoes in recordings than transmit power, antenna gains and noise figure promise?

    python -m studies run echo_gain --data <recordings>

Two people who move 2.93 m away, facing the radar or away from it (openradar_two_people), and a chest that breathes
0.33 m away (bgt60_breathing), over the noise of a cell; and simulated people at the same places over a concrete floor,
with typical boards whose gain is taken away. Whose steps and bodies were recorded is not known, so each simulated pair
is one guess, and their spread is the error of the gain. Nothing else of the recordings is looked at.
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.boards import find_board
from mmweaver.core.records import AdcCube
from mmweaver.evaluation.signal_evidence import ComparedSignal, SignalEvidence, decibels
from mmweaver.propagation.ray_traced import Simulator
from mmweaver.propagation.static_paths import ALL_PATHS
from mmweaver.signal.cube import radar_cube
from studies.manifest import StudyRun
from studies.physics.board_left_out import breather, recorded_breath, walkers
from studies.physics.empty_room_cube import empty_room
from studies.physics.signal_statistics import WALL_M, breathing_pose, recorded_people
from studies.result_rows import complete_rows
from studies.study import Reads

MOMENTS_S = (-0.4, -0.2, 0.0, 0.2, 0.4)  # a walker's frame depends on the step by some 10 dB
BODY_HALF_M = 0.4
CHEST_M = (0.2, 0.5)
FRAMES = 64  # of somebody who breathes
FLOOR_M = -1.1
PEOPLE = 24


def moving_level_db(adc: AdcCube) -> float:
    """Moving energy within 0.4 m of the strongest moving range bin over the noise of a cell."""
    evidence = _evidence(adc)
    assert evidence.noise is not None
    profile, _ = evidence.moving_profile
    body = int(evidence.body_bin[0])
    near = np.abs(evidence.range_m - evidence.range_m[body]) <= BODY_HALF_M
    return float(decibels(profile[0, near].sum() / evidence.noise[0]))


def chest_level_db(adc: AdcCube) -> float:
    """Strongest static range bin from 0.2 to 0.5 m, mean over the frames, over the noise of a cell."""
    evidence = _evidence(adc)
    assert evidence.noise is not None
    near = (evidence.range_m >= CHEST_M[0]) & (evidence.range_m <= CHEST_M[1])
    return float(decibels(evidence.still_power[:, near].mean(axis=0).max() / np.median(evidence.noise)))


def _evidence(adc: AdcCube) -> SignalEvidence:
    return SignalEvidence(ComparedSignal(name="", cube=radar_cube(adc), adc=adc))


def walkers_level_db(like: AdcCube, seed: int) -> float:
    """Of two people who walk past each other at the recorded distance; median of moments of the step."""
    scene = empty_room(floor_z_m=FLOOR_M, wall_y_m=WALL_M)
    radar = _radar(scene, like, seed)
    runs = [radar.run(walkers(scene, seed, moment_s), num_frames=1, seed=seed).adc for moment_s in MOMENTS_S]
    return float(np.median([moving_level_db(adc) for adc in runs]))


def breather_level_db(like: AdcCube, seed: int) -> float:
    """Of somebody who stands with the chest at the recorded distance."""
    scene = empty_room(floor_z_m=breathing_pose(seed, FRAMES)[1], wall_y_m=None)
    adc = _radar(scene, like, seed).run(breather(seed, FRAMES), num_frames=FRAMES, seed=seed).adc
    return chest_level_db(adc)


def _radar(scene: Any, like: AdcCube, seed: int) -> Simulator:
    """A typical board in a room, whose gain is what its figures promise."""
    board = replace(find_board("typical", like.config, seed), gain_db=0.0)
    return Simulator(scene, like.config, micro_seed=seed, propagation=ALL_PATHS, board=board)


RECORDINGS: dict[
    str, tuple[Callable[[Path], AdcCube], Callable[[AdcCube], float], Callable[[AdcCube, int], float]]
] = {
    "openradar_two_people": (recorded_people, moving_level_db, walkers_level_db),
    "bgt60_breathing": (recorded_breath, chest_level_db, breather_level_db),
}  # fmt: skip


def gain_row(name: str, recorded_db: float, simulated_db: list[float]) -> dict[str, Any]:
    """The gain that makes simulated people as strong as the recorded ones, with the spread over whom they may be."""
    gain_db = recorded_db - np.array(simulated_db)
    low, high = np.percentile(gain_db, [2.5, 97.5]).round(2).tolist()
    metric = {
        "value": round(float(np.median(gain_db)), 2), "unit": "dB", "interval_95": [low, high],
        "baseline": {"as_promised": 0.0}, "recorded_over_noise_db": round(recorded_db, 2),
        "simulated_over_noise_db": round(float(np.median(simulated_db)), 2),
        "definition": "level of people over the noise of a cell, recorded less simulated; 95 % over simulated people",
    }  # fmt: skip
    return {
        "method": name, "n": len(simulated_db), "seeds": list(range(len(simulated_db))),
        "dataset": {"name": name, "origin": "recorded"}, "metrics": {"echo_gain": metric},
    }  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--data", type=Path, action=Reads, required=True, help="folder with radar/ in it")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    rows = []
    for name, (read, level_db, simulate_db) in RECORDINGS.items():
        recording = read(options.data)
        rows.append(gain_row(name, level_db(recording), [simulate_db(recording, seed) for seed in range(PEOPLE)]))
        print(rows[-1]["metrics"], flush=True)
    unknown = {"dataset.sha256": "recordings are hashed in the manifest", "seconds": "see the manifest"}
    run.write("echo_gain", "physics", config={"people": PEOPLE}, rows=complete_rows(rows, unknown=unknown))
