"""Binning without bridging edges, and normals."""

from collections.abc import Callable

import numpy as np

from mmweaver.scene.photo.depth_grid import make_grid, remove_outliers


def test_edges_are_not_bridged(box_room: Callable):
    """Nothing lies between a box at 1.5 m and a wall at 3.8 m, so no cell may have such a depth."""
    room = box_room(boxes=[((-0.3, 0.3), (1.5, 1.7), (0.0, 2.0))], pitch_deg=0.0)
    depth = make_grid(room.photo(width=640, height=480)).depth_m
    middle = depth[40:80]
    assert not ((middle > 1.8) & (middle < 2.0)).any()
    assert np.isfinite(middle).all()


def test_normals_face_the_camera(box_room: Callable):
    room = box_room(pitch_deg=20.0)
    grid = make_grid(room.photo(noise=0.002))
    level = grid.normals @ room.radar_from_camera.T
    height = grid.points_m @ room.radar_from_camera[2]
    on_floor = np.abs(height + 1.4) < 0.02
    assert np.nanmedian(level[on_floor][:, 2]) > 0.99
    assert (np.einsum("rcx,rcx->rc", grid.normals, grid.points_m)[np.isfinite(level[..., 0])] < 0).all()


def test_flying_pixels_and_speckle_are_dropped():
    depth = np.full((20, 20), 2.0)
    depth[:, 10:] = 3.0
    depth[:, 10] = 2.5  # halfway between two surfaces
    depth[5, 4] = 0.3
    cleaned = remove_outliers(depth)
    assert np.isnan(cleaned[5, 4])
    assert cleaned[8, 5] == 2.0
    assert cleaned[8, 15] == 3.0
