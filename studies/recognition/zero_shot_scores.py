"""Activity recognition trained on generated data alone, tested on recordings of people: RadHAR's five activities.

python -m studies run zero_shot_scores generate --cache FOLDER --each 300 --seed 1      # resumable
python -m studies run zero_shot_scores score NAME --recordings shared/data/pointclouds/radhar
"""

import argparse
import hashlib
import json
import re
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.scoring import Evaluation, report
from studies.manifest import StudyRun
from studies.provenance import provenance
from studies.recognition.zero_shot_recipe import (
    GenerationRecipe,
    check_cache,
    generate_window,
    radhar_recipe,
    read_window,
    write_window,
)
from studies.recognition.zero_shot_training import (
    evaluate_recogniser,
    load_frozen,
    radhar_recordings,
)
from studies.study import Reads

METRICS = {
    "window": "balanced accuracy of windows of 2 s, one after the other",
    "three_windows": "balanced accuracy of the mean vote of three windows (6 s)",
    "recording": "balanced accuracy of the mean vote of a whole recording",
}


def score(name: str, recordings: Path, run: StudyRun) -> Path:
    """Scores a frozen recogniser on recordings of real people and writes results/zero_shot/NAME.json.

    One row for all recordings, one each for the two halves by name.
    """
    began = time.process_time()
    frozen = load_frozen(name)
    evaluated = evaluate_recogniser(frozen.train(), radhar_recordings(recordings), frozen.window_s)
    seconds = time.process_time() - began
    first = np.array([in_first_half(one) for one in evaluated.names])[evaluated.recording]
    parts = {
        "all recordings": np.ones_like(first),
        "first half of the names": first,
        "second half of the names": ~first,
    }
    rows = [
        result_row(evaluated.part(which), recordings, words, seconds=seconds)
        for words, which in parts.items()
        if which.any()
    ]
    config = {"frozen": name, **frozen.provenance, "classifier": asdict(frozen.classifier)}
    return run.write("zero_shot", name, config=config, rows=rows)


def in_first_half(name: str) -> bool:
    """Which of RadHAR's two groups of names: the activity stands before the 20 in the first.

    >>> in_first_half("Train_walk____walk_20_9"), in_first_half("Train_walk____20_walk_9")
    (True, False)
    """
    return re.search(r"[a-z]_20_\d+$", name) is not None


def result_row(evaluated: Evaluation, recordings: Path, which: str, *, seconds: float) -> dict[str, Any]:
    """Scores in the schema of results."""
    found = report(evaluated)
    return {
        "dataset": {"name": f"RadHAR, {which}", "recordings": found["recordings"], "sha256": digest(recordings)},
        "n": found["window"]["n"],
        "seeds": [0],
        "seconds": {"all": round(seconds, 1)},
        "classes": found["classes"],
        "metrics": {
            key: {
                "value": found[key]["balanced_accuracy"], "unit": "share", "definition": words, "version": 1,
                "interval_95": found[key]["interval_95"], "baseline": found[key]["baseline"],
                "n": found[key]["n"], "confusion": found[key]["confusion"],
            }
            for key, words in METRICS.items()
        },
    }  # fmt: skip


def digest(folder: Path) -> str:
    """One hash of all recordings of a folder."""
    total = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".npz", ".txt"):
            total.update(hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


def read_cache(cache: Path) -> tuple[list[PointRecording], dict[str, Any]]:
    """The windows of a cache, and their source: commit, seed, number, core seconds, recipe."""
    recipe = radhar_recipe()
    files = sorted(cache.glob("*_*_*.npz"))
    windows = [read_window(path, path.stem.split("_")[0], recipe) for path in files]
    source = {
        "commit": (cache / "commit.txt").read_text(encoding="utf-8").strip(),
        "seed": int(files[0].stem.split("_")[1]),
        "windows": len(files),
        "core_seconds": sum(float(path.read_text(encoding="utf-8")) for path in cache.glob("seconds_*.txt")),
        "recipe": json.loads((cache / "recipe.json").read_text(encoding="utf-8")),
    }
    return windows, source


def generate(recipe: GenerationRecipe, cache: Path, *, each: int, seed: int, part: int = 0, parts: int = 1) -> None:
    """Fills a cache and records the commit in it; several processes may share one, each with its part."""
    check_cache(cache, recipe)
    (cache / "commit.txt").write_text(f"{_commit_text()}\n", encoding="utf-8")
    note = cache / f"seconds_{part}.txt"
    spent_s = float(note.read_text(encoding="utf-8")) if note.exists() else 0.0
    for index in range(part, each, parts):
        for label in recipe.activities:
            path = cache / f"{label}_{seed}_{index}.npz"
            if not path.exists():
                began = time.process_time()
                write_window(path, generate_window(recipe, label, index, seed))
                spent_s += time.process_time() - began
                note.write_text(f"{spent_s:.1f}\n", encoding="utf-8")


def _commit_text() -> str:
    """The commit, with "+" where files differ from it."""
    source = provenance()
    return f"{source['commit']}{'+' if source['dirty'] else ''}"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("what", choices=("generate", "score"))
    parser.add_argument("name", nargs="?", default="development", help="name of the frozen recogniser")
    parser.add_argument("--cache", type=Path, help="folder of generated windows")
    parser.add_argument("--each", type=int, default=300, help="windows of each activity")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--part", type=int, default=0)
    parser.add_argument("--parts", type=int, default=1)
    parser.add_argument("--recordings", type=Path, action=Reads)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    if options.what == "score":
        score(options.name, options.recordings, run)
        return
    generate(
        radhar_recipe(), options.cache, each=options.each, seed=options.seed, part=options.part, parts=options.parts
    )
