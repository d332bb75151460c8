"""The largest confusions, by the share of a label's windows."""

import numpy as np

from mmweaver.recognition.confusion_picture import largest_confusions


def test_confusions_are_shares_of_the_true_label():
    truth = np.array([0] * 10 + [1] * 4 + [2] * 5)
    guess = np.array([0] * 7 + [1] * 3 + [1, 1, 2, 2] + [2] * 5)
    assert largest_confusions(truth, guess, 5) == [(1, 2), (0, 1)]
    assert largest_confusions(truth, guess, 1) == [(1, 2)]
    assert largest_confusions(truth, truth, 5) == []
