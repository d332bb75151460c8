"""How much CPU time does a sentence take to be composed in a room that is known already?

python -m studies run compose_times --rooms /path/to/rooms

The bundled sample, photographed rooms, and a procedural room of every kind, seen in the radar's default window. The
first sentence in a room, which leads to a seat, pays for what is computed once a room, and is reported apart. Each room
is begun anew three times, and each sentence counts with the least, as other programs take their part of a core. Results
are named by `--name`, so that two versions can be compared on the same machine in the same hour.
"""

import argparse
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.records import Scene
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.scene.procedural.procedural_room import make_room
from mmweaver.scene.procedural.room_kinds import KINDS
from mmweaver.scene.read_photo import read_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.sample_photo import sample_photo
from studies.manifest import StudyRun
from studies.result_rows import complete_rows
from studies.study import Reads

SENTENCES = (
    "she walks, then sits down", "a person walks to the left, then waves", "user seated on couch drinking water",
    "he does jumping jacks", "someone walks towards the radar, turns around and walks away", "a man boxes quickly",
    "she claps", "he squats", "a person stands up", "a person turns around",
)  # fmt: skip
RANGE_WINDOW_M, SECONDS, SEEDS, TIMES_BEGUN = (0.70, 3.48), 3.0, 1, 3
FIRST_SEED, PER_KIND = 14000, 1  # of the procedural rooms: some of those on which placements were developed
UNKNOWN = {
    "dataset.sha256": "rendered anew in every run; photos are hashed in the manifest",
    "seconds": "see the manifest: all rows together",
}


def composed_s(scene: Scene) -> tuple[float, list[float], int]:
    """CPU-seconds until a first sentence is composed in a scene, of each further one, and how many are refused."""
    seconds, refused, first = [], 0, 0
    for seed in range(SEEDS):
        for text in SENTENCES:
            begin = time.process_time()
            try:
                compose(plan_motion(text, SECONDS), scene, seed=seed, range_window_m=RANGE_WINDOW_M)
            except InputError:
                refused += 1
                first += refused == len(seconds) + 1  # none composed yet
            seconds.append(time.process_time() - begin)
    return sum(seconds[: first + 1]), seconds[first + 1 :], refused


def least_s(runs: list[tuple[float, list[float], int]]) -> tuple[float, list[float], int]:
    """The least of several runs of `composed_s` in copies of one scene, sentence by sentence."""
    further = [min(times) for times in zip(*(seconds for _, seconds, _ in runs), strict=True)]
    return min(first for first, _, _ in runs), further, runs[0][2]


def room_row(name: str, scenes: list[Scene]) -> dict[str, Any]:
    """The row of one room, or of the rooms of a kind."""
    parts = [least_s([composed_s(replace(scene)) for _ in range(TIMES_BEGUN)]) for scene in scenes]
    each = np.array([second for _, seconds, _ in parts for second in seconds])
    return {
        "dataset": {"name": name, "split": "rooms on which placements were developed"},
        "n": len(each) + len(parts), "seeds": list(range(SEEDS)), "refused": sum(part[2] for part in parts),
        "metrics": {
            "mean_s": _metric(float(each.mean()), "CPU-seconds a sentence, the first in each room apart: mean"),
            "p90_s": _metric(float(np.percentile(each, 90)), "the same, 90th percentile"),
            "worst_s": _metric(float(each.max()), "the same, slowest"),
            "first_s": _metric(float(np.mean([part[0] for part in parts])), "of the first sentence in a room"),
        },
    }  # fmt: skip


def _metric(value: float, definition: str) -> dict[str, Any]:
    return {"value": round(value, 4), "unit": "s", "definition": definition, "version": 1}


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--rooms", type=Path, action=Reads, default=None, help="folder of the photographed rooms")
    parser.add_argument("--name", default="distance_field", help="name of the result")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    compose(plan_motion("a person claps", 1.0), _sample(), seed=0, range_window_m=RANGE_WINDOW_M)  # imports
    rows = [room_row("bundled sample", [_sample()])]
    folders = [] if options.rooms is None else sorted(options.rooms.iterdir())
    for folder in folders:
        if (folder / "camera.json").is_file():
            photo, assumptions = read_photo(folder / "rgb.png", folder / "depth.png", folder / "camera.json")
            rows.append(room_row(folder.name, [reconstruct(photo, assumptions=assumptions)]))
    for kind in KINDS:
        photos = [make_room(kind, 0, FIRST_SEED + number).photo("day", noise=True) for number in range(PER_KIND)]
        rows.append(room_row(f"procedural, {kind}", [reconstruct(photo) for photo in photos]))
    config = {"sentences": list(SENTENCES), "seconds": SECONDS, "range_window_m": list(RANGE_WINDOW_M)}
    run.write("compose_times", options.name, config=config, rows=complete_rows(rows, unknown=UNKNOWN))


def _sample() -> Scene:
    photo, assumptions = sample_photo()
    return reconstruct(photo, assumptions=assumptions)
