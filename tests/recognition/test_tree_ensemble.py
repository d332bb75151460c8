"""Trees as arrays vote as scikit-learn does; damaged files are refused."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sklearn")
from sklearn.ensemble import ExtraTreesClassifier

from mmweaver.core.errors import InputError
from mmweaver.recognition.tree_ensemble import TreeEnsemble, grow_trees, read_trees, write_trees

RNG = np.random.default_rng(0)
FEATURES = RNG.normal(size=(200, 5)).astype(np.float32)
FEATURES[RNG.random(FEATURES.shape) < 0.1] = np.nan
LABELS = (np.nan_to_num(FEATURES[:, 1]) > 0).astype(int) + 2 * (np.nan_to_num(FEATURES[:, 2]) > 1)
HOW = {"leaf_size": 2, "feature_share": 0.5, "seed": 3}


def ensemble() -> TreeEnsemble:
    return grow_trees(FEATURES, LABELS, np.ones(200), 5, trees=7, **HOW)[0]


def test_votes_are_those_of_scikit_learn():
    theirs = ExtraTreesClassifier(7, min_samples_leaf=2, max_features=0.5, random_state=3).fit(FEATURES, LABELS)
    unseen = RNG.normal(size=(100, 5)).astype(np.float32)
    unseen[::3, 0] = np.nan
    votes = ensemble().probabilities(unseen)
    assert votes.shape == (100, 5)
    assert np.allclose(votes[:, :4], theirs.predict_proba(unseen), atol=2e-3)  # stored in half precision
    assert not votes[:, 4].any()  # a label without windows


def test_a_file_holds_the_same_trees(tmp_path: Path):
    write_trees(tmp_path / "trees.npz", ensemble())
    again = read_trees(tmp_path / "trees.npz", 5, 5)
    assert np.array_equal(again.probabilities(FEATURES), ensemble().probabilities(FEATURES))


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("left", lambda values: np.zeros_like(values)),  # back to the first node, for ever
        ("feature", lambda values: values + 5),
        ("right", lambda values: values + 10_000),
        ("votes", lambda values: values[:, :3]),
        ("threshold", lambda values: values * np.nan),
    ],
)
def test_damage_is_refused(name: str, change, tmp_path: Path):
    arrays = dict(vars(ensemble()))
    arrays[name] = change(arrays[name])
    np.savez(tmp_path / "trees.npz", **arrays)
    with pytest.raises(InputError):
        read_trees(tmp_path / "trees.npz", 5, 5)
