"""Procedural textures: reflectance from surface coordinates, by value noise on a lattice."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array
from mmweaver.scene.procedural.palette import TABLES
from mmweaver.scene.procedural.parts import Appearance

Plane2 = Float[Array, "point 2"]
Shade = Float[Array, " point"]
Rgb = Float[Array, "point 3"]
_TABLE = stream(0, "procedural", "lattice").uniform(-1, 1, (64, 64)).astype(np.float32)


def lattice_noise(points: Plane2, scale_m: float | tuple[float, float]) -> Shade:
    """Value noise in -1 to 1: random values on a lattice, interpolated.

    Args:
        points: Surface coordinates in metres, (point, 2).
        scale_m: Spacing of the lattice in metres, one or one per coordinate.

    Returns:
        Noise (point,).
    """
    place = points / np.asarray(scale_m, np.float32)
    cell = np.floor(place)
    fraction = place - cell
    blend = fraction * fraction * (3 - 2 * fraction)
    index = cell.astype(np.int32)
    a, b = index[:, 0] & 63, index[:, 1] & 63
    c, d = (a + 1) & 63, (b + 1) & 63
    low = _TABLE[a, b] + (_TABLE[c, b] - _TABLE[a, b]) * blend[:, 0]
    high = _TABLE[a, d] + (_TABLE[c, d] - _TABLE[a, d]) * blend[:, 0]
    return low + (high - low) * blend[:, 1]


def albedo(appearance: Appearance, plane: Plane2) -> Rgb:
    """Reflectance of a surface with its texture.

    Args:
        appearance: Colour and pattern.
        plane: Surface coordinates in metres, (point, 2).

    Returns:
        Linear RGB, (point, 3).
    """
    colour = np.asarray(appearance.colour, np.float32)
    layers = _NOISE.get(appearance.pattern)
    made = PATTERNS[appearance.pattern](plane, colour) if layers is None else _noise(plane, layers)
    return made if made.ndim == 2 else colour * made[:, None]


def _random(cell: np.ndarray, other: np.ndarray) -> Shade:
    """A random number in 0 to 1 for each pair of integers."""
    return _TABLE[(cell * 7 + other * 13).astype(int) & 63, (cell * 3 - other * 5).astype(int) & 63] / 2 + 0.5


# Each texture maps surface coordinates, (point, 2) metres, and a base colour (3,) to a factor of that colour, (point,),
# or to colours, (point, 3).
def _noise(plane: Plane2, layers: tuple) -> Shade:
    """1 plus noise of each layer's amplitude and spacing."""
    shade: Any = 1
    for amplitude, scale_m in layers:
        shade = shade + amplitude * lattice_noise(plane, scale_m)
    return shade


def _boards(plane: Plane2, colour: np.ndarray) -> Shade:
    """Floorboards, 14 cm wide, 1.1 m long, staggered."""
    board = np.floor(plane[:, 0] / 0.14)
    along = plane[:, 1] / 1.1 + _random(board, board * 0)
    piece = np.floor(along)
    shade = 0.85 + 0.3 * _random(board, piece)
    grain = 0.10 * lattice_noise(plane + 0.37 * board[:, None], (0.013, 0.12))
    seam = (np.abs(plane[:, 0] / 0.14 - board - 0.5) > 0.485) | (np.abs(along - piece - 0.5) > 0.498)
    return shade * (1 + grain) * np.where(seam, 0.55, 1.0)


def _tiled(
    plane: Plane2,
    colour: np.ndarray,
    size: tuple[float, float],
    joint_m: float,
    spread: float,
    joint: float,
    bond: bool,
) -> Shade:
    row = np.floor(plane[:, 1] / size[1])
    shifted = plane[:, 0] / size[0] + (0.5 * (row % 2) if bond else 0.0)
    column = np.floor(shifted)
    inside = (np.abs(shifted - column - 0.5) < 0.5 - joint_m / size[0]) & (
        np.abs(plane[:, 1] / size[1] - row - 0.5) < 0.5 - joint_m / size[1]
    )
    shade = 1 - spread + 2 * spread * _random(column, row)
    return np.where(inside, shade * (1 + 0.05 * lattice_noise(plane, 0.04)), joint)


def _panels(plane: Plane2, colour: np.ndarray) -> Shade:
    panel = np.floor(plane[:, 0] / 0.6)
    seam = np.abs(plane[:, 0] / 0.6 - panel - 0.5) > 0.493
    return (
        (0.9 + 0.2 * _random(panel, panel)) * (1 + 0.12 * lattice_noise(plane, (0.02, 0.4))) * np.where(seam, 0.4, 1.0)
    )


def _books(plane: Plane2, colour: np.ndarray) -> Rgb:
    """A row of book spines about 3 cm wide: each with its own shade and a band for the title."""
    spine = np.floor(plane[:, 0] / 0.031)
    tint = np.stack([_random(spine, spine * 0 + k) for k in range(3)], axis=1)
    band = np.abs((plane[:, 1] % 0.33) - 0.2) < 0.012
    mixed = colour * (0.5 + 0.5 * tint[:, :1]) + 0.22 * (tint - 0.4) * tint[:, 1:2]
    edge = np.abs(plane[:, 0] / 0.031 - spine - 0.5) > 0.44
    mixed = np.where(band[:, None], mixed + 0.2, mixed) * np.where(edge, 0.35, 1.0)[:, None]
    return np.clip(mixed, 0.01, 0.9)


def _screen(plane: Plane2, colour: np.ndarray) -> Rgb:
    """Windows and lines of text."""
    line = (np.floor(plane[:, 1] / 0.012) % 2 == 0) & (lattice_noise(plane, (0.06, 0.012)) > -0.1)
    window = lattice_noise(plane, 0.2) > 0.0
    paper = np.where(window[:, None], np.array([0.5, 0.52, 0.55]), colour + 0.05)
    return np.where((line & window)[:, None], 0.15, paper).astype(np.float32)


def _scribbles(plane: Plane2, colour: np.ndarray) -> Rgb:
    strokes = np.abs(lattice_noise(plane, 0.07)) < 0.05
    strokes &= lattice_noise(plane, 0.45) > 0.15
    ink = np.where((lattice_noise(plane, 0.6) > 0)[:, None], np.array([0.05, 0.08, 0.4]), np.array([0.4, 0.05, 0.05]))
    return np.where(strokes[:, None], ink, colour).astype(np.float32)


def _picture(plane: Plane2, colour: np.ndarray) -> Rgb:
    """Hills under a sky."""
    high = plane[:, 1] % 1.0
    ridge = 0.45 + 0.12 * lattice_noise(np.stack([plane[:, 0], plane[:, 0] * 0 + 0.3], 1), 0.16)
    near = 0.36 + 0.08 * lattice_noise(np.stack([plane[:, 0], plane[:, 0] * 0 + 0.9], 1), 0.1)
    sky = np.array([0.75, 0.5, 0.3]) * (1 - high[:, None]) + np.array([0.25, 0.4, 0.65]) * high[:, None]
    made = np.where((high < ridge)[:, None], np.array([0.18, 0.22, 0.22]), sky)
    return np.where((high < near)[:, None], np.array([0.07, 0.12, 0.05]), made).astype(np.float32)


def _sky(plane: Plane2, colour: np.ndarray) -> Rgb:
    cloud = np.clip(lattice_noise(plane, 0.7) + 0.5 * lattice_noise(plane, 0.25), 0, 1)[:, None]
    return (colour * (1 - 0.5 * cloud) + 0.4 * cloud).astype(np.float32)


def _keys(plane: Plane2, colour: np.ndarray) -> Shade:
    gap = (np.abs((plane[:, 0] % 0.019) - 0.0095) > 0.008) | (np.abs((plane[:, 1] % 0.019) - 0.0095) > 0.008)
    return np.where(gap, 0.4, 1.6)


_NOISE = TABLES["noise"]
PATTERNS: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "boards": _boards,
    "tiles": partial(_tiled, size=(0.3, 0.3), joint_m=0.004, spread=0.05, joint=0.7, bond=False),
    "brick": partial(_tiled, size=(0.24, 0.075), joint_m=0.006, spread=0.25, joint=1.6, bond=True),
    "panels": _panels,
    "books": _books,
    "screen": _screen,
    "scribbles": _scribbles,
    "picture": _picture,
    "sky": _sky,
    "keys": _keys,
}
