"""Labelled recordings: how many of the trees are theirs alone; unlabelled ones: what their confident labels teach."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.train_recogniser import (
    fewest_recordings,
    following,
    own_trees,
)
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows
from mmweaver.recognition.tree_ensemble import joined_trees, read_trees, write_trees
from tests.recognition.clouds import recording_of

OPTIONS = TrainingOptions(trees=30)


@pytest.fixture
def made() -> TrainingWindows:
    """Two labels by one feature; what is recorded has it the other way round."""
    label = np.tile([0, 1], 20)
    return TrainingWindows(
        features=label[:, None] + np.linspace(0, 0.1, 40)[:, None], label=label, person=np.arange(40),
        is_copy=np.zeros(40, bool), names=("one",),
    )  # fmt: skip


@pytest.mark.parametrize(("known", "sizes"), [(1.0, [8, 17, 28]), (0.0, [23, 28, 29])])
def test_more_recordings_grow_more_trees_alone_and_more_where_what_was_generated_fails(
    made: TrainingWindows, known: float, sizes: list[int]
):
    labels = np.tile([0, 1], 10)
    features = np.abs(labels - (1.0 - known))[:, None]
    found = []
    for fewest in (1, 4, 36):
        own, others = own_trees(made, features, labels, fewest, OPTIONS)
        assert own is not None
        assert len(own.root) + others.trees == OPTIONS.trees
        found.append(len(own.root))
        assert own.probabilities(np.array([[1.0]])).argmax() == known
    assert found == sizes
    assert own_trees(made, features, labels, 0, OPTIONS) == (None, OPTIONS)


def test_joined_trees_vote_as_both_do_and_are_read_back(made: TrainingWindows, tmp_path):
    features, labels = np.tile([[0.0], [1.0]], (10, 1)), np.tile([0, 1], 10)
    own, others = own_trees(made, features, labels, 3, OPTIONS)
    assert own is not None
    mixed = made.joined(features, labels, 0.1).trees(others)
    both = joined_trees(mixed, own)
    asked = np.array([[0.0], [0.5], [1.05], [np.nan]])
    mean = (mixed.probabilities(asked) + own.probabilities(asked)) / 2
    assert np.allclose(both.probabilities(asked), mean)
    write_trees(tmp_path / "trees.npz", both)
    assert np.allclose(read_trees(tmp_path / "trees.npz", 1, 2).probabilities(asked), mean)


def test_the_activity_with_fewest_recordings_counts():
    def window(label: str, name: str) -> PointRecording:
        return recording_of([], num_frames=20, label=label, name=name)

    windows = [window("a", "1"), window("a", "1"), window("a", "2"), window("b", "1"), window("b", "1")]
    assert fewest_recordings(windows, ("a", "b")) == 1
    assert fewest_recordings(windows, ("a", "b", "c")) == 0


def test_windows_follow_each_other_within_a_recording():
    one, other = (
        recording_of([], num_frames=65),
        recording_of([], num_frames=40),
    )  # two files of the same name in two folders
    windows = [*one.windows(2.0), *other.windows(2.0), other.part(20, 20), other.part(21, 19)]
    assert following(windows).tolist() == [False, True, True, False, True, False, False]
