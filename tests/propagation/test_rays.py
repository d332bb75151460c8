"""Rays of propagation paths: their corners give the paths' own lengths, by geometry alone."""

import numpy as np
import pytest

from mmweaver.core.records import Plane
from mmweaver.propagation.paths import Interaction
from mmweaver.propagation.rays import moving_vertices

BODY_M = np.array([0.4, 2.0, 0.1])
WALL_X_M = 1.5


@pytest.fixture
def wall() -> Plane:
    """To the right, its free side to the left."""
    x, y, z = -np.eye(3)[0], np.eye(3)[1], np.eye(3)[2]
    return Plane(
        kind="wall",
        centre_m=np.array([WALL_X_M, 2.0, 0.0]),
        normal=x,
        axis_u=y,
        axis_v=-z,
        half_size_m=(3.0, 2.0),
        material="plasterboard",
    )


def _length_m(corners_m: np.ndarray) -> float:
    corners_m = corners_m[np.isfinite(corners_m[:, 0])]
    return float(np.linalg.norm(np.diff(corners_m, axis=0), axis=1).sum())


@pytest.mark.parametrize("is_departure", [True, False])
def test_a_path_over_a_wall_turns_on_it(wall: Plane, is_departure: bool):
    image_m = BODY_M * [-1, 1, 1] + [2 * WALL_X_M, 0, 0]
    ends = (BODY_M, image_m) if is_departure else (image_m, BODY_M)
    corners_m = moving_vertices(*(end[None] for end in ends), np.array([Interaction.BODY_WALL]), BODY_M[None], [wall])[
        0
    ]
    assert corners_m[2, 0] == pytest.approx(WALL_X_M)
    assert _length_m(corners_m) == pytest.approx(np.linalg.norm(BODY_M) + np.linalg.norm(image_m))
    towards, away = corners_m[1] - corners_m[2], corners_m[3] - corners_m[2]
    assert towards[0] / np.linalg.norm(towards) == pytest.approx(away[0] / np.linalg.norm(away))  # angle of reflection


def test_a_path_over_a_surface_turns_there(wall: Plane):
    patch_m = np.array([-0.8, 3.1, -0.4])
    length_m = np.linalg.norm(patch_m) + np.linalg.norm(patch_m - BODY_M)
    arrival_m = patch_m / np.linalg.norm(patch_m) * length_m
    kind = np.array([Interaction.BODY_ROOM])
    corners_m = moving_vertices(BODY_M[None], arrival_m[None], kind, BODY_M[None], [wall])[0]
    np.testing.assert_allclose(corners_m, [np.zeros(3), BODY_M, patch_m, np.zeros(3)], atol=1e-9)


def test_a_wall_before_and_after_the_body_is_found_among_faces(wall: Plane):
    image_m = BODY_M * [-1, 1, 1] + [2 * WALL_X_M, 0, 0]
    floor = Plane(
        kind="floor",
        centre_m=np.array([0.0, 2.0, -1.2]),
        normal=np.eye(3)[2],
        axis_u=np.eye(3)[0],
        axis_v=np.eye(3)[1],
        half_size_m=(3.0, 3.0),
        material="concrete",
    )
    kind = np.array([Interaction.WALL_BODY_WALL])
    corners_m = moving_vertices(image_m[None], image_m[None], kind, BODY_M[None], [floor, wall])[0]
    assert corners_m[1, 0] == pytest.approx(WALL_X_M)
    np.testing.assert_allclose(corners_m[2], BODY_M)
    assert 2 * _length_m(corners_m) == pytest.approx(2 * np.linalg.norm(image_m))
