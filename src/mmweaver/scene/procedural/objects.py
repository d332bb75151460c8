"""Objects on furniture, on walls and on the floor. Objects on walls have their back at y = 0."""

from dataclasses import replace

import numpy as np

from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Appearance, Colour, Piece, block

_LEAF: Colour = (0.06, 0.17, 0.05)


def monitor(palette: Palette, rng: np.random.Generator) -> Piece:
    """A screen on a foot."""
    body = Appearance((0.03, 0.03, 0.03), "chipboard", "tv")
    screen = Appearance((0.03, 0.05, 0.09), "glass", "tv", "screen", 0.5, is_glass=True)
    x = float(rng.uniform(0.24, 0.31))
    parts = (
        block((-0.12, 0.12), (-0.09, 0.09), (0.0, 0.015), body),
        block((-0.025, 0.025), (0.01, 0.04), (0.015, 0.20), body),
        block((-x, x), (-0.02, 0.01), (0.11, 0.11 + 1.15 * x), body),
        block((-x + 0.012, x - 0.012), (-0.024, -0.02), (0.122, 0.098 + 1.15 * x), screen),
    )
    return Piece(name="monitor", parts=parts)


def laptop(palette: Palette, rng: np.random.Generator) -> Piece:
    """An open laptop."""
    body, screen = (
        Appearance((0.30, 0.30, 0.32), "metal", "laptop"),
        Appearance((0.03, 0.05, 0.09), "glass", "laptop", "screen", 0.4),
    )
    parts = (
        block((-0.17, 0.17), (-0.12, 0.12), (0.0, 0.018), body),
        block((-0.17, 0.17), (0.10, 0.115), (0.018, 0.24), body),
        block((-0.16, 0.16), (0.097, 0.10), (0.03, 0.23), screen),
    )
    return Piece(name="laptop", parts=parts)


def keyboard(palette: Palette, rng: np.random.Generator) -> Piece:
    """A keyboard."""
    part = block(
        (-0.21, 0.21), (-0.07, 0.07), (0.0, 0.02), Appearance((0.06, 0.06, 0.06), "chipboard", "keyboard", "keys")
    )
    return Piece(name="keyboard", parts=(part,))


def television(palette: Palette, rng: np.random.Generator, *, on_wall: bool = False) -> Piece:
    """A television, on its feet or mounted on the wall."""
    x = float(rng.uniform(0.45, 0.62))
    body = Appearance((0.025, 0.025, 0.025), "chipboard", "tv")
    screen = Appearance((0.015, 0.015, 0.018), "glass", "tv", is_glass=True)
    if on_wall:
        low, high = 1.0, 1.0 + 1.15 * x
        parts = (
            block((-x, x), (-0.06, 0.0), (low, high), body),
            block((-x + 0.01, x - 0.01), (-0.064, -0.06), (low + 0.01, high - 0.01), screen),
        )
        return Piece(name="television", parts=parts, on_wall=True)
    parts = (
        block((-0.25, 0.25), (-0.10, 0.10), (0.0, 0.02), body),
        block((-0.04, 0.04), (-0.02, 0.02), (0.02, 0.10), body),
        block((-x, x), (-0.025, 0.025), (0.06, 0.06 + 1.15 * x), body),
        block((-x + 0.01, x - 0.01), (-0.029, -0.025), (0.07, 0.05 + 1.15 * x), screen),
    )
    return Piece(name="television", parts=parts)


def plant(palette: Palette, rng: np.random.Generator, height_m: float = 1.1) -> Piece:
    """A pot, a stem and clumps of leaves."""
    pot = Appearance((0.45, 0.22, 0.13), "brick", "potted plant")
    wide = 0.16 * (0.5 + 0.5 * height_m)
    parts = [
        block((-wide, wide), (-wide, wide), (0.0, 0.28 * height_m), pot, "cone"),
        block(
            (-0.015, 0.015),
            (-0.015, 0.015),
            (0.28 * height_m, 0.6 * height_m),
            Appearance((0.12, 0.09, 0.04), "wood", "potted plant"),
            "cylinder",
        ),
    ]
    for k in range(7):
        shade = float(rng.uniform(0.7, 1.6))
        appearance = Appearance(
            (_LEAF[0] * shade, _LEAF[1] * shade, _LEAF[2] * shade), "fabric", "potted plant", "leaves"
        )
        turn, out = 2 * np.pi * k / 7 + float(rng.uniform(-0.3, 0.3)), 0.10 * height_m
        x, y, z = float(out * np.cos(turn)), float(out * np.sin(turn)), height_m * (0.48 + 0.08 * (k % 4))
        size = height_m * float(rng.uniform(0.10, 0.15))
        parts.append(
            block((x - size, x + size), (y - size, y + size), (z - 0.8 * size, z + 0.9 * size), appearance, "rounded")
        )
    return Piece(name="plant", parts=tuple(parts))


def floor_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """A foot, a rod and a luminous shade."""
    rod, shade = (
        palette.labelled(palette.metal, "light"),
        Appearance((0.9, 0.82, 0.62), "fabric", "light", emission=1.3),
    )
    parts = (
        block((-0.13, 0.13), (-0.13, 0.13), (0.0, 0.025), rod, "cylinder"),
        block((-0.012, 0.012), (-0.012, 0.012), (0.025, 1.45), rod, "cylinder"),
        block((-0.19, 0.19), (-0.19, 0.19), (1.38, 1.64), shade, "cone"),
    )
    return Piece(name="floor lamp", parts=parts)


def table_lamp(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small lamp with a luminous shade."""
    rod, shade = (
        palette.labelled(palette.metal, "light"),
        Appearance((0.9, 0.82, 0.62), "fabric", "light", emission=1.2),
    )
    parts = (
        block((-0.06, 0.06), (-0.06, 0.06), (0.0, 0.02), rod, "cylinder"),
        block((-0.015, 0.015), (-0.015, 0.015), (0.02, 0.28), rod, "cylinder"),
        block((-0.11, 0.11), (-0.11, 0.11), (0.22, 0.40), shade, "cone"),
    )
    return Piece(name="table lamp", parts=parts)


def cup(palette: Palette, rng: np.random.Generator) -> Piece:
    """A mug."""
    appearance = Appearance((float(rng.uniform(0.2, 0.7)), 0.35, 0.3), "marble", "cup")
    return Piece(name="cup", parts=(block((-0.04, 0.04), (-0.04, 0.04), (0.0, 0.10), appearance, "cylinder"),))


def books(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small pile of books."""
    parts = (
        block((-0.12, 0.12), (-0.09, 0.09), (0.0, 0.025), Appearance((0.50, 0.09, 0.07), "wood", "book")),
        block((-0.10, 0.11), (-0.08, 0.08), (0.025, 0.045), Appearance((0.75, 0.72, 0.66), "wood", "book")),
        block((-0.11, 0.10), (-0.085, 0.08), (0.045, 0.08), Appearance((0.09, 0.18, 0.30), "wood", "book")),
    )
    return Piece(name="books", parts=parts)


def bowl(palette: Palette, rng: np.random.Generator) -> Piece:
    """A bowl with fruit."""
    appearance = Appearance((0.55, 0.55, 0.5), "marble", "bowl")
    fruit = Appearance((0.6, 0.22, 0.03), "wood", "orange")
    parts = (
        block((-0.12, 0.12), (-0.12, 0.12), (0.0, 0.06), appearance, "cylinder"),
        block((-0.09, 0.0), (-0.05, 0.04), (0.05, 0.14), fruit, "rounded"),
        block((0.0, 0.09), (-0.03, 0.06), (0.05, 0.14), fruit, "rounded"),
    )
    return Piece(name="bowl", parts=parts)


def microwave(palette: Palette, rng: np.random.Generator) -> Piece:
    """A microwave oven."""
    body, pane = (
        Appearance((0.55, 0.55, 0.55), "metal", "microwave"),
        Appearance((0.02, 0.02, 0.02), "glass", "microwave"),
    )
    parts = (
        block((-0.24, 0.24), (-0.17, 0.18), (0.0, 0.28), body),
        block((-0.22, 0.10), (-0.175, -0.17), (0.03, 0.25), pane),
    )
    return Piece(name="microwave", parts=parts)


def instrument(palette: Palette, rng: np.random.Generator) -> Piece:
    """A laboratory instrument: a grey box with a small screen."""
    body = Appearance((0.45, 0.46, 0.44), "metal", "furniture-other")
    screen = Appearance((0.04, 0.12, 0.10), "glass", "tv", "screen", 0.5)
    wide, high = float(rng.uniform(0.16, 0.24)), float(rng.uniform(0.16, 0.30))
    parts = (
        block((-wide, wide), (-0.16, 0.18), (0.0, high), body),
        block((-wide + 0.03, 0.02), (-0.165, -0.16), (0.05, high - 0.03), screen),
    )
    return Piece(name="instrument", parts=parts)


def carton(palette: Palette, rng: np.random.Generator) -> Piece:
    """A cardboard box on the floor."""
    appearance = Appearance((0.42, 0.28, 0.16), "chipboard", "cardboard")
    x, y, z = float(rng.uniform(0.18, 0.28)), float(rng.uniform(0.15, 0.24)), float(rng.uniform(0.25, 0.42))
    parts = (
        block((-x, x), (-y, y), (0.0, z), appearance),
        block((-0.03, 0.03), (-y, y), (z, z + 0.002), Appearance((0.5, 0.4, 0.25), "chipboard", "cardboard")),
    )
    return Piece(name="carton", parts=parts)


def bin_(palette: Palette, rng: np.random.Generator) -> Piece:
    """A wastepaper bin."""
    return Piece(name="bin", parts=(block((-0.13, 0.13), (-0.13, 0.13), (0.0, 0.32), palette.dark, "cone"),))


def rug(palette: Palette, rng: np.random.Generator, size_m: tuple[float, float] = (1.8, 1.2)) -> Piece:
    """A rug, flat enough to walk on."""
    appearance = palette.labelled(palette.accent, "rug")
    part = block((-size_m[0] / 2, size_m[0] / 2), (-size_m[1] / 2, size_m[1] / 2), (0.0, 0.012), appearance)
    return Piece(name="rug", parts=(part,))


def mat(palette: Palette, rng: np.random.Generator) -> Piece:
    """An exercise mat."""
    appearance = Appearance((0.05, 0.16, 0.30), "fabric", "rug", "weave")
    return Piece(name="mat", parts=(block((-0.32, 0.32), (-0.9, 0.9), (0.0, 0.015), appearance),))


def treadmill(palette: Palette, rng: np.random.Generator) -> Piece:
    """Deck, posts and console; its front, where the runner steps on, towards -y."""
    dark, metal = palette.labelled(palette.dark, "furniture-other"), palette.labelled(palette.metal, "furniture-other")
    parts = (
        block((-0.36, 0.36), (-0.8, 0.75), (0.0, 0.16), dark),
        block((-0.36, -0.30), (0.45, 0.55), (0.16, 1.15), metal),
        block((0.30, 0.36), (0.45, 0.55), (0.16, 1.15), metal),
        block((-0.36, 0.36), (0.38, 0.60), (1.15, 1.35), dark),
    )
    return Piece(name="treadmill", parts=parts)


# On walls ------------------------------------------------------------------------------------------------------------
def picture(palette: Palette, rng: np.random.Generator) -> Piece:
    """A framed picture."""
    x, z = float(rng.uniform(0.22, 0.45)), float(rng.uniform(0.18, 0.32))
    parts = (
        block((-x, x), (-0.025, 0.0), (1.5 - z, 1.5 + z), palette.labelled(palette.dark_wood, "furniture-other")),
        block(
            (-x + 0.03, x - 0.03),
            (-0.028, -0.025),
            (1.53 - z, 1.47 + z),
            Appearance((0.5, 0.5, 0.5), "chipboard", "paper", "picture"),
        ),
    )
    return Piece(name="picture", parts=parts, on_wall=True)


def whiteboard(palette: Palette, rng: np.random.Generator, width_m: float = 1.6) -> Piece:
    """A whiteboard with scribbles."""
    x = width_m / 2
    parts = (
        block((-x, x), (-0.03, 0.0), (0.95, 1.95), palette.labelled(palette.metal, "furniture-other")),
        block(
            (-x + 0.03, x - 0.03),
            (-0.034, -0.03),
            (0.98, 1.92),
            Appearance((0.80, 0.80, 0.80), "metal", "furniture-other", "scribbles"),
        ),
        block((-x + 0.1, x - 0.1), (-0.08, -0.03), (0.93, 0.96), palette.labelled(palette.metal, "furniture-other")),
    )
    return Piece(name="whiteboard", parts=parts, on_wall=True)


def wall_cabinet(palette: Palette, rng: np.random.Generator, width_m: float = 1.2) -> Piece:
    """A cabinet above a counter."""
    appearance, x = palette.labelled(palette.white, "cabinet"), width_m / 2
    parts = [block((-x, x), (-0.33, 0.0), (1.45, 2.05), appearance)]
    count = max(2, round(width_m / 0.45))
    for k in range(count):
        start = -x + k * width_m / count
        end = start + width_m / count
        parts.append(block((start + 0.006, end - 0.006), (-0.348, -0.33), (1.46, 2.04), appearance))
        parts.append(
            block((end - 0.05, end - 0.036), (-0.365, -0.348), (1.48, 1.60), palette.labelled(palette.metal, "cabinet"))
        )
    return Piece(name="wall cabinet", parts=tuple(parts), on_wall=True)


def mirror(palette: Palette, rng: np.random.Generator) -> Piece:
    """A tall mirror: depth cameras measure nothing there."""
    parts = (
        block((-0.5, 0.5), (-0.02, 0.0), (0.4, 2.0), palette.labelled(palette.metal, "mirror-stuff")),
        block(
            (-0.48, 0.48),
            (-0.024, -0.02),
            (0.42, 1.98),
            Appearance((0.55, 0.58, 0.60), "metal", "mirror-stuff", "sky", is_glass=True),
        ),
    )
    return Piece(name="mirror", parts=parts, on_wall=True)


def door(palette: Palette, rng: np.random.Generator, width_m: float = 0.9) -> Piece:
    """A closed door: leaf, frame and handle."""
    leaf = palette.wood if rng.random() < 0.6 else palette.white
    appearance = replace(leaf, coco="door-stuff", pattern="upright" if leaf.pattern == "grain" else leaf.pattern)
    frame, steel = palette.labelled(palette.white, "door-stuff"), palette.labelled(palette.metal, "door-stuff")
    x, high = width_m / 2, 2.03
    side = 1.0 if rng.random() < 0.5 else -1.0
    at = side * (x - 0.08)
    parts = (
        block((-x, x), (-0.025, 0.0), (0.0, high), appearance),
        block((-x - 0.07, -x), (-0.04, 0.0), (0.0, high + 0.07), frame),
        block((x, x + 0.07), (-0.04, 0.0), (0.0, high + 0.07), frame),
        block((-x, x), (-0.04, 0.0), (high, high + 0.07), frame),
        block((-x + 0.14, x - 0.14), (-0.032, -0.025), (1.15, 1.85), appearance),
        block((-x + 0.14, x - 0.14), (-0.032, -0.025), (0.2, 0.95), appearance),
        block((min(at, at - 0.12 * side), max(at, at - 0.12 * side)), (-0.075, -0.06), (1.03, 1.05), steel),
        block((at - 0.012, at + 0.012), (-0.075, -0.025), (1.02, 1.06), steel),
    )
    return Piece(name="door", parts=parts, landmark="door", on_wall=True)


def window(palette: Palette, rng: np.random.Generator, width_m: float = 1.4) -> Piece:
    """A bright pane in a frame with a sill, sometimes with curtains."""
    frame = Appearance((0.8, 0.8, 0.78), "wood", "window-other")
    pane = Appearance((0.5, 0.66, 0.9), "glass", "window-other", "sky", 2.2, is_glass=True)
    x, low, high = width_m / 2, 0.92, 2.12
    parts = [block((-x, x), (-0.012, 0.0), (low, high), pane)]
    for a in (-x - 0.06, -0.03, x):
        parts.append(block((a, a + 0.06), (-0.05, 0.0), (low - 0.06, high + 0.06), frame))
    for z in (low - 0.06, high):
        parts.append(block((-x, x), (-0.05, 0.0), (z, z + 0.06), frame))
    parts.append(block((-x - 0.08, x + 0.08), (-0.14, 0.0), (low - 0.09, low - 0.06), frame))
    if rng.random() < 0.5:
        cloth = palette.labelled(palette.cloth, "curtain")
        for a in (-x - 0.34, x + 0.04):
            for k in range(5):
                start = a + 0.06 * k
                parts.append(block((start, start + 0.06), (-0.20, -0.15), (0.05, 2.26), cloth, "cylinder"))
        parts.append(
            block((-x - 0.36, x + 0.36), (-0.19, -0.16), (2.26, 2.285), palette.labelled(palette.metal, "curtain"))
        )
        for a in (-x - 0.36, x + 0.33):
            parts.append(block((a, a + 0.03), (-0.19, 0.0), (2.26, 2.285), palette.labelled(palette.metal, "curtain")))
    return Piece(name="window", parts=tuple(parts), landmark="window", on_wall=True)


def ceiling_lamp(palette: Palette) -> Piece:
    """A flat panel below the ceiling; its origin is on the ceiling."""
    appearance = Appearance((0.85, 0.85, 0.82), "plasterboard", "light", "panel", 1.6)
    return Piece(name="ceiling lamp", parts=(block((-0.3, 0.3), (-0.3, 0.3), (-0.04, 0.0), appearance),), on_wall=True)
