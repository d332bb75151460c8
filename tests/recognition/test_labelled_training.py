"""Labelled recordings: how many of the trees are theirs alone."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.records import PointCloud
from mmweaver.recognition.labelled_training import fewest_recordings, own_trees
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


def test_more_recordings_grow_more_trees_alone(made: TrainingWindows):
    features, labels = np.tile([[1.0], [0.0]], (10, 1)), np.tile([0, 1], 10)
    sizes = []
    for fewest in (1, 4, 36):
        own, others = own_trees(made, features, labels, fewest, OPTIONS)
        assert own is not None
        assert len(own.root) + others.trees == OPTIONS.trees
        sizes.append(len(own.root))
        assert own.probabilities(np.array([[1.0]])).argmax() == 0
    assert sizes == [6, 15, 27]
    assert own_trees(made, features, labels, 0, OPTIONS) == (None, OPTIONS)


def test_joined_trees_vote_as_both_do_and_are_read_back(made: TrainingWindows, tmp_path):
    features, labels = np.tile([[1.0], [0.0]], (10, 1)), np.tile([0, 1], 10)
    own, others = own_trees(made, features, labels, 4, OPTIONS)
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
