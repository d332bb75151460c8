"""Reflections over two walls at 70 degrees, against the shortest way over both, which is searched for (Fermat)."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from mmweaver.core.boards import AWR1843
from mmweaver.core.records import Plane
from mmweaver.propagation.image_method import specular_paths, specular_reflectors
from mmweaver.propagation.paths import Interaction, StaticPaths
from mmweaver.propagation.static_paths import Propagation, RayTracedRoom
from tests.rooms import plane, scene_of

EDGE_M = np.array([0.3, 3.0, 0.0])  # the walls meet here, upright
# far apart, so that the order of the walls shows in centimetres
APART = replace(
    AWR1843, tx_position_m=((-0.3, 0.0, 0.0), (0.2, 0.1, 0.1), (0.0, 0.0, 0.0)),
    rx_position_m=((0.4, 0.0, -0.2), (0.0, 0.0, 0.0), (0.1, -0.1, 0.0), (-0.2, 0.0, 0.1)),
)  # fmt: skip


def _wall(azimuth_deg: float, inwards: float) -> Plane:
    along = np.array([np.sin(np.radians(azimuth_deg)), -np.cos(np.radians(azimuth_deg)), 0.0])
    normal = inwards * np.array([along[1], -along[0], 0.0])
    return plane("wall", tuple(EDGE_M + 3 * along), tuple(normal), tuple(along), (3.0, 3.0), "metal")


LEFT, RIGHT = _wall(-40.0, -1.0), _wall(30.0, 1.0)


def _shortest(start_m: np.ndarray, first: Plane, second: Plane, end_m: np.ndarray) -> tuple[float, np.ndarray]:
    """Length of the shortest way over a point of one wall and one of the other, and these points (2, 3)."""

    def points(where: np.ndarray) -> np.ndarray:
        return np.array(
            [
                wall.centre_m + u * wall.axis_u + v * wall.axis_v
                for wall, (u, v) in zip((first, second), where.reshape(2, 2), strict=True)
            ]
        )

    def length(where: np.ndarray) -> float:
        return float(np.linalg.norm(np.diff([start_m, *points(where), end_m], axis=0), axis=1).sum())

    found = minimize(
        length, np.zeros(4), method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-12, "maxiter": 4000}
    )
    return float(found.fun), points(found.x)


def _is_on(wall: Plane, point_m: np.ndarray) -> bool:
    return abs(float((point_m - wall.centre_m) @ wall.normal)) < 1e-6


@pytest.mark.parametrize("walls", [(LEFT, RIGHT), (RIGHT, LEFT)], ids=["left first", "right first"])
def test_both_orders_of_two_walls_are_as_long_as_the_shortest_way(walls: tuple[Plane, Plane]):
    assert np.degrees(np.arccos(LEFT.normal @ -RIGHT.normal)) == pytest.approx(70.0)
    faces = specular_reflectors((LEFT, RIGHT))
    paths = specular_paths(faces, APART.wavelength_m, APART.centre_frequency_hz)
    twice = [path for path in paths if len(path.corners_m) == 2 and _is_on(walls[0], path.corners_m[0])]
    (path,) = twice
    home = _shortest(np.zeros(3), *walls, np.zeros(3))
    assert path.length_m == pytest.approx(home[0], abs=1e-6)
    np.testing.assert_allclose(path.corners_m, home[1], atol=1e-3)
    for sender in map(np.array, APART.tx_position_m):
        for receiver in map(np.array, APART.rx_position_m):
            got = np.linalg.norm(path.rotation @ sender + path.shift_m - receiver)
            assert got == pytest.approx(_shortest(sender, *walls, receiver)[0], abs=1e-6)


def test_the_paths_of_the_room_have_these_lengths():
    found = RayTracedRoom(scene_of((LEFT, RIGHT)), APART, 0, Propagation(bounces=1, fine_roughness=False)).paths
    mirrored: StaticPaths = found.select(Interaction.SPECULAR)
    for walls in ((LEFT, RIGHT), (RIGHT, LEFT)):
        wanted = [
            [_shortest(np.array(sender), *walls, np.array(receiver))[0] for receiver in APART.rx_position_m]
            for sender in APART.tx_position_m
        ]  # fmt: skip
        assert np.abs(mirrored.length_m.numpy() - np.array(wanted)).max(axis=(1, 2)).min() < 1e-5
