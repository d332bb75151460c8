"""Windows of several caches, each scored on the developed half alone, with the commit that made them."""

import argparse
import json

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from studies.manifest import StudyRun
from studies.recognition import zero_shot_anew
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings
from studies.recognition.zero_shot_recipe import ACTIVITIES, radhar_recipe, write_window
from studies.recognition.zero_shot_training import TrainingSet

RECIPE = radhar_recipe()


def recording(label: str, name: str) -> PointRecording:
    """Points with velocities and a number a frame of their own for each activity."""
    kind, rng = list(ACTIVITIES).index(label), np.random.default_rng(len(name))
    frame = np.repeat(np.arange(RECIPE.frames), 2 + 2 * kind)
    x_m, zeros = 2.0 + 0.1 * rng.standard_normal(len(frame)), np.zeros(len(frame))
    velocity = (0.3 + 0.4 * kind) * np.sin(0.3 * frame)
    cloud = PointCloud(frame=frame, x_m=x_m, y_m=zeros, z_m=zeros, radial_velocity_mps=velocity, snr_db=zeros + 20)
    rate_hz = 1 / RECIPE.radar.frame_period_s
    return PointRecording(name=name, cloud=cloud, num_frames=RECIPE.frames, frame_rate_hz=rate_hz, label=label)


def few_trees(made: TrainingSet) -> ActivityClassifier:
    settings = ClassifierSettings(num_trees=10, boosting_rounds=5, repetitions=1)
    return ActivityClassifier(settings, made.names).fit(made.features, made.labels)


def test_each_cache_is_scored_on_the_developed_half_with_its_commit(tmp_path, monkeypatch):
    caches = [tmp_path / "old", tmp_path / "new"]
    for seed, cache in enumerate(caches):
        cache.mkdir()
        for label in ACTIVITIES:
            for index in range(5):
                write_window(cache / f"{label}_{seed}_{index}.npz", recording(label, "x" * index))
        (cache / "commit.txt").write_text(f"{cache.name}\n")
        (cache / "seconds_0.txt").write_text("3.5\n")
        (cache / "recipe.json").write_text("{}")
    known = [recording(label, f"{label}_20_{number}") for label in ACTIVITIES for number in (1, 2)]
    # were the other half scored, too, a tenth of its windows would be right
    others = [recording("walk", f"20_{label}_1") for label in ACTIVITIES]
    monkeypatch.setattr(zero_shot_anew, "radhar_recordings", lambda folder: known + others)
    monkeypatch.setattr(TrainingSet, "train", few_trees)
    (tmp_path / "recordings").mkdir()
    options = argparse.Namespace(caches=caches, recordings=tmp_path / "recordings")
    zero_shot_anew.run_study(options, StudyRun("zero_shot_anew", tmp_path))
    rows = json.loads((tmp_path / "zero_shot" / "anew.json").read_text())["rows"]
    assert [(row["windows_of_commit"], row["seeds"], row["windows"], row["n"]) for row in rows] == [
        ("old", [0], 25, 10), ("new", [1], 25, 10),
    ]  # fmt: skip
    assert [row["metrics"]["window"]["value"] for row in rows] == [1.0, 1.0]
    assert [row["core_seconds_of_windows"] for row in rows] == [3.5, 3.5]
