"""Confusion matrix as a picture."""

import numpy as np

from mmweaver.training.validation_sheet import confusion, draw_confusion


def test_each_row_is_normalised_by_its_class():
    true, answers = np.array([0, 0, 0, 2]), np.array([0, 0, 1, 2])
    share = confusion(true, answers, 3)
    assert np.allclose(share, [[2 / 3, 1 / 3, 0], [0, 0, 0], [0, 0, 1]])


def test_the_picture_is_darker_on_the_diagonal():
    names = ("walking", "waving")
    right = draw_confusion(np.array([0, 1]), np.array([0, 1]), names)
    wrong = draw_confusion(np.array([0, 1]), np.array([1, 0]), names)
    assert right.dtype == np.uint8
    assert right.shape == wrong.shape
    assert right.shape[2] == 3
    assert not np.array_equal(right, wrong)
