"""Triangle mesh of a room: furniture tessellated into small faces, walls as whole rectangles."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.shapes import Array, Faces, PerFace, Vertices
from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Appearance, Part, PlacedPiece

FACE_M = 0.25  # longest side: the simulator finds the edges of small faces
_ROWS, _COLUMNS, _RING = 9, 20, 20
_QUAD = np.array([[0, 1, 2], [0, 2, 3]])
_SIDES = (  # normal axis, its sign, and the two tangent axes, whose cross product points outward
    (0, -1, 2, 1),
    (0, 1, 1, 2),
    (1, -1, 0, 2),
    (1, 1, 2, 0),
    (2, -1, 1, 0),
    (2, 1, 0, 1),
)


@dataclass(frozen=True, kw_only=True)
class Mesh:
    """Triangles in the room's frame."""

    vertices_m: Vertices
    faces: Faces
    appearance: PerFace  # index into `appearances`
    piece: PerFace  # index of the piece; -1 for walls, floor and ceiling
    appearances: tuple[Appearance, ...]


def make_room_mesh(size_m: tuple[float, float, float], placed: Sequence[PlacedPiece], palette: Palette) -> Mesh:
    """Triangulates the empty room and all pieces in it.

    Args:
        size_m: Inner width, depth and height in metres.
        placed: Pieces with their positions.
        palette: Surfaces of walls, floor and ceiling.

    Returns:
        The mesh in the room's frame.
    """
    solids = [(corners, _QUAD, surface, -1) for corners, surface in _shell(size_m, palette)]
    for number, item in enumerate(placed):
        for part in item.piece.parts:
            corners, triangles = part_triangles(part)
            solids.append((item.points(corners), triangles, part.appearance, number))
    appearances = list(dict.fromkeys(surface for _, _, surface, _ in solids))
    index = {surface: number for number, surface in enumerate(appearances)}
    starts = np.cumsum([0, *(len(corners) for corners, *_ in solids)])
    counts = [len(triangles) for _, triangles, *_ in solids]
    return Mesh(
        vertices_m=np.concatenate([corners for corners, *_ in solids]),
        faces=np.concatenate([solid[1] + start for solid, start in zip(solids, starts, strict=False)]),
        appearance=np.repeat([index[surface] for _, _, surface, _ in solids], counts),
        piece=np.repeat([number for *_, number in solids], counts),
        appearances=tuple(appearances),
    )


def _shell(size_m: tuple[float, float, float], palette: Palette) -> list[tuple[np.ndarray, Appearance]]:
    """The corners (4, 3), metres, and appearance of floor, ceiling and walls."""
    w, d, h = size_m
    quads = [
        ([(0, 0, 0), (w, 0, 0), (w, d, 0), (0, d, 0)], palette["floor"]),
        ([(0, 0, h), (0, d, h), (w, d, h), (w, 0, h)], palette["ceiling"]),
        ([(0, d, 0), (w, d, 0), (w, d, h), (0, d, h)], palette["wall"]),
        ([(0, 0, 0), (0, d, 0), (0, d, h), (0, 0, h)], palette["wall"]),
        ([(w, 0, 0), (w, 0, h), (w, d, h), (w, d, 0)], palette["wall"]),
        ([(0, 0, 0), (0, 0, h), (w, 0, h), (w, 0, 0)], palette["wall"]),
    ]
    return [(np.array(corners, float), appearance) for corners, appearance in quads]


def part_triangles(part: Part) -> tuple[Vertices, Faces]:
    low, high = np.array(part.low_m), np.array(part.high_m)
    if part.shape == "rounded":
        return _rounded(low, high)
    if part.shape in ("cylinder", "cone"):
        return _cylinder(low, high, 0.75 if part.shape == "cone" else 1.0)
    return _box(low, high)


def _box(low: Float[Array, "3"], high: Float[Array, "3"]) -> tuple[Vertices, Faces]:
    """A box from corner to corner, metres, with faces of at most `FACE_M`."""
    size = high - low
    count = np.maximum(np.ceil(size / FACE_M).astype(int), 1)
    vertices, faces, first = [], [], 0
    for axis, sign, u, v in _SIDES:
        grid = np.empty((count[u] + 1, count[v] + 1, 3))
        grid[..., axis] = high[axis] if sign > 0 else low[axis]
        grid[..., u] = np.linspace(low[u], high[u], count[u] + 1)[:, None]
        grid[..., v] = np.linspace(low[v], high[v], count[v] + 1)[None, :]
        vertices.append(grid.reshape(-1, 3))
        index = np.arange((count[u] + 1) * (count[v] + 1)).reshape(count[u] + 1, count[v] + 1) + first
        faces.append(_quads(index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
        first += index.size
    return np.concatenate(vertices), np.concatenate(faces)


def _quads(*corners: Int[Array, "..."]) -> Faces:
    a, b, c, d = (corner.ravel() for corner in corners)
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def _rounded(low: Float[Array, "3"], high: Float[Array, "3"]) -> tuple[Vertices, Faces]:
    """A sphere split at its symmetry planes and moved apart: a box with rounded edges."""
    polar = np.concatenate([[1e-3], (np.arange(1, _ROWS) + 0.0) / _ROWS * np.pi, [np.pi - 1e-3]])
    polar = np.where(np.abs(polar - np.pi / 2) < 1e-9, np.pi / 2 + 1e-6, polar)
    azimuth = (np.arange(_COLUMNS) + 0.5) / _COLUMNS * 2 * np.pi
    p, t = np.meshgrid(polar, azimuth, indexing="ij")
    sphere = np.stack([np.sin(p) * np.cos(t), np.sin(p) * np.sin(t), np.cos(p)], axis=-1).reshape(-1, 3)
    half = (high - low) / 2
    bevel = min(0.07, 0.6 * float(half.min()))
    index = np.arange(sphere.shape[0]).reshape(len(polar), _COLUMNS)
    after = np.roll(index, -1, axis=1)
    caps = [np.stack([np.full(_COLUMNS - 2, index[0, 0]), index[0, 1:-1], index[0, 2:]], 1)]
    caps.append(np.stack([np.full(_COLUMNS - 2, index[-1, 0]), index[-1, 2:], index[-1, 1:-1]], 1))
    faces = np.concatenate([_quads(index[:-1], index[1:], after[1:], after[:-1]), *caps])
    # Scaled so that the sphere's outermost vertices reach the box.
    sphere = sphere / np.abs(sphere).max(axis=0)
    return (low + high) / 2 + np.sign(sphere) * (half - bevel) + bevel * sphere, faces


def _cylinder(low: Float[Array, "3"], high: Float[Array, "3"], top: float) -> tuple[Vertices, Faces]:
    """A cylinder or truncated cone inscribed in the box; `top` is the ratio of its radii."""
    azimuth = np.arange(_RING) / _RING * 2 * np.pi
    ring = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1) * (high - low)[:2] / 2
    middle = (low + high)[:2] / 2
    # Pots, on the floor, taper downwards; lamp shades taper upwards.
    bottom_share, top_share = (top, 1.0) if low[2] < 0.1 else (1.0, top)
    below = np.column_stack([middle + bottom_share * ring, np.full(_RING, low[2])])
    above = np.column_stack([middle + top_share * ring, np.full(_RING, high[2])])
    hubs = np.array([[*middle, low[2]], [*middle, high[2]]])
    index = np.arange(_RING)
    after = (index + 1) % _RING
    sides = _quads(index, after, after + _RING, index + _RING)
    lower = np.stack([np.full(_RING, 2 * _RING), after, index], axis=1)
    upper = np.stack([np.full(_RING, 2 * _RING + 1), index + _RING, after + _RING], axis=1)
    return np.concatenate([below, above, hubs]), np.concatenate([sides, lower, upper])
