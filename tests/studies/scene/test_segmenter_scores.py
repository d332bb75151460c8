"""Scores of segmenters."""

import numpy as np
import pytest

from mmweaver.scene.segmentation.builtin_segmenter import GROUP_NAMES
from studies.scene.segmenter_data import SegmenterExample, make_example
from studies.scene.segmenter_scores import by_geometry, confusion, scores


@pytest.fixture(scope="module")
def example() -> SegmenterExample:
    return make_example("office", 1000)


def test_scores_of_perfect_and_of_constant_guesses(example: SegmenterExample):
    perfect = scores(confusion([example], lambda features: example.groups))
    assert (perfect["miou"], perfect["right"]) == (1.0, 1.0)
    wall = GROUP_NAMES.index("wall-other")
    constant = scores(confusion([example], lambda features: np.full(example.groups.shape, wall)))
    share = float((example.groups == wall).mean())
    assert constant["iou"]["wall-other"] == pytest.approx(share, abs=1e-3)
    assert constant["right"] == pytest.approx(share, abs=1e-3)


def test_geometry_alone_finds_the_floor(example: SegmenterExample):
    found = scores(confusion([example], by_geometry))
    assert found["iou"]["floor-other"] > 0.6
