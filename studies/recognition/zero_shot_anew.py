"""What do the windows of RadHAR's recipe score when they are generated anew by today's motions and signals?

    python -m studies run zero_shot_anew --caches windows/ --recordings shared/data/pointclouds/radhar

The frozen windows are of the version that was tuned on these recordings. A cache is filled by study `zero_shot_scores
generate`, by this version or an earlier one; its commit and seed are reported. The score is on the first half of the
names, on which recipe and motions were developed, with today's features and trees. Nothing is chosen by it.
"""

import argparse
import time
from pathlib import Path

from mmweaver.recognition.point_recordings import PointRecording
from studies.manifest import StudyRun
from studies.recognition.zero_shot_recipe import radhar_recipe
from studies.recognition.zero_shot_scores import in_first_half, read_cache, result_row
from studies.recognition.zero_shot_training import evaluate_recogniser, featurize, radhar_recordings
from studies.result_rows import complete_rows
from studies.study import Reads

UNKNOWN = {"seconds": "of the windows: core_seconds_of_windows"}


def developed(recordings: list[PointRecording]) -> list[PointRecording]:
    """Recordings of the half of names that recipe and motions were developed on."""
    return [one for one in recordings if in_first_half(one.name)]


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--caches", type=Path, action=Reads, nargs="+", required=True, help="of zero_shot_scores generate"
    )
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    people, rows = developed(radhar_recordings(options.recordings)), []
    for cache in options.caches:
        began = time.process_time()
        windows, source = read_cache(cache)
        model = featurize(windows, seed=source["seed"]).train()
        evaluated = evaluate_recogniser(model, people, radhar_recipe().window_s)
        seconds = time.process_time() - began
        row = result_row(evaluated, options.recordings, "first half of the names", seconds=seconds)
        row |= {
            "windows_of_commit": source["commit"], "windows": source["windows"], "seed": source["seed"],
            "seeds": [source["seed"]],
            "core_seconds_of_windows": source["core_seconds"],
        }  # fmt: skip
        rows.append(row)
        print(
            source["commit"], source["seed"], row["metrics"]["window"]["value"], row["metrics"]["window"]["interval_95"]
        )
    run.write("zero_shot", "anew", config={"recipe": "radhar"}, rows=complete_rows(rows, unknown=UNKNOWN))
