"""Bookkeeping of the study: which half a recording belongs to, and splits of generated windows."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.activity_classifier import ClassifierSettings
from mmweaver.recognition.radhar import radhar_recipe
from mmweaver.recognition.zero_shot import TrainingSet
from studies.recognition.zero_shot_scores import digest, first_draws, in_first_half, validate

FEW_TREES = ClassifierSettings(num_trees=10, boosting_rounds=5, repetitions=1)


def test_the_two_groups_of_recordings():
    assert in_first_half("Train_boxing_boxing_20_1")
    assert in_first_half("Train_jump____jump_20_14")
    assert not in_first_half("Train_boxing_20_boxing_1")
    assert not in_first_half("Train_squats___20_squats_2")


def test_a_feature_that_tells_the_label_scores_in_every_split():
    draws = [replace(one, wall_m=1.0 + index % 7) for index, one in enumerate(first_draws(radhar_recipe(), 16, seed=1))]
    labels = np.array(list(radhar_recipe().activities) * 16)
    features = np.unique(labels, return_inverse=True)[1].astype(np.float32)[:, None] + np.zeros((1, 4), np.float32)
    scores = validate(TrainingSet(features=features, labels=labels, names=("a", "b", "c", "d")), draws, FEW_TREES)
    assert {"every_third", "tempo_low", "noise_db_high"} <= set(scores)
    assert min(scores.values()) > 0.9


def test_the_digest_is_of_the_recordings(tmp_path):
    (tmp_path / "a.txt").write_text("one")
    one = digest(tmp_path)
    (tmp_path / "notes.md").write_text("not a recording")
    assert digest(tmp_path) == one
    (tmp_path / "a.txt").write_text("two")
    assert digest(tmp_path) != one
