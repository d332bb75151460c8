"""Triangles of boxes, cylinders and balls, each with what it looks like."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Surface:
    """How a thing looks: colour, pattern, and light of its own."""

    colour: tuple[float, ...]
    pattern: str = "plain"  # plain | boards | grain | weave | pile | plaster | picture | books
    glow: float = 0.0


class Room:
    """Triangles and what they look like, collected thing by thing."""

    def __init__(self) -> None:
        self.vertices: list[np.ndarray] = []
        self.faces: list[np.ndarray] = []
        self.face_surface: list[np.ndarray] = []
        self.surfaces: list[Surface] = []
        self._count = 0

    def add(self, vertices: np.ndarray, faces: np.ndarray, surface: Surface) -> None:
        self.vertices.append(np.asarray(vertices, float))
        self.faces.append(np.asarray(faces) + self._count)
        self.face_surface.append(np.full(len(faces), len(self.surfaces)))
        self.surfaces.append(surface)
        self._count += len(vertices)

    def box(self, x: tuple, y: tuple, z: tuple, surface: Surface, *, bevel: float = 0.0) -> None:
        """A box between two corners; with a bevel its edges are rounded (a superellipsoid shell in between)."""
        if bevel == 0:
            corners = np.array([[a, b, c] for a in x for b in y for c in z], float)
            quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
            faces = [triangle for q in quads for triangle in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
            self.add(corners, np.array(faces), surface)
            return
        low, high = np.array([x[0], y[0], z[0]]), np.array([x[1], y[1], z[1]])
        vertices, faces = ball(24, 48)
        core = np.sign(vertices) * np.maximum((high - low) / 2 - bevel, 0)
        self.add((low + high) / 2 + core + bevel * vertices, faces, surface)

    def quad(self, corners: list[tuple[float, float, float]], surface: Surface) -> None:
        self.add(np.array(corners), np.array([[0, 1, 2], [0, 2, 3]]), surface)

    def cylinder(
        self, foot: tuple[float, float, float], height: float, radii: tuple[float, float], surface: Surface
    ) -> None:
        turn = np.linspace(0, 2 * np.pi, 33)[:-1]
        ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(32)], axis=1)
        top = np.array(foot) + np.array([0, 0, height])
        vertices = np.concatenate([np.array(foot) + radii[0] * ring, top + radii[1] * ring, [foot], [top]])
        index = np.arange(32)
        after = (index + 1) % 32
        faces = np.concatenate(
            [
                np.stack([index, after, after + 32], axis=1),
                np.stack([index, after + 32, index + 32], axis=1),
                np.stack([np.full(32, 64), after, index], axis=1),
                np.stack([np.full(32, 65), index + 32, after + 32], axis=1),
            ]
        )
        self.add(vertices, faces, surface)

    def mesh(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return np.concatenate(self.vertices), np.concatenate(self.faces), np.concatenate(self.face_surface)


def ball(rows: int, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """A unit sphere without vertices on its symmetry planes, so that it can be pulled apart into a rounded box."""
    polar = (np.arange(rows) + 0.5) / rows * np.pi
    turn = (np.arange(columns) + 0.5) / columns * 2 * np.pi
    polar[0], polar[-1] = 1e-3, np.pi - 1e-3
    p, t = np.meshgrid(polar, turn, indexing="ij")
    vertices = np.stack([np.sin(p) * np.cos(t), np.sin(p) * np.sin(t), np.cos(p)], axis=-1).reshape(-1, 3)
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b = index[:-1], index[1:]
    faces = np.concatenate(
        [
            np.stack([a, b, np.roll(b, -1, 1)], axis=-1).reshape(-1, 3),
            np.stack([a, np.roll(b, -1, 1), np.roll(a, -1, 1)], axis=-1).reshape(-1, 3),
        ]
    )
    caps = [(0, i, i + 1) for i in range(1, columns - 1)]
    last = (rows - 1) * columns
    caps += [(last, last + i + 1, last + i) for i in range(1, columns - 1)]
    return vertices, np.concatenate([faces, np.array(caps)])
