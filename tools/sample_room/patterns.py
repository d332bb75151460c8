"""How surfaces look: boards, grain, weave, pile, plaster and the picture on the wall."""

import numpy as np

from mmweaver.core.seeding import stream
from sample_room.solids import Surface


def lattice_noise(seed: int, name: str, points: np.ndarray, scale: float) -> np.ndarray:
    """Smooth noise in -1..1 over the plane: random values on a lattice, blended."""
    table = stream(seed, "lattice", name).uniform(-1, 1, (64, 64))
    place = points / scale
    cell = np.floor(place).astype(int)
    fraction = place - cell
    blend = fraction * fraction * (3 - 2 * fraction)
    a, b = cell[:, 0] % 64, cell[:, 1] % 64
    c, d = (a + 1) % 64, (b + 1) % 64
    low = table[a, b] * (1 - blend[:, 0]) + table[c, b] * blend[:, 0]
    high = table[a, d] * (1 - blend[:, 0]) + table[c, d] * blend[:, 0]
    return low * (1 - blend[:, 1]) + high * blend[:, 1]


def flat_coordinates(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """The two coordinates along the surface: those that the normal points along least."""
    drop = np.argmax(np.abs(normals), axis=1)
    kept = np.array([[1, 2], [0, 2], [0, 1]])[drop]
    return np.take_along_axis(points, kept, axis=1)


def albedo(seed: int, surface: Surface, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Colour of the points of one surface, in linear light."""
    plane = flat_coordinates(points, normals)
    colour = np.tile(np.array(surface.colour), (len(points), 1))
    if surface.pattern == "boards":
        return colour * boards(seed, points[:, :2])[:, None]
    if surface.pattern == "grain":
        return colour * (1 + 0.22 * lattice_noise(seed, "grain", plane * (1, 12), 0.11))[:, None]
    if surface.pattern == "weave":
        thread = lattice_noise(seed, "weave", plane, 0.010) + 0.7 * lattice_noise(seed, "cloth", plane, 0.09)
        return colour * (1 + 0.10 * thread)[:, None]
    if surface.pattern == "pile":
        stripe = np.abs(np.abs(plane[:, 0] + 0.4) - 0.78) < 0.035
        stripe |= np.abs(np.abs(plane[:, 1] - 1.80) - 0.55) < 0.035
        shade = 1 + 0.10 * lattice_noise(seed, "pile", plane, 0.012) + 0.06 * lattice_noise(seed, "worn", plane, 0.2)
        return colour * (shade * np.where(stripe, 0.45, 1.0))[:, None]
    if surface.pattern == "plaster":
        return colour * (1 + 0.02 * lattice_noise(seed, "plaster", plane, 0.35))[:, None]
    if surface.pattern == "picture":
        return landscape(seed, plane)
    return colour


def boards(seed: int, plane: np.ndarray) -> np.ndarray:
    """Boards 14 cm wide and 1.1 m long, along y, staggered; each with its own shade and grain."""
    board = np.floor(plane[:, 0] / 0.14)
    start = lattice_noise(seed, "stagger", np.stack([board + 0.5, board * 0 + 7.5], 1), 1.0) * 1.1
    length = np.floor((plane[:, 1] + start) / 1.1)
    shade = stream(seed, "boards").uniform(0.80, 1.18, (64, 64))[board.astype(int) % 64, length.astype(int) % 64]
    shifted = plane + np.stack([board * 0.37, length * 0.91 + board * 1.7], axis=1)
    grain = lattice_noise(seed, "fine", shifted * (9, 1), 0.12) + 0.6 * lattice_noise(
        seed, "wide", shifted * (5, 1), 0.3
    )
    across = np.abs(plane[:, 0] / 0.14 - board - 0.5) > 0.485
    along = np.abs((plane[:, 1] + start) / 1.1 - length - 0.5) > 0.498
    return shade * (1 + 0.10 * grain) * np.where(across | along, 0.55, 1.0)


def landscape(seed: int, plane: np.ndarray) -> np.ndarray:
    """What hangs on the wall: hills under an evening sky, with a white mount."""
    x, z = plane[:, 0], plane[:, 1] - 1.29
    sky = np.array([0.85, 0.55, 0.30]) * (1 - z[:, None] / 0.6) + np.array([0.20, 0.33, 0.55]) * z[:, None] / 0.6
    colour = sky
    for index, (foot, shade) in enumerate(
        ((0.24, (0.20, 0.22, 0.30)), (0.18, (0.10, 0.15, 0.14)), (0.12, (0.05, 0.09, 0.05)))
    ):
        ridge = foot + 0.05 * lattice_noise(seed, f"ridge {index}", np.stack([x, x * 0 + 0.3], 1), 0.16)
        colour = np.where((z < ridge)[:, None], np.array(shade), colour)
    mount = (np.abs(x + 0.60) > 0.33) | (np.abs(z - 0.26) > 0.21)
    return np.where(mount[:, None], np.array([0.8, 0.79, 0.75]), colour)
