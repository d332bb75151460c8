"""Features of the built-in segmenter."""

import dataclasses

import numpy as np
import pytest

from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.sample_photo import sample_photo
from mmweaver.scene.segmentation.segmenter_features import (
    CHANNELS,
    COLOURS,
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


def test_exposure_and_white_balance_change_little(photo):
    tinted = dataclasses.replace(photo, rgb=(0.6 * photo.rgb * np.array([1.0, 0.9, 0.95])).astype(np.uint8))
    one, other = (grid_features(make_grid(one))[COLOURS] for one in (photo, tinted))
    assert np.abs(one - other).mean() < 0.15 * np.abs(one).mean() + 0.02
