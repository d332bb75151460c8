"""The furnished living room, in the radar's frame (x right, y away, z up), but with z = 0 on the floor."""

import numpy as np

from mmweaver.core.seeding import stream
from sample_room.solids import Room, Surface, ball

BACK_WALL_M, LEFT_WALL_M, RIGHT_WALL_M, BEHIND_M, CEILING_M = 4.1, -2.15, 2.35, -1.2, 2.55

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
