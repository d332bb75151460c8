"""Depth pictures of scattered measurements."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.scene.photo.sparse_depth import fill_scattered_holes
from mmweaver.scene.reconstruction import reconstruct


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


def test_a_room_from_one_pixel_in_ten(box_room: Callable):
    """90 % scattered holes: floor, back wall and free floor are found as in the whole picture."""
    whole = box_room().photo(width=640, height=480)
    sparse = box_room().photo(holes=0.9, width=640, height=480)
    scene, full = reconstruct(replace(sparse, depth_m=fill_scattered_holes(sparse.depth_m)[0])), reconstruct(whole)
    assert scene.floor_z_m == pytest.approx(-1.4, abs=0.03)
    walls = [plane for plane in scene.planes if plane.kind == "wall"]
    assert any(abs(abs(float(plane.normal @ plane.centre_m)) - 3.8) < 0.05 for plane in walls)
    free = (scene.free_space.is_free & scene.free_space.is_seen).sum()
    assert free == pytest.approx((full.free_space.is_free & full.free_space.is_seen).sum(), rel=0.15)
