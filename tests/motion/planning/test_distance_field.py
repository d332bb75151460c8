"""Distances on a grid against those to the points themselves."""

import numpy as np
from scipy.spatial import KDTree

from mmweaver.motion.planning.collision import CELL_M, FARTHEST_M, distance_field, interior, thinned

LOW_M, HIGH_M = np.zeros(3), np.array([1.5, 1.0, 1.0])


def _sheet() -> np.ndarray:
    """A slanted surface, sampled every centimetre."""
    x, y = np.meshgrid(np.arange(0.3, 1.2, 0.01), np.arange(0.2, 0.8, 0.01))
    return np.stack([x, y, 0.4 + 0.2 * x], axis=-1).reshape(-1, 3)


def test_distances_are_true_to_a_few_millimetres_and_at_edges_to_half_a_cell():
    sheet = _sheet()
    field = distance_field(sheet, LOW_M, HIGH_M)
    asked = np.random.default_rng(0).uniform(LOW_M + 0.1, HIGH_M - 0.1, (500, 3))
    true_m = np.minimum(KDTree(sheet).query(asked)[0], FARTHEST_M)
    away = true_m > CELL_M  # nearer, both say that the body is in it
    error_m = np.abs(field.at(asked) - true_m)[away]
    assert np.median(error_m) < 0.005
    assert error_m.max() < 0.6 * CELL_M
    assert field.at(asked)[~away].max() < 1.5 * CELL_M


def test_nothing_is_near_outside_the_grid_or_where_there_are_no_points():
    assert np.allclose(distance_field(_sheet(), LOW_M, HIGH_M).at(np.array([[0.5, -5.0, 0.5]])), FARTHEST_M)
    empty = distance_field(np.zeros((0, 3)), LOW_M, HIGH_M)
    assert np.allclose(empty.at(np.array([[0.5, 0.5, 0.5]])), FARTHEST_M)


def test_a_block_has_an_inside_and_a_post_has_none():
    axis = np.arange(0.01, 0.5, 0.02)
    block = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    post = np.column_stack([np.full(25, 1.2), np.full(25, 0.5), axis])
    field = distance_field(np.concatenate([block, post]), LOW_M, HIGH_M)
    inside = interior(field)
    assert inside[5, 5, 5]
    assert not inside[int(1.2 / CELL_M)].any()


def test_one_point_is_left_of_each_cell():
    points = np.array([[0.01, 0.01, 0.01], [0.03, 0.03, 0.03], [0.51, 0.01, 0.01]])
    assert sorted(map(tuple, thinned(points).round(3).tolist())) == [(0.02, 0.02, 0.02), (0.51, 0.01, 0.01)]
