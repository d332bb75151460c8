"""Motions with sentences: every activity, the same for the same seed, phrases that are kept back."""

import numpy as np

from studies.motion.motiongpt_data import ACTIVITIES, FRAMES, SENTENCES, library_examples, sentence_of


def test_every_activity_once_a_seed():
    examples = list(library_examples(range(2)))
    assert [example.activity for example in examples] == list(ACTIVITIES) * 2
    for example, same in zip(examples, library_examples(range(2)), strict=True):
        assert example.features.shape == (FRAMES, 263)
        np.testing.assert_array_equal(example.features, same.features)


def test_phrases_that_are_kept_back_are_never_trained_on():
    for activity, phrases in SENTENCES.items():
        trained = {sentence_of(activity, seed, held_out=False) for seed in range(60)}
        assert not any(sentence.endswith(f" {phrases[-1]}") for sentence in trained)
        assert sentence_of(activity, 3, held_out=True).endswith(phrases[-1])
        assert len(trained) > 6


def test_a_walk_gets_somewhere_and_a_wave_does_not():
    by_activity = {example.activity: example.features for example in library_examples(range(1))}
    gone = {name: np.linalg.norm(features[:, 1:3].sum(axis=0)) for name, features in by_activity.items()}
    assert gone["walking"] > 1.5
    assert gone["waving"] < 0.2
