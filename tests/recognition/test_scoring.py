"""Scores of windows, long windows and recordings."""

import numpy as np

from mmweaver.recognition.scoring import Evaluation, balanced_accuracy, confusion, interval, report


def evaluation(rights: list[list[int]]) -> Evaluation:
    """Two activities; each recording a list of 1 (window recognised) and 0; recordings alternate in activity."""
    truth = np.concatenate([np.full(len(one), index % 2) for index, one in enumerate(rights)])
    right = np.concatenate([np.array(one) for one in rights])
    votes = np.eye(2)[np.where(right == 1, truth, 1 - truth)] * 0.5 + 0.25
    recording = np.repeat(np.arange(len(rights)), [len(one) for one in rights])
    return Evaluation(
        classes=("a", "b"), votes=votes, truth=truth, recording=recording, names=tuple(map(str, range(len(rights))))
    )


ONE = evaluation([[1, 1, 0, 1], [1, 0, 0, 1, 1, 1], [1, 1, 1]])


def test_classes_have_equal_weight():
    truth = np.array([0] * 9 + [1])
    assert balanced_accuracy(truth, np.zeros(10, int)) == 0.5


def test_confusion_has_the_truth_in_rows():
    assert confusion(ONE.truth, ONE.guess, 2).tolist() == [[6, 1], [2, 4]]


def test_windows_of_a_recording_are_averaged():
    found = report(ONE)
    assert found["window"]["balanced_accuracy"] == round((6 / 7 + 4 / 6) / 2, 4)
    assert found["recording"]["balanced_accuracy"] == 1.0
    assert found["recording"]["n"] == 3
    assert found["three_windows"]["n"] == 5  # 2 + 2 + 1
    assert found["three_windows"]["confusion"] == [[3, 0], [1, 1]]


def test_the_interval_holds_the_score_and_narrows_with_recordings():
    few, many = evaluation([[1, 0], [1, 1]] * 3), evaluation([[1, 0], [1, 1]] * 40)
    for one in (few, many):
        low, high = interval(one)
        assert low <= balanced_accuracy(one.truth, one.guess) <= high
    mixed = [evaluation([[1, 1], [1, 1], [0, 0], [0, 1]] * times) for times in (2, 30)]
    widths = [high - low for low, high in map(interval, mixed)]
    assert widths[1] < 0.5 * widths[0]
