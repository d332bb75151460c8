"""Pictures of a training: ground truth and network side by side, and confusion matrices."""

import numpy as np
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.mean_power import PowerMaps
from mmweaver.training.validation_sheet import draw_confusion, draw_sheet


def maps(sequences: int, seed: int = 0) -> PowerMaps:
    rng = np.random.default_rng(seed)
    shapes = {"range_doppler": 32, "range_azimuth": 91, "range_elevation": 61}
    return PowerMaps(
        **{n: torch.tensor(rng.exponential(1.0, (sequences, 3, 64, w)), dtype=torch.float32) for n, w in shapes.items()}
    )


def test_one_row_per_sequence_and_at_most_three():
    heights = [draw_sheet(maps(count), maps(count), AWR1843).shape[0] for count in (1, 3, 5)]
    assert heights[0] < heights[1] == heights[2]


def test_the_same_maps_look_the_same_and_others_do_not():
    same, other = draw_sheet(maps(1), maps(1), AWR1843), draw_sheet(maps(1), maps(1, seed=1), AWR1843)
    assert same.dtype == np.uint8
    assert np.abs(same.astype(int) - other).mean() > 2


def test_the_picture_is_darker_on_the_diagonal():
    names = ("walking", "waving")
    right = draw_confusion(np.array([0, 1]), np.array([0, 1]), names)
    wrong = draw_confusion(np.array([0, 1]), np.array([1, 0]), names)
    assert right.dtype == np.uint8
    assert right.shape == wrong.shape
    assert right.shape[2] == 3
    assert not np.array_equal(right, wrong)
