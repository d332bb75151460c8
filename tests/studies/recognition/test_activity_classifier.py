"""The classifier learns, accepts missing values, and is reproducible."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.errors import InputError
from studies.recognition.activity_classifier import ActivityClassifier, ClassifierSettings

SMALL = ClassifierSettings(num_trees=30, boosting_rounds=20)


def data(seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    kind = rng.integers(3, size=150)
    features = rng.standard_normal((150, 5)).astype(np.float32)
    features[:, 0] += 3 * kind
    features[rng.random((150, 5)) < 0.05] = np.nan
    return features, np.array(["a", "b", "c"])[kind]


def test_it_recognises_unseen_rows():
    model = ActivityClassifier(SMALL).fit(*data(0))
    features, labels = data(1)
    assert np.mean(model.predict(features) == labels) > 0.8
    assert model.classes == ("a", "b", "c")
    assert np.allclose(model.probabilities(features).sum(axis=1), 1.0)


def test_shuffled_labels_teach_nothing():
    features, labels = data(0)
    model = ActivityClassifier(SMALL).fit(features, np.random.default_rng(5).permutation(labels))
    unseen, truth = data(1)
    assert np.mean(model.predict(unseen) == truth) < 0.55


def test_training_again_gives_the_same_votes():
    features, _ = data(1)
    votes = [ActivityClassifier(SMALL).fit(*data(0)).probabilities(features) for _ in range(2)]
    assert np.array_equal(votes[0], votes[1])


def test_columns_without_values_do_no_harm():
    features, labels = data(0)
    features[:, 3], features[:, 4] = np.nan, 7.0
    model = ActivityClassifier(SMALL).fit(features, labels)
    assert np.mean(model.predict(features) == labels) > 0.8
    with pytest.raises(InputError, match="identical"):
        ActivityClassifier(SMALL).fit(features[:, 3:], labels)


def test_repetitions_are_averaged():
    features, labels = data(0)
    unseen, _ = data(1)
    alone = [ActivityClassifier(replace(SMALL, seed=seed)).fit(features, labels) for seed in (0, 1)]
    both = ActivityClassifier(replace(SMALL, repetitions=2)).fit(features, labels)
    assert np.allclose(both.probabilities(unseen), np.mean([one.probabilities(unseen) for one in alone], axis=0))
