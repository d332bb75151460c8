"""How strongly should arms and legs scatter? Trained on windows of weak, medium and strong limbs, tested on RadHAR.

python -m studies run zero_shot_limbs --cache windows/ --each 200 --seed 8 --recordings RADHAR

The strengths of the simulator's limbs were estimated on another data set, MARS: this tests them in another room. Each
third of the windows, by the sampled strength of a limb, is trained on alone and scored on all recordings.
"""

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.random_scene import VariationSample
from mmweaver.recognition.scoring import report
from studies.manifest import StudyRun
from studies.recognition.zero_shot_recipe import radhar_recipe
from studies.recognition.zero_shot_scores import digest, first_draws, read_cache
from studies.recognition.zero_shot_training import evaluate_recogniser, featurize, radhar_recordings
from studies.study import Reads

LIMBS = ("arms_db", "legs_db")
THIRDS = ("faintest", "middle", "brightest")


def thirds(value: np.ndarray) -> np.ndarray:
    """0, 1 or 2: the third of all values that each is in.

    >>> thirds(np.array([5.0, 1.0, 3.0])).tolist()
    [2, 0, 1]
    """
    return np.argsort(np.argsort(value)) * 3 // len(value)


def limb_strengths(
    windows: list[PointRecording], samples: list[VariationSample], labels: tuple[str, ...], limb: str
) -> np.ndarray:
    """The sampled strength of a limb in each window, dB; `samples` in the order of `first_draws` for these labels."""
    kinds = {label: place for place, label in enumerate(labels)}
    index = [int(window.name.rsplit("_", 1)[1]) * len(kinds) + kinds[window.label or ""] for window in windows]
    return np.array([getattr(samples[at], limb) for at in index])


def measure(cache: Path, each: int, seed: int, recordings: Path, run: StudyRun) -> Path:
    """Writes results/zero_shot/limbs.json."""
    recipe = radhar_recipe()
    windows, source = read_cache(cache)
    people = radhar_recordings(recordings)
    samples, labels = first_draws(recipe, each, seed), tuple(recipe.activities)
    rows: list[dict[str, Any]] = []
    for limb in LIMBS:
        value = limb_strengths(windows, samples, labels, limb)
        for third, word in enumerate(THIRDS):
            began = time.process_time()
            own = thirds(value) == third
            model = featurize([window for window, one in zip(windows, own, strict=True) if one], seed=seed).train()
            found = report(evaluate_recogniser(model, people, recipe.window_s))["window"]
            rows.append({
                "dataset": {"name": f"RadHAR, {limb[:4]}, {word} third", "sha256": digest(recordings)},
                "n": int(own.sum()), "seeds": [seed], "seconds": {"all": round(time.process_time() - began, 1)},
                "limb": limb, "from_db": round(float(value[own].min()), 1), "to_db": round(float(value[own].max()), 1),
                "metrics": {"window": {
                    "value": found["balanced_accuracy"], "unit": "share", "version": 1, "baseline": {"chance": 0.2},
                    "interval_95": found["interval_95"],
                    "definition": "balanced accuracy of windows of 2 s, trained on that third of the windows alone",
                }},
            })  # fmt: skip
    config = {key: held for key, held in source.items() if key != "recipe"}
    return run.write("zero_shot", "limbs", config=config, rows=rows)


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--cache", type=Path, action=Reads, required=True)
    parser.add_argument("--each", type=int, default=200)
    parser.add_argument("--seed", type=int, default=8)
    parser.add_argument("--recordings", type=Path, action=Reads, required=True)


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    measure(options.cache, options.each, options.seed, options.recordings, run)
