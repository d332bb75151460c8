"""Training data of the segmenter."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.seeding import stream
from mmweaver.scene.segmentation.builtin_segmenter import CHANNELS, COLOURS, HEIGHT, MEASURED
from studies.scene.segmenter_data import SegmenterExample, augmented, make_example, make_examples


@pytest.fixture(scope="module")
def example() -> SegmenterExample:
    return make_example("office", 1000)


def test_cached_rooms_are_read_back(example: SegmenterExample, tmp_path: Path):
    first = make_examples(("office",), 1, 1000, tmp_path)
    (cached,) = tmp_path.iterdir()
    stamp = cached.stat().st_mtime_ns
    again = make_examples(("office",), 1, 1000, tmp_path)
    assert cached.stat().st_mtime_ns == stamp
    assert np.array_equal(first[0].features, again[0].features)
    assert np.allclose(example.features, again[0].features, atol=3e-3)
    assert np.array_equal(example.groups, again[0].groups)


def test_augmentation_keeps_shapes_and_changes_colours(example: SegmenterExample):
    changed, holes = [], []
    for draw in range(12):
        features, groups = augmented(example, stream(draw, "test"))
        assert features.shape == (CHANNELS, *groups.shape)
        assert features.dtype == np.float32
        assert np.isfinite(features).all()
        changed.append(features[COLOURS].std())
        holes.append(float((features[MEASURED] == 0).mean()))
        assert set(np.unique(groups)) <= set(np.unique(example.groups))
        measured = features[MEASURED] > 0
        assert np.abs(features[HEIGHT][measured]).max() < 1.5
    assert np.std(changed) > 0.05
    assert max(holes) > min(holes) + 0.02
