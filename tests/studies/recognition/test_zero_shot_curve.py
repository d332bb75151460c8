"""Real recordings drawn for training, and accuracy on the others."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from studies.recognition.activity_classifier import ClassifierSettings
from studies.recognition.zero_shot_curve import accuracy, chosen_recordings
from studies.recognition.zero_shot_training import Frozen, TrainingSet

LABELS = np.array(["a", "b"])[np.arange(40) % 2]


def rows(shift: float) -> np.ndarray:
    rng = np.random.default_rng(int(10 * shift))
    return (np.arange(40)[:, None] % 2 + shift + 0.1 * rng.standard_normal((40, 4))).astype(np.float32)


def test_so_many_of_each_are_drawn():
    chosen = chosen_recordings(LABELS, 3, seed=0)
    assert sorted(LABELS[chosen]) == ["a"] * 3 + ["b"] * 3
    assert set(chosen) != set(chosen_recordings(LABELS, 3, seed=1))
    assert len(chosen_recordings(LABELS, 0, seed=0)) == 0


def test_real_windows_mend_what_generated_ones_got_wrong():
    names = ("p", "q", "r", "s")
    made = TrainingSet(features=rows(5.0), labels=LABELS, names=names)  # generated far away from the real ones
    frozen = Frozen(
        training=made,
        classifier=ClassifierSettings(num_trees=30, boosting_rounds=15, leaf_size=1),
        window_s=2.0,
        provenance={},
    )
    none, some = np.zeros(40, bool), np.arange(40) < 20
    assert accuracy(frozen, rows(0.0), LABELS, none, generated=True) < 0.6
    assert accuracy(frozen, rows(0.0), LABELS, some, generated=True) > 0.9
    assert accuracy(frozen, rows(0.0), LABELS, some, generated=False) > 0.9
