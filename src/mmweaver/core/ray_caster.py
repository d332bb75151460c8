"""Ray casting on a triangle mesh by direct calls to Embree; wrapper libraries are 2 to 8 times slower."""

import os
from functools import lru_cache
from typing import Any

import numpy as np
from jaxtyping import Bool, Int

from mmweaver.core.shapes import Array, Faces, PerPoint, Points, Vertices

# Embree returns 1e37 where nothing is hit.
_MAX_DISTANCE_M = 1e30
_FLOAT32_ERROR_M = 1e-2


class RayCaster:
    """Finds the first face hit by each ray, from either side.

    Embree computes in float32 with processor-dependent rounding (1e-6 m, up to 1e-4 m at grazing incidence, i.e. a
    thousandth of a phase cycle and more), so distances are recomputed to the plane of the face in float64.

    >>> wall = RayCaster(np.array([[-1.0, 2, -1], [1, 2, -1], [0, 2, 1]]), np.array([[0, 1, 2]]))
    >>> wall.distance_m(np.zeros((2, 3)), np.array([[0.0, 1, 0], [0, -1, 0]])).tolist()
    [2.0, inf]
    """

    def __init__(self, vertices_m: Vertices, faces: Faces):
        """Builds the acceleration structure.

        Args:
            vertices_m: Vertices in metres, (vertex, 3).
            faces: Vertex indices of the triangles, (face, 3); may be empty.
        """
        self.num_faces = len(faces)
        if self.num_faces == 0:
            return
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        corner = np.asarray(vertices_m, np.float64)[np.asarray(faces)]
        self._corner_m = corner[:, 0]
        self._normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        self._scene = EmbreeScene(_device(os.getpid()))
        self._mesh = TriangleMesh(
            self._scene,
            np.ascontiguousarray(vertices_m, np.float32),
            np.ascontiguousarray(faces, np.int32),
        )

    def distance_m(self, origins: Points, directions: Points) -> PerPoint:
        """Distance to the first face along each ray.

        Args:
            origins: Ray origins in metres, (point, 3).
            directions: Unit vectors, (point, 3).

        Returns:
            Distance in metres, (point,); inf without a hit.
        """
        return self.first_hit(origins, directions)[0]

    def first_hit(self, origins: Points, directions: Points) -> tuple[PerPoint, Int[Array, " point"]]:
        """Distance to and index of the first face along each ray.

        Args:
            origins: Ray origins in metres, (point, 3).
            directions: Unit vectors, (point, 3).

        Returns:
            Distance in metres and face index, (point,); inf and -1 without a hit.
        """
        if self._is_empty(origins):
            return np.full(len(origins), np.inf), np.full(len(origins), -1)
        hits = self._scene.run(_packed(origins), _packed(directions), output=True)
        face = hits["primID"].astype(np.int64)
        distance = _finite_or_inf(hits["tfar"])
        hit = np.flatnonzero(np.isfinite(distance))
        normal = self._normal[face[hit]]
        towards = np.einsum("ij,ij->i", normal, self._corner_m[face[hit]] - origins[hit])
        along = np.einsum("ij,ij->i", normal, np.asarray(directions, np.float64)[hit])
        exact = np.divide(towards, along, out=distance[hit], where=along != 0)
        # a degenerate triangle has no well-defined plane
        near = np.abs(exact - distance[hit]) < _FLOAT32_ERROR_M
        distance[hit[near]] = exact[near]
        return distance, face

    def is_clear(self, start: Points, end: Points, margin_m: float = 0.02) -> Bool[Array, " point"]:
        """Tests the line of sight between pairs of points.

        Embree's OCCLUDED query has no far limit, hence the distance query.

        Args:
            start: First point in metres, (point, 3).
            end: Second point in metres, (point, 3).
            margin_m: Distance from either end within which faces are ignored; segments shorter than twice the margin
                are clear. Default: 0.02 m.

        Returns:
            Whether no face lies in between, (point,).
        """
        if self._is_empty(start):
            return np.ones(len(start), bool)
        segment = end - start
        length = np.linalg.norm(segment, axis=1)
        unit = segment / np.maximum(length, 1e-12)[:, None]
        reach = _finite_or_inf(self._scene.run(_packed(start + margin_m * unit), _packed(unit), query="DISTANCE"))
        return (reach >= length - 2 * margin_m) | (length <= 2 * margin_m)

    def _is_empty(self, origins: Points) -> bool:
        return self.num_faces == 0 or len(origins) == 0


@lru_cache(maxsize=1)
def _device(process: int) -> Any:
    """One Embree device per process: each takes one of a process's 1,024 thread keys; running out of them crashes."""
    from embreex.rtcore import EmbreeDevice

    return EmbreeDevice()


def _packed(vectors: Points) -> Points:
    return np.ascontiguousarray(vectors, np.float32)


def _finite_or_inf(tfar: PerPoint) -> PerPoint:
    distance = np.asarray(tfar, np.float64)
    distance[distance > _MAX_DISTANCE_M] = np.inf
    return distance
