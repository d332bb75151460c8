"""Confident labels of unlabelled windows: which windows vote for one another, and what comes of it."""

import numpy as np
import pytest

pytest.importorskip("sklearn")

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording
from mmweaver.recognition.self_training import following, self_trained, with_neighbours
from mmweaver.recognition.training_windows import TrainingOptions, TrainingWindows, trees_of

NOTHING = np.zeros(0)


def recording(name: str, frames: int) -> PointRecording:
    cloud = PointCloud(
        frame=np.zeros(0, int), x_m=NOTHING, y_m=NOTHING, z_m=NOTHING, radial_velocity_mps=NOTHING, snr_db=NOTHING
    )
    return PointRecording(name=name, cloud=cloud, num_frames=frames, frame_rate_hz=10.0)


def test_windows_follow_each_other_within_a_recording():
    one, other = recording("one", 65), recording("one", 40)  # two files of the same name in two folders
    windows = [*one.windows(2.0), *other.windows(2.0), other.part(20, 20), other.part(21, 19)]
    assert following(windows).tolist() == [False, True, True, False, True, False, False]


def test_neighbours_vote_along():
    votes = np.array([[0.9, 0.1], [0.4, 0.6], [0.8, 0.2], [0.1, 0.9]])
    mean = with_neighbours(votes, np.array([False, True, True, False]))
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
    plain = trees_of(made, options)
    alone, _ = self_trained(made, seen, plain, options)
    pooled, note = self_trained(made, seen, plain, options, follows)
    assert note["used"]
    before, after = (np.mean(one.probabilities(seen).argmax(axis=1) == truth) for one in (alone, pooled))
    assert before < 0.9
    assert after > 0.95
