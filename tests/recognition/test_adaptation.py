"""Labelled recordings: how many of the trees are theirs alone; unlabelled ones: what their confident labels teach."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.train_recogniser import (
    fewest_recordings,
    following,
    generated_worth,
    own_trees,
    self_trained,
    smoothed_votes,
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


def test_generated_people_are_worth_what_they_recognise():
    labels = np.array([0, 0, 1, 1])
    votes = np.array([[0.9, 0.1], [0.6, 0.4], [0.7, 0.3], [0.2, 0.8]])
    assert generated_worth(votes, labels) == pytest.approx(1.5)
    assert generated_worth(votes[:, ::-1], labels) == pytest.approx(0.3)
    assert generated_worth(np.eye(2)[labels], labels) == pytest.approx(3.0)


def test_with_five_recordings_half_of_their_trees_look_at_what_tells_generated_people_apart():
    """Two features tell the labelled windows apart, of which one is noise for generated people."""
    rng, label = np.random.default_rng(0), np.tile([0, 1], 50)
    made = TrainingWindows(
        features=np.stack([rng.normal(0, 1, 100), label + rng.normal(0, 0.1, 100)], axis=1), label=label,
        person=np.arange(100), is_copy=np.zeros(100, bool), names=("noise", "known"),
    )  # fmt: skip
    own, _ = own_trees(made, np.array([[0.0, 0.0], [1.0, 1.0]] * 4), np.tile([0, 1], 4), 5, OPTIONS)
    assert own is not None
    first = own.feature[own.root]
    assert len(first) == 19
    assert (first[:10] == 1).mean() > 0.8
    assert 0 < (first[10:] == 1).mean() < 1


def test_every_few_trees_look_at_features_drawn_anew():
    """Forty features that tell as much: one draw with replacement leaves out a third of them, many leave out few."""
    rng, label = np.random.default_rng(0), np.tile([0, 1], 50)
    made = TrainingWindows(
        features=label[:, None] + rng.normal(0, 0.1, (100, 40)), label=label, person=np.arange(100),
        is_copy=np.zeros(100, bool), names=tuple(f"f{at}" for at in range(40)),
    )  # fmt: skip
    labelled = np.tile([0, 1], 4)[:, None] + rng.normal(0, 0.1, (8, 40))
    own, _ = own_trees(made, labelled, np.tile([0, 1], 4), 5, TrainingOptions(trees=300))
    assert own is not None
    assert len(set(own.feature[own.root][:90].tolist())) > 31


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


def test_neighbours_vote_along():
    votes = np.array([[0.9, 0.1], [0.4, 0.6], [0.8, 0.2], [0.1, 0.9]])
    mean = smoothed_votes(votes, np.array([False, True, True, False]))
    assert np.allclose(mean[:, 0], [0.65, 0.7, 0.6, 0.1])
    assert np.allclose(mean.sum(axis=1), 1)


def test_what_people_go_on_with_is_learned_from_their_other_windows():
    """Windows of an activity that nobody was generated doing are recognised by those before and after them."""
    rng = np.random.default_rng(0)
    label = np.repeat([0, 1], 100)
    features = np.stack([label + rng.normal(0, 0.1, 200), rng.normal(0, 0.1, 200)], axis=1)
    made = TrainingWindows(
        features=features, label=label, person=np.arange(200), is_copy=np.zeros(200, bool), names=("known", "other")
    )
    # of either activity every third window looks like the first activity in what was generated
    truth = np.repeat([0, 1], 60)
    strange = np.arange(120) % 3 == 1
    seen = np.stack([np.where(strange, 0.2, truth), 3.0 * strange * truth], axis=1) + rng.normal(0, 0.05, (120, 2))
    follows = np.ones(120, bool)
    follows[[0, 60]] = False
    options = TrainingOptions(trees=40)
    plain = made.trees(options)
    alone, _ = self_trained(made, seen, plain, options)
    pooled, note = self_trained(made, seen, plain, options, follows)
    assert note["used"]
    before, after = (np.mean(one.probabilities(seen).argmax(axis=1) == truth) for one in (alone, pooled))
    assert before < 0.9
    assert after > 0.95
