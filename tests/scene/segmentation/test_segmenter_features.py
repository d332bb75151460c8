"""Features of the built-in segmenter."""

import numpy as np
import pytest

from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.segmentation.builtin_segmenter import (
    CHANNELS,
    HEIGHT,
    HEIGHT_UNIT_M,
    MEASURED,
    SLOPE,
    STRIDE,
    grid_features,
)


@pytest.fixture(scope="module")
def photo():
    return sample_photo()[0]


def test_features_encode_height_slope_and_measured_cells(photo):
    grid = make_grid(photo)
    features = grid_features(grid)
    assert features.shape == (CHANNELS, *grid.depth_m[::STRIDE, ::STRIDE].shape)
    assert np.isfinite(features).all()
    assert np.array_equal(features[MEASURED] > 0, np.isfinite(grid.depth_m[::STRIDE, ::STRIDE]))
    bottom = features[:, -5:, 30:50]
    assert np.median(HEIGHT_UNIT_M * bottom[HEIGHT]) == pytest.approx(0.0, abs=0.03)
    assert np.median(bottom[SLOPE]) > 0.95
    assert features[7].max() == 1.0  # somewhere a wall
    on_wall = features[8] > 0
    assert features[7][on_wall].mean() > 0.9
    assert ((features[12] >= 0) & (features[12] <= 1)).all()
