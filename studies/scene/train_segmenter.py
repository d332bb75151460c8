"""Trains the built-in segmenter on procedural rooms, and scores it on kinds of rooms that it never saw.

python -m studies run train_segmenter --out segmenter.safetensors --log segmenter.json --work work/

`--work` keeps the rooms and the state of the training: a run that was stopped continues from there.
"""

import argparse
import json
from pathlib import Path

from studies.manifest import StudyRun
from studies.scene.segmenter_training import SegmenterRecipe
from studies.scene.segmenter_training import run as train_and_score


def add_options(parser: argparse.ArgumentParser) -> None:
    recipe = SegmenterRecipe()
    parser.add_argument("--out", type=Path, required=True, help="file of the weights")
    parser.add_argument("--log", type=Path, required=True, help="file of recipe, losses and scores, JSON")
    parser.add_argument("--work", type=Path, default=None, help="folder of rooms and state, to continue a stopped run")
    parser.add_argument("--rooms", type=int, default=recipe.rooms_per_kind, help="rooms of each kind")
    parser.add_argument("--epochs", type=int, default=recipe.epochs)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    log = train_and_score(
        options.out, SegmenterRecipe(rooms_per_kind=options.rooms, epochs=options.epochs), options.work
    )
    options.log.write_text(json.dumps(log, indent=1) + "\n", encoding="utf-8")
