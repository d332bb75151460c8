"""Makes the bundled sample room: a furnished living room, rendered to rgb.webp, depth.png and camera.json.

Everything follows from the seed: `python tools/make_sample_room.py` remakes the bundled files. The room is given in the
radar's frame (x right, y away, z up), but with z = 0 on the floor.
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from mmweaver.core.records import CameraIntrinsics
from mmweaver.core.seeding import stream
from mmweaver.geometry.pinhole import viewing_rays
from mmweaver.geometry.ray_caster import RayCaster

SAMPLE = Path(__file__).resolve().parents[1] / "src" / "mmweaver" / "sample"

WIDTH, HEIGHT = 640, 480
FIELD_OF_VIEW_DEG = 87.0  # across, as a RealSense D455's depth
CAMERA_HEIGHT_M = 1.2
PITCH_DEG = 9.0  # downwards
BACK_WALL_M, LEFT_WALL_M, RIGHT_WALL_M, BEHIND_M, CEILING_M = 4.1, -2.15, 2.35, -1.2, 2.55
DEPTH_UNIT_M = 0.001
BASELINE_FOCAL_M_PX = 0.095 * 337.0  # of the stereo pair whose errors the depth shows
DISPARITY_STEP_PX, DISPARITY_NOISE_PX = 1 / 32, 0.04

# Colours in linear light.
WHITE_WALL, CEILING_WHITE = (0.74, 0.71, 0.65), (0.82, 0.82, 0.80)
OAK, WALNUT, PAINTED = (0.46, 0.27, 0.13), (0.20, 0.105, 0.05), (0.66, 0.65, 0.62)
SOFA_BLUE, CUSHION, RUG = (0.085, 0.13, 0.19), (0.62, 0.31, 0.09), (0.55, 0.50, 0.43)
LEAF, POT, SHADE, DARK, GLASS_SKY = (
    (0.06, 0.17, 0.05),
    (0.45, 0.22, 0.13),
    (0.9, 0.82, 0.62),
    (0.03,) * 3,
    (0.5, 0.66, 0.9),
)


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


# The room -----------------------------------------------------------------------------------------------------------
def furnished_room(seed: int) -> Room:
    room = Room()
    _shell(room)
    _sofa(room)
    _low_table(room)
    _shelf(room, seed)
    _window(room)
    _small_things(room, seed)
    return room


def _shell(room: Room) -> None:
    left, right, back, front, top = LEFT_WALL_M, RIGHT_WALL_M, BACK_WALL_M, BEHIND_M, CEILING_M
    plaster = Surface(WHITE_WALL, "plaster")
    room.quad([(left, front, 0), (right, front, 0), (right, back, 0), (left, back, 0)], Surface(OAK, "boards"))
    room.quad([(left, front, top), (left, back, top), (right, back, top), (right, front, top)], Surface(CEILING_WHITE))
    room.quad([(left, back, 0), (right, back, 0), (right, back, top), (left, back, top)], plaster)
    room.quad([(left, front, 0), (left, back, 0), (left, back, top), (left, front, top)], plaster)
    room.quad([(right, front, 0), (right, front, top), (right, back, top), (right, back, 0)], plaster)
    room.quad([(left, front, 0), (left, front, top), (right, front, top), (right, front, 0)], plaster)
    skirting = Surface(PAINTED)
    room.box((left, right), (back - 0.015, back), (0, 0.08), skirting)
    room.box((left, left + 0.015), (front, back), (0, 0.08), skirting)
    room.box((right - 0.015, right), (front, back), (0, 0.08), skirting)


def _sofa(room: Room) -> None:
    """Three seats wide, at the left of the back wall's middle, its seat at 0.43 m, looking at the camera."""
    blue = Surface(SOFA_BLUE, "weave")
    left, right, front, back = -1.55, 0.35, 2.62, 3.50
    room.box((left, right), (front + 0.03, back), (0.07, 0.27), blue, bevel=0.03)
    middle = (left + right) / 2
    for start, end in ((left + 0.19, middle), (middle, right - 0.19)):
        room.box((start + 0.004, end - 0.004), (front, back - 0.22), (0.26, 0.43), blue, bevel=0.035)
        room.box((start + 0.004, end - 0.004), (back - 0.26, back - 0.06), (0.41, 0.84), blue, bevel=0.07)
    room.box((left + 0.1, right - 0.1), (back - 0.12, back), (0.2, 0.78), blue, bevel=0.03)
    for start in (left, right - 0.19):
        room.box((start, start + 0.19), (front + 0.02, back), (0.07, 0.62), blue, bevel=0.06)
    for x in (left + 0.08, right - 0.08):
        for y in (front + 0.1, back - 0.08):
            room.cylinder((x, y, 0), 0.08, (0.018, 0.025), Surface(WALNUT, "grain"))
    room.box((-1.31, -0.91), (3.02, 3.16), (0.44, 0.80), Surface(CUSHION, "weave"), bevel=0.065)


def _low_table(room: Room) -> None:
    """At the right, out of the way: 0.38 m high, and no seat."""
    oak = Surface((0.40, 0.235, 0.115), "grain")
    room.box((1.02, 1.78), (2.15, 2.95), (0.345, 0.38), oak, bevel=0.008)
    room.box((1.10, 1.70), (2.25, 2.85), (0.12, 0.135), oak)
    for x in (1.06, 1.70):
        for y in (2.19, 2.87):
            room.box((x, x + 0.04), (y, y + 0.04), (0, 0.346), oak)
    room.box((1.18, 1.42), (2.40, 2.58), (0.380, 0.402), Surface((0.50, 0.09, 0.07)))
    room.box((1.20, 1.40), (2.41, 2.57), (0.402, 0.420), Surface((0.75, 0.72, 0.66)))
    room.cylinder((1.55, 2.70, 0.38), 0.10, (0.035, 0.042), Surface((0.62, 0.66, 0.68)))


def _shelf(room: Room, seed: int) -> None:
    """A low cabinet with books on it and a shelf above, on the back wall at the right."""
    white, wood = Surface(PAINTED), Surface(WALNUT, "grain")
    room.box((0.95, 2.25), (3.68, 4.08), (0.10, 0.76), white)
    room.box((0.93, 2.27), (3.66, 4.09), (0.76, 0.79), wood)
    room.box((0.99, 2.21), (3.72, 4.06), (0, 0.10), Surface(DARK))
    for start in (0.95, 1.385, 1.82):
        room.box((start + 0.005, start + 0.425), (3.664, 3.68), (0.115, 0.745), white)
        room.box((start + 0.19, start + 0.24), (3.655, 3.665), (0.69, 0.70), Surface(DARK))
    for height in (1.42, 1.78):
        room.box((0.95, 2.25), (3.86, 4.10), (height, height + 0.028), wood)
        _books(room, stream(seed, "books", int(height * 100)), height + 0.028)
    room.cylinder((1.13, 3.88, 0.79), 0.16, (0.055, 0.075), Surface(POT, "grain"))


def _books(room: Room, generator: np.random.Generator, foot: float) -> None:
    x = 1.0 + generator.uniform(0, 0.15)
    while x < 2.0:
        width, height, depth = (
            generator.uniform(0.018, 0.045),
            generator.uniform(0.19, 0.29),
            generator.uniform(0.14, 0.2),
        )
        shade = generator.choice([(0.45, 0.10, 0.08), (0.09, 0.18, 0.30), (0.60, 0.55, 0.44), (0.11, 0.22, 0.15),
                                  (0.35, 0.25, 0.12), (0.05, 0.05, 0.06), (0.65, 0.40, 0.12)])  # fmt: skip
        room.box((x, x + width), (4.09 - depth, 4.09), (foot, foot + height), Surface(tuple(shade.tolist())))
        x += width + (0.002 if generator.random() < 0.85 else generator.uniform(0.1, 0.2))


def _window(room: Room) -> None:
    """In the left wall: a bright pane behind a frame, a sill and a curtain."""
    x, low, high = LEFT_WALL_M, 0.9, 2.15
    room.quad(
        [(x + 0.004, 1.55, low), (x + 0.004, 2.95, low), (x + 0.004, 2.95, high), (x + 0.004, 1.55, high)],
        Surface(GLASS_SKY, glow=2.6),
    )
    frame = Surface((0.8, 0.8, 0.78))
    for y in (1.50, 2.21, 2.92):
        room.box((x, x + 0.05), (y, y + 0.07), (low - 0.05, high + 0.05), frame)
    for z in (low - 0.05, high - 0.02):
        room.box((x, x + 0.05), (1.50, 2.99), (z, z + 0.07), frame)
    room.box((x, x + 0.18), (1.45, 3.04), (low - 0.08, low - 0.05), frame)
    y = np.linspace(2.86, 3.28, 64)
    fold = x + 0.10 + 0.028 * np.sin((y - 2.86) / 0.42 * 2 * np.pi * 5)
    for a in range(63):
        corners = [
            (fold[a], y[a], 0.06),
            (fold[a + 1], y[a + 1], 0.06),
            (fold[a + 1], y[a + 1], 2.35),
            (fold[a], y[a], 2.35),
        ]
        room.quad(corners, Surface((0.60, 0.53, 0.42), "weave"))
    room.box((x + 0.085, x + 0.11), (1.35, 3.4), (2.35, 2.375), Surface(WALNUT))


def _small_things(room: Room, seed: int) -> None:
    room.quad(
        [(-1.30, 1.15, 0.008), (0.50, 1.15, 0.008), (0.50, 2.45, 0.008), (-1.30, 2.45, 0.008)], Surface(RUG, "pile")
    )
    room.box((-1.02, -0.18), (4.075, 4.10), (1.25, 1.85), Surface(WALNUT))
    room.quad(
        [(-0.98, 4.074, 1.29), (-0.22, 4.074, 1.29), (-0.22, 4.074, 1.81), (-0.98, 4.074, 1.81)],
        Surface((0.5,) * 3, "picture"),
    )
    brass = Surface((0.16, 0.13, 0.09))
    room.cylinder((0.62, 3.72, 0), 0.02, (0.13, 0.13), brass)
    room.cylinder((0.62, 3.72, 0.02), 1.40, (0.012, 0.012), brass)
    room.cylinder((0.62, 3.72, 1.40), 0.27, (0.20, 0.13), Surface(SHADE, glow=1.5))
    generator = stream(seed, "plant")
    vertices, faces = ball(8, 12)
    for _ in range(70):
        turn, lift, length = (
            generator.uniform(0, 2 * np.pi),
            generator.uniform(0.25, 1.35),
            generator.uniform(0.14, 0.24),
        )
        along = np.array([np.cos(turn) * np.cos(lift), np.sin(turn) * np.cos(lift), np.sin(lift)])
        across = np.cross(along, (0, 0, 1.0))
        across /= np.linalg.norm(across)
        frame = np.stack([along * length / 2, across * 0.024, np.cross(along, across) * 0.004])
        middle = np.array([1.13, 3.88, 0.94]) + along * length / 2
        room.add(
            middle + vertices @ frame, faces, Surface(tuple((np.array(LEAF) * generator.uniform(0.7, 1.6)).tolist()))
        )


# Its looks ----------------------------------------------------------------------------------------------------------
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


# Light and camera ---------------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Lamp:
    """A rectangle that shines: corner, two edges, and its colour of light (radiant exitance)."""

    corner: tuple[float, float, float]
    edges: tuple[tuple[float, float, float], tuple[float, float, float]]
    light: tuple[float, float, float]


LAMPS = (
    Lamp((LEFT_WALL_M + 0.03, 1.55, 0.9), ((0, 1.4, 0), (0, 0, 1.25)), (3.6, 4.2, 5.0)),
    Lamp((-0.5, 0.6, CEILING_M - 0.01), ((1.0, 0, 0), (0, 1.0, 0)), (2.0, 1.85, 1.55)),
    Lamp((0.52, 3.60, 1.70), ((0.2, 0, 0), (0, 0.2, 0)), (7.0, 5.2, 3.0)),
)


class Renderer:
    """Direct light from the lamps, one diffuse bounce, and a floor of ambient light for the bounces after it."""

    def __init__(self, room: Room, seed: int, lamp_samples: int, bounce_samples: int):
        self.vertices, self.faces, self.face_surface = room.mesh()
        self.surfaces, self.seed = room.surfaces, seed
        self.lamp_samples, self.bounce_samples = lamp_samples, bounce_samples
        self.generator = stream(seed, "light")
        self.caster = RayCaster(self.vertices, self.faces)
        corners = self.vertices[self.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        self.normals = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-15)[:, None]

    def picture(self, origin: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Colour, light received and light of its own (n, 3) of what unit rays from one point meet."""
        _, face, points, normals = self.hit(np.tile(origin, (len(rays), 1)), rays)
        generator = self.generator
        irradiance = self._direct(points, normals, self.lamp_samples, generator)
        bounced = np.zeros_like(irradiance)
        for turn in range(self.bounce_samples):
            directions = _cosine_directions(normals, generator, turn, self.bounce_samples)
            _, far_face, far_points, far_normals = self.hit(points + 1e-3 * normals, directions)
            light = self._direct(far_points, far_normals, 1, generator) + 0.16
            sent = self._colour(far_face, far_points, far_normals) * light + self._glow(far_face)[:, None] * 0.1
            bounced += np.minimum(sent, 1.2)  # the corner by the lamp would leave sparks
        colour = self._colour(face, points, normals)
        return colour, irradiance + bounced / self.bounce_samples + 0.05, colour * self._glow(face)[:, None]

    def hit(self, origins: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        distance, face = self.caster.first_hit(origins, rays)
        distance = np.where(face >= 0, distance, 50.0)
        normals = self.normals[face]
        normals = np.where((normals * rays).sum(axis=1)[:, None] > 0, -normals, normals)
        return distance, face, origins + distance[:, None] * rays, normals

    def _direct(
        self, points: np.ndarray, normals: np.ndarray, samples: int, generator: np.random.Generator
    ) -> np.ndarray:
        total = np.zeros_like(points)
        for lamp in LAMPS:
            edge_a, edge_b = np.array(lamp.edges[0]), np.array(lamp.edges[1])
            area_normal = np.cross(edge_a, edge_b)
            for turn in range(samples):
                u = (turn + generator.random(len(points))) / samples
                v = (generator.random(len(points)) + turn * 0.618) % 1
                place = np.array(lamp.corner) + u[:, None] * edge_a + v[:, None] * edge_b
                between = place - points
                distance = np.linalg.norm(between, axis=1)
                towards = between / distance[:, None]
                received = np.clip((towards * normals).sum(axis=1), 0, None)
                sent = np.abs(towards @ area_normal)  # cosine times area
                clear = self.caster.is_clear(points + 2e-3 * normals, place, margin_m=0.012)
                share = received * sent / (np.pi * np.maximum(distance, 0.2) ** 2) * clear / samples
                total += share[:, None] * np.array(lamp.light)
        return total

    def _colour(self, face: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
        colour = np.zeros_like(points)
        surface_of = self.face_surface[face]
        for index in np.unique(surface_of):
            chosen = surface_of == index
            colour[chosen] = albedo(self.seed, self.surfaces[index], points[chosen], normals[chosen])
        return colour

    def _glow(self, face: np.ndarray) -> np.ndarray:
        return np.array([surface.glow for surface in self.surfaces])[self.face_surface[face]]


def _cosine_directions(normals: np.ndarray, generator: np.random.Generator, turn: int, turns: int) -> np.ndarray:
    """Directions over the hemisphere, as many as a matt surface sends them."""
    u = (turn + generator.random(len(normals))) / turns
    angle = 2 * np.pi * generator.random(len(normals))
    helper = np.where(np.abs(normals[:, :1]) > 0.8, np.array([[0.0, 1, 0]]), np.array([[1.0, 0, 0]]))
    tangent = np.cross(normals, helper)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    other = np.cross(normals, tangent)
    radius = np.sqrt(u)
    flat = radius[:, None] * (np.cos(angle)[:, None] * tangent + np.sin(angle)[:, None] * other)
    return flat + np.sqrt(1 - u)[:, None] * normals


def camera() -> CameraIntrinsics:
    focal = WIDTH / 2 / np.tan(np.deg2rad(FIELD_OF_VIEW_DEG / 2))
    return CameraIntrinsics(
        fx=float(round(focal, 2)), fy=float(round(focal, 2)), cx=(WIDTH - 1) / 2, cy=(HEIGHT - 1) / 2,
        width=WIDTH, height=HEIGHT,
    )  # fmt: skip


def room_from_camera() -> np.ndarray:
    sine, cosine = np.sin(np.deg2rad(PITCH_DEG)), np.cos(np.deg2rad(PITCH_DEG))
    return np.array([[1, 0, 0], [0, -sine, cosine], [0, -cosine, -sine]])


def render(seed: int, lamp_samples: int, bounce_samples: int, oversampling: int) -> tuple[np.ndarray, np.ndarray]:
    """The photo (height, width, 3) in 8 bits, and the exact depth along the optical axis in metres."""
    origin = np.array([0.0, 0.0, CAMERA_HEIGHT_M])
    renderer = Renderer(furnished_room(seed), seed, lamp_samples, bounce_samples)
    pixels = viewing_rays(camera()).reshape(-1, 3)
    colour, light, glow = (np.zeros((HEIGHT * WIDTH, 3)) for _ in range(3))
    for turn in range(oversampling**2):
        shift = np.array([turn % oversampling, turn // oversampling]) / oversampling + (0.5 / oversampling - 0.5)
        rays = (pixels + np.append(shift / camera().fx, 0)) @ room_from_camera().T
        parts = renderer.picture(origin, rays / np.linalg.norm(rays, axis=1)[:, None])
        for total, part in zip((colour, light, glow), parts, strict=True):
            total += part / oversampling**2
    rays = pixels @ room_from_camera().T
    length = np.linalg.norm(rays, axis=1)
    distance, _, points, normals = renderer.hit(np.tile(origin, (len(rays), 1)), rays / length[:, None])
    smooth = smoothed(*(part.reshape(HEIGHT, WIDTH, 3) for part in (light, points, normals)))
    photo = developed((colour * smooth.reshape(-1, 3) + glow).reshape(HEIGHT, WIDTH, 3))
    return np.clip(np.round(255 * photo), 0, 255).astype(np.uint8), (distance / length).reshape(HEIGHT, WIDTH)


def smoothed(light: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Light averaged along surfaces: an a-trous filter that stops at edges of place, direction and strong shadows.

    Reference: Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform (2010).
    """
    kernel = np.array([1, 4, 6, 4, 1]) / 16
    for step in (1, 2, 4):
        total, weight_sum = np.zeros_like(light), np.zeros(light.shape[:2])
        for v, u in np.ndindex(5, 5):
            away = ((v - 2) * step, (u - 2) * step)
            other, place, facing = (np.roll(part, away, (0, 1)) for part in (light, points, normals))
            off_plane = ((place - points) * normals).sum(axis=-1)
            shade = np.log((other.sum(axis=-1) + 0.1) / (light.sum(axis=-1) + 0.1))
            weight = kernel[v] * kernel[u] * np.exp(-np.square(off_plane / 0.02) - np.square(shade * step / 0.9))
            weight *= np.clip((facing * normals).sum(axis=-1), 0, 1) ** 16
            weight *= ((place - points) ** 2).sum(axis=-1) < 0.3**2
            total += weight[..., None] * other
            weight_sum += weight
        light = total / weight_sum[..., None]
    return light


def developed(radiance: np.ndarray) -> np.ndarray:
    """Exposure, a soft shoulder for the highlights, and the sRGB curve."""
    value = 1.8 * radiance
    value = value * (1 + value / 9.0) / (1 + value * 0.75)
    value = np.clip(value, 0, 1)
    return np.where(value < 0.0031308, 12.92 * value, 1.055 * value ** (1 / 2.4) - 0.055)


def measured_depth(depth_m: np.ndarray, seed: int) -> np.ndarray:
    """What a stereo camera would say: errors and steps in disparity, and holes beside near edges and on the window."""
    generator = stream(seed, "depth")
    disparity = BASELINE_FOCAL_M_PX / depth_m
    coarse = generator.normal(0, DISPARITY_NOISE_PX, (HEIGHT // 4, WIDTH // 4))
    disparity = (
        disparity + np.kron(coarse, np.ones((4, 4))) + generator.normal(0, DISPARITY_NOISE_PX / 3, depth_m.shape)
    )
    disparity = np.round(disparity / DISPARITY_STEP_PX) * DISPARITY_STEP_PX
    measured = BASELINE_FOCAL_M_PX / disparity
    # The second eye, at the left, does not see what lies just left of a near thing.
    shadow = np.zeros(depth_m.shape, bool)
    jump = np.maximum(disparity[:, 1:] - disparity[:, :-1], 0)
    for column in range(1, 13):
        shadow[:, : -column - 1] |= (jump[:, column:] > max(column, 1.5)) & (jump[:, column:] < 60)
    speckle = np.kron(generator.random((HEIGHT // 4, WIDTH // 4)) < 0.0015, np.ones((4, 4))) > 0
    counts = np.round(measured / DEPTH_UNIT_M)
    return np.where(shadow | speckle, 0, counts).astype(np.uint16)


def write_sample(folder: Path, seed: int, lamp_samples: int, bounce_samples: int, oversampling: int) -> None:
    photo, depth_m = render(seed, lamp_samples, bounce_samples, oversampling)
    folder.mkdir(parents=True, exist_ok=True)
    Image.fromarray(photo).save(folder / "rgb.webp", lossless=True, quality=100, method=6)
    Image.fromarray(measured_depth(depth_m, seed)).save(folder / "depth.png", optimize=True)
    content = {**vars(camera()), "depth_unit_m": DEPTH_UNIT_M}
    (folder / "camera.json").write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=SAMPLE)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--lamp-samples", type=int, default=4)
    parser.add_argument("--bounce-samples", type=int, default=4)
    parser.add_argument("--oversampling", type=int, default=3)
    arguments = parser.parse_args()
    write_sample(
        arguments.out, arguments.seed, arguments.lamp_samples, arguments.bounce_samples, arguments.oversampling
    )
    print(f"wrote {arguments.out}")


if __name__ == "__main__":
    main()
