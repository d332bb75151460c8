"""Depth pictures of scattered measurements."""

import numpy as np

from mmweaver.scene.photo.depth_grid import fill_scattered_holes


def test_a_dense_picture_is_left_alone():
    depth_m = np.full((60, 80), 2.0)
    depth_m[:20] = np.nan
    filled, sentences = fill_scattered_holes(depth_m)
    assert filled is depth_m
    assert sentences == ()


def test_scattered_holes_are_filled_and_large_holes_stay():
    rng = np.random.default_rng(0)
    depth_m = np.where(rng.random((240, 320)) < 0.1, np.where(np.arange(320) < 160, 2.0, 4.0), np.nan)
    depth_m[:, 220:280] = np.nan
    filled, sentences = fill_scattered_holes(depth_m)
    assert set(np.unique(filled[np.isfinite(filled)])) == {2.0, 4.0}
    assert np.isfinite(filled[:, :200]).mean() > 0.9
    assert np.isnan(filled[:, 230:270]).all()
    assert "% of the pixels" in sentences[0]
