"""Does a MotionGPT do what the sentence says? Evaluated by a classifier that was trained on the library alone.

python -m studies run motiongpt_scores --model weights/motiongpt_small.safetensors --data shared/data

R-precision: among the twelve activities, is the requested one the classifier's first (or one of its first three)?
Baselines: chance, and random codes through the same decoder. Oracles: motions of the library with seeds that nothing
was trained on, and the same after the quantization of the tokenizer.
"""

import argparse
import time
from pathlib import Path
from typing import Any

import numpy as np
import torch
from jaxtyping import Bool, Float

from mmweaver.core.seeding import stream
from mmweaver.core.skeleton import BONES
from mmweaver.io.result_folder import file_digest
from mmweaver.motion.mocap.joint_arrays import FPS, joints_from_features
from mmweaver.motion.motiongpt.motiongpt import MotionGPT
from studies.manifest import StudyRun
from studies.motion.humanml3d_features import features_from_joints, y_up
from studies.motion.motion_classifier import MotionClassifier, train_classifier
from studies.motion.motiongpt_data import (
    ACTIVITIES,
    CMU_FILE,
    FRAMES,
    SentenceExample,
    cmu_examples,
    library_examples,
    sentence_of,
)
from studies.result_rows import complete_rows
from studies.study import Reads

Array = np.ndarray
CLASSIFIER_SEEDS, TEST_SEEDS = range(3000, 3060), range(7000, 7025)
RESAMPLES = 2000
Motions = list[tuple[str, Array]]  # asked activity, features (frame, 263)


def generated(model: MotionGPT, seeds: range, *, held_out_words: bool) -> Motions:
    """One motion of each activity and seed; features computed from the joints that a user gets."""
    made: Motions = []
    for seed in seeds:
        for activity in ACTIVITIES:
            sentence = sentence_of(activity, seed, held_out=held_out_words)
            clip = model.generate(sentence, seconds=FRAMES / FPS, seed=seed)
            made.append((activity, features_from_joints(y_up(clip.joints_m))))
    return made


def through_tokenizer(model: MotionGPT, examples: list[SentenceExample]) -> Motions:
    """The same motions, encoded and decoded."""
    return [(example.activity, _again(model.features_of(model.codes_of(example.features)))) for example in examples]


def random_codes(model: MotionGPT, seeds: range) -> Motions:
    """Uniformly random codes through the decoder: what the decoder alone contributes."""
    made: Motions = []
    for seed in seeds:
        rng = stream(seed, "motiongpt", "random codes")
        for activity in ACTIVITIES:
            codes = rng.integers(model.tokenizer.config.codes, size=FRAMES // model.tokenizer.config.frames_per_token)
            made.append((activity, _again(model.features_of(codes.tolist()))))
    return made


def _again(features: Float[Array, "frame 263"]) -> Float[Array, "frame_less_one 263"]:
    return features_from_joints(joints_from_features(features))


def hits(classifier: MotionClassifier, motions: Motions, first: int) -> Bool[Array, " motion"]:
    """Whether the activity asked for is among the classifier's first."""
    ranks = classifier.ranks([features for _, features in motions])
    asked = np.array([ACTIVITIES.index(activity) for activity, _ in motions])
    return (ranks[:, :first] == asked[:, None]).any(axis=1)


def interval(right: Bool[Array, " motion"], per_seed: int) -> list[float]:
    """95 % bootstrap interval of a share over seeds (all motions of one together)."""
    groups = right[: len(right) // per_seed * per_seed].reshape(-1, per_seed).mean(axis=1)
    rng = stream(0, "motiongpt", "interval")
    means = groups[rng.integers(len(groups), size=(RESAMPLES, len(groups)))].mean(axis=1)
    return [float(value) for value in np.percentile(means, [2.5, 97.5])]


def bone_spread(motions: Motions) -> float:
    """Variation of bone lengths: 5th to 95th percentile over the median, mean over bones and motions."""
    spreads = []
    for _, features in motions:
        joints = joints_from_features(features)
        for parent, child in BONES:
            low, middle, high = np.percentile(
                np.linalg.norm(joints[:, child] - joints[:, parent], axis=-1), [5, 50, 95]
            )
            spreads.append((high - low) / middle)
    return float(np.mean(spreads))


def row(name: str, classifier: MotionClassifier, motions: Motions, seconds: float) -> dict[str, Any]:
    """One row of the result. Where not every seed has every activity, intervals are over single motions."""
    top1, top3 = hits(classifier, motions, 1), hits(classifier, motions, 3)
    together = len(ACTIVITIES) if len(motions) % len(ACTIVITIES) == 0 else 1
    asked = np.array([activity for activity, _ in motions])
    return {
        "dataset": {"name": name, "sha256": None}, "n": len(motions),
        "seeds": [TEST_SEEDS.start, TEST_SEEDS.stop], "seconds": {"cpu": round(seconds, 2)},
        "metrics": {
            "r_precision_1": {
                "value": float(top1.mean()), "unit": "share", "version": 1, "baseline": {"chance": 1 / 12},
                "interval_95": interval(top1, together),
                "definition": "the activity asked for is the classifier's first of twelve",
                "n_by_activity": {a: int((asked == a).sum()) for a in ACTIVITIES if (asked == a).any()},
                "by_activity": {a: float(top1[asked == a].mean()) for a in ACTIVITIES if (asked == a).any()},
            },
            "r_precision_3": {
                "value": float(top3.mean()), "unit": "share", "version": 1, "baseline": {"chance": 3 / 12},
                "interval_95": interval(top3, together),
                "definition": "the activity asked for is among the classifier's first three of twelve",
            },
            "bone_spread": {
                "value": bone_spread(motions), "unit": "share", "version": 1,
                "definition": "5th to 95th percentile of a bone's length over its median, mean over bones and motions",
            },
        },
    }  # fmt: skip


def score(model_path: Path, data: Path, run: StudyRun) -> Path:
    """Scores a model and writes results/motiongpt/<file>.json."""
    torch.set_num_threads(1)
    model = MotionGPT.load(model_path)
    classifier = train_classifier(list(library_examples(CLASSIFIER_SEEDS)))
    library = list(library_examples(TEST_SEEDS))
    rows: list[dict[str, Any]] = []

    def add(name: str, made: Any) -> None:
        began = time.process_time()
        motions = made()
        if motions:
            rows.append(row(name, classifier, motions, time.process_time() - began))

    add("library, unseen seeds (oracle)", lambda: [(e.activity, e.features) for e in library])
    add("library through the tokenizer (its oracle)", lambda: through_tokenizer(model, library))
    add("generated, sentences as trained", lambda: generated(model, TEST_SEEDS, held_out_words=False))
    add("generated, words never trained", lambda: generated(model, TEST_SEEDS, held_out_words=True))
    add("random codes (baseline)", lambda: random_codes(model, TEST_SEEDS))
    if (data / CMU_FILE).is_file():
        real = list(cmu_examples(data, "test"))
        add("CMU recordings, test clips (walk, run, jump)", lambda: [(e.activity, e.features) for e in real])
    config = {
        "model": model_path.name, "sha256": file_digest(model_path)["sha256"], "activities": ACTIVITIES,
        "frames": FRAMES, "fps": FPS, "classifier": "MLP on mean, spread, least, most of 263 features; library alone",
        "judge_seeds": [CLASSIFIER_SEEDS.start, CLASSIFIER_SEEDS.stop],
    }  # fmt: skip
    unknown = {"dataset.sha256": "generated anew in every run; recordings are hashed in the manifest"}
    return run.write("motiongpt", model_path.stem, config=config, rows=complete_rows(rows, unknown=unknown))


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--model", type=Path, action=Reads, required=True, help="a MotionGPT checkpoint")
    parser.add_argument("--data", type=Path, action=Reads, default=Path("shared/data"), help="folder of real data")


def run_study(options: argparse.Namespace, run: StudyRun) -> None:
    score(options.model, options.data, run)
