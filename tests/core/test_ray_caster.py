"""The ray caster against closed forms."""

import numpy as np
import pytest

from mmweaver.core.ray_caster import RayCaster


@pytest.fixture
def wall() -> RayCaster:
    """A square of 4 x 4 m at y = 3 m, two faces."""
    vertices = np.array([[-2.0, 3, -2], [2, 3, -2], [2, 3, 2], [-2, 3, 2]])
    return RayCaster(vertices, np.array([[0, 1, 2], [0, 2, 3]]))


def test_distance_is_the_closed_form_from_both_sides(wall: RayCaster):
    generator = np.random.default_rng(0)
    start = np.stack([generator.uniform(-1, 1, 500), generator.uniform(0, 6, 500), generator.uniform(-1, 1, 500)], 1)
    target = np.stack([generator.uniform(-1.9, 1.9, 500), np.full(500, 3.0), generator.uniform(-1.9, 1.9, 500)], 1)
    length = np.linalg.norm(target - start, axis=1)
    distance = wall.distance_m(start, (target - start) / length[:, None])
    np.testing.assert_allclose(distance, length, atol=1e-9)  # Embree alone: 1e-6, at grazing incidence 1e-4
    assert distance.dtype == np.float64


def test_a_miss_is_infinite_and_has_no_face(wall: RayCaster):
    directions = np.array([[0.0, 1, 0], [0, -1, 0], [1, 0, 0], [0.6, 0.8, 0]])
    distance, face = wall.first_hit(np.array([[1.0, 0, -1]] * 4), directions)
    assert distance[0] == pytest.approx(3.0)
    assert np.isinf(distance[1:]).all()
    assert face.tolist() == [0, -1, -1, -1]


def test_first_hit_names_the_nearest_face():
    vertices = np.array([[-1.0, y, z] for y in (1, 2, 3) for z in (-1, 1)] + [[1.0, y, 0] for y in (1, 2, 3)])
    faces = np.array([[4, 5, 8], [0, 1, 6], [2, 3, 7]])
    distance, face = RayCaster(vertices, faces).first_hit(np.zeros((1, 3)), np.array([[0.0, 1, 0]]))
    assert (face[0], distance[0]) == (1, 1.0)


def test_clear_between_two_points(wall: RayCaster):
    start = np.zeros((6, 3))
    end = np.array([[0.0, 2.5, 0], [0, 3.5, 0], [0, 3.0, 0], [5, 3.5, 0], [0, -9, 0], [0, 0.01, 0]])
    assert wall.is_clear(start, end).tolist() == [True, False, True, True, True, True]


def test_faces_within_the_margin_do_not_block(wall: RayCaster):
    start, end = np.array([[0.0, 2.99, 0]]), np.array([[0.0, 4, 0]])
    assert wall.is_clear(start, end).tolist() == [True]
    assert wall.is_clear(start, end, margin_m=0.005).tolist() == [False]
