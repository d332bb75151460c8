"""The judge tells library motions apart that it has not seen, and is at a loss where there is nothing to tell."""

import numpy as np
import pytest

from studies.motion.motion_classifier import train_classifier
from studies.motion.motiongpt_data import ACTIVITIES, library_examples


@pytest.mark.slow  # a training
def test_it_knows_motions_of_other_seeds():
    judge = train_classifier(list(library_examples(range(20, 25))))
    unseen = list(library_examples(range(2)))
    ranks = judge.ranks([example.features for example in unseen])
    assert sorted(ranks[0]) == list(range(len(ACTIVITIES)))
    right = ranks[:, 0] == [ACTIVITIES.index(example.activity) for example in unseen]
    assert right.mean() > 0.9
    still = judge.ranks([np.repeat(example.features[:1], 80, axis=0) for example in unseen])
    assert (still[:, 0] == [ACTIVITIES.index(example.activity) for example in unseen]).mean() < 0.6
