"""Labelled recordings: how many of the trees are theirs alone."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.records import PointCloud
from mmweaver.recognition.labelled_training import fewest_recordings, generated_worth, own_trees
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of, with_recorded
from mmweaver.recognition.tree_ensemble import joined_trees, read_trees, write_trees

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
    mixed = trees_of(with_recorded(made, features, labels, 0.1), others)
    both = joined_trees(mixed, own)
    asked = np.array([[0.0], [0.5], [1.05], [np.nan]])
    mean = (mixed.probabilities(asked) + own.probabilities(asked)) / 2
    assert np.allclose(both.probabilities(asked), mean)
    write_trees(tmp_path / "trees.npz", both)
    assert np.allclose(read_trees(tmp_path / "trees.npz", 1, 2).probabilities(asked), mean)


def test_the_activity_with_fewest_recordings_counts():
    def window(label: str, name: str) -> PointRecording:
        nothing = np.zeros(0)
        cloud = PointCloud(
            frame=np.zeros(0, int), x_m=nothing, y_m=nothing, z_m=nothing, radial_velocity_mps=nothing, snr_db=nothing
        )
        return PointRecording(name=name, cloud=cloud, num_frames=20, frame_rate_hz=10.0, label=label)

    windows = [window("a", "1"), window("a", "1"), window("a", "2"), window("b", "1"), window("b", "1")]
    assert fewest_recordings(windows, ("a", "b")) == 1
    assert fewest_recordings(windows, ("a", "b", "c")) == 0
