"""Quantiles of features: matching undoes a change of gain, distances notice it."""

import numpy as np

from mmweaver.recognition.feature_matching import FeatureMatching, feature_distances, outside_share, quantiles_of

RNG = np.random.default_rng(1)
GENERATED = RNG.normal(size=(500, 2)).astype(np.float32)
RECORDED = RNG.normal(size=(300, 2)).astype(np.float32) * [3.0, 1.0] + [5.0, 0.0]
RECORDED[::7, 1] = np.nan


def test_matching_undoes_a_monotone_change():
    matching = FeatureMatching(recorded=quantiles_of(RECORDED), generated=quantiles_of(GENERATED))
    moved = matching.apply(RECORDED)
    assert abs(moved[:, 0].mean()) < 0.1
    assert abs(moved[:, 0].std() - 1) < 0.1
    assert np.array_equal(np.argsort(moved[:, 0]), np.argsort(RECORDED[:, 0]))
    assert np.array_equal(np.isnan(moved), np.isnan(RECORDED))


def test_too_few_values_are_left_alone():
    matching = FeatureMatching(recorded=quantiles_of(RECORDED[:5]), generated=quantiles_of(GENERATED))
    assert np.array_equal(matching.apply(RECORDED), RECORDED, equal_nan=True)


def test_distances_say_which_feature_lies_elsewhere():
    generated = quantiles_of(GENERATED)
    far = feature_distances(RECORDED, generated, ("moved", "same"))
    assert far["moved"] > 0.8
    assert far["same"] < 0.15
    assert outside_share(RECORDED, generated).mean() > 0.3
    assert outside_share(GENERATED, generated).mean() < 0.02


def test_a_frequent_value_is_no_distance():
    zeros = np.zeros((100, 1), np.float32)
    assert feature_distances(zeros, quantiles_of(zeros), ("none",)) == {"none": 0.0}
