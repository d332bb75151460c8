"""Tables, desks, benches and counters."""

import numpy as np

from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Part, Piece, block, legs


def table(
    palette: Palette,
    rng: np.random.Generator,
    size_m: tuple[float, float] = (1.4, 0.85),
    *,
    name: str = "table",
    height_m: float = 0.74,
) -> Piece:
    """A top on four legs."""
    wood = palette.labelled(palette.wood, "table")
    x, y, height = size_m[0] / 2, size_m[1] / 2, height_m + float(rng.uniform(-0.02, 0.02))
    top = block((-x, x), (-y, y), (height - 0.035, height), wood)
    foot = legs((-x + 0.04, x - 0.04), (-y + 0.04, y - 0.04), height - 0.035, 0.06, wood)
    return Piece(name=name, parts=(*foot, top), landmark="table")


def coffee_table(palette: Palette, rng: np.random.Generator) -> Piece:
    """A low table with a shelf."""
    size = (float(rng.uniform(0.7, 1.0)), float(rng.uniform(0.45, 0.6)))
    made = table(palette, rng, size, name="coffee table", height_m=float(rng.uniform(0.36, 0.44)))
    x, y = size[0] / 2 - 0.05, size[1] / 2 - 0.05
    return Piece(
        name=made.name,
        parts=(*made.parts, block((-x, x), (-y, y), (0.12, 0.14), palette.labelled(palette.wood, "table"))),
        landmark="table",
    )


def desk(palette: Palette, rng: np.random.Generator, width_m: float = 1.4) -> Piece:
    """A top on two sides and a modesty panel, or on metal legs; its back at y = depth / 2."""
    top_appearance = palette.labelled(palette.wood if rng.random() < 0.6 else palette.white, "desk-stuff")
    x, y, height = width_m / 2, float(rng.uniform(0.33, 0.40)), float(rng.uniform(0.72, 0.75))
    parts: list[Part] = [block((-x, x), (-y, y), (height - 0.03, height), top_appearance)]
    if rng.random() < 0.5:
        for side in (-x, x - 0.03):
            parts.append(block((side, side + 0.03), (-y + 0.02, y - 0.01), (0.0, height - 0.03), top_appearance))
        parts.append(block((-x + 0.03, x - 0.03), (y - 0.08, y - 0.06), (0.25, height - 0.03), top_appearance))
    else:
        parts += legs(
            (-x + 0.04, x - 0.04),
            (-y + 0.04, y - 0.04),
            height - 0.03,
            0.05,
            palette.labelled(palette.metal, "desk-stuff"),
        )
    return Piece(name="desk", parts=tuple(parts), landmark="table")


def lab_bench(palette: Palette, rng: np.random.Generator, width_m: float = 1.8) -> Piece:
    """Cabinets below a stone top, with a shelf on posts above its back."""
    body, top = palette.labelled(palette.white, "cabinet"), palette.labelled(palette.dark, "counter")
    x, y = width_m / 2, 0.36
    parts = [
        block((-x + 0.02, x - 0.02), (-y + 0.06, y), (0.0, 0.10), palette.labelled(palette.dark, "cabinet")),
        block((-x, x), (-y + 0.03, y), (0.10, 0.87), body),
        block((-x, x), (-y, y), (0.87, 0.90), top),
        block((-x, x), (y - 0.22, y), (1.33, 1.36), palette.labelled(palette.white, "shelf")),
    ]
    for a in (-x, x - 0.03):
        parts.append(block((a, a + 0.03), (y - 0.03, y), (0.90, 1.33), palette.labelled(palette.metal, "shelf")))
    parts += _door_lines(x, -y + 0.03, 0.12, 0.85, palette)
    return Piece(name="lab bench", parts=tuple(parts), landmark="table")


def counter(palette: Palette, rng: np.random.Generator, width_m: float = 1.8) -> Piece:
    """A kitchen's base cabinets, worktop, sink and tap."""
    body, top = palette.labelled(palette.white, "cabinet"), palette.labelled(palette.dark_wood, "counter")
    steel, x, y = palette.labelled(palette.metal, "sink"), width_m / 2, 0.30
    at = float(rng.uniform(-x + 0.35, x - 0.35))
    parts = [
        block((-x, x), (-y + 0.06, y), (0.0, 0.10), palette.labelled(palette.dark, "cabinet")),
        block((-x, x), (-y + 0.03, y), (0.10, 0.87), body),
        block((-x, x), (-y, y), (0.87, 0.91), top),
        block((at - 0.25, at + 0.25), (-0.20, 0.16), (0.91, 0.918), steel),
        block((at - 0.02, at + 0.02), (0.19, 0.23), (0.91, 1.16), steel, "cylinder"),
        block((at - 0.015, at + 0.015), (0.03, 0.21), (1.13, 1.16), steel),
    ]
    parts += _door_lines(x, -y + 0.03, 0.13, 0.85, palette)
    return Piece(name="kitchen counter", parts=tuple(parts), landmark="counter")


def _door_lines(x: float, front: float, low: float, high: float, palette: Palette) -> list[Part]:
    """Door fronts with handles."""
    count = max(2, round(2 * x / 0.5))
    each, parts = 2 * x / count, []
    for k in range(count):
        start = -x + k * each
        parts.append(
            block(
                (start + 0.006, start + each - 0.006),
                (front - 0.014, front),
                (low, high),
                palette.labelled(palette.white, "cabinet"),
            )
        )
        middle = start + each / 2
        parts.append(
            block(
                (middle - 0.07, middle + 0.07),
                (front - 0.034, front - 0.014),
                (high - 0.08, high - 0.065),
                palette.labelled(palette.metal, "cabinet"),
            )
        )
    return parts


def workbench(palette: Palette, rng: np.random.Generator, width_m: float = 1.6) -> Piece:
    """Thick top on heavy legs, with a shelf below and a pegboard behind."""
    wood, metal = palette.labelled(palette.wood, "table"), palette.labelled(palette.metal, "table")
    x, y, height = width_m / 2, 0.34, float(rng.uniform(0.84, 0.92))
    parts = [
        *legs((-x + 0.03, x - 0.03), (-y + 0.03, y - 0.03), height - 0.06, 0.09, wood),
        block((-x, x), (-y, y), (height - 0.06, height), wood),
        block((-x + 0.05, x - 0.05), (-y + 0.05, y - 0.05), (0.18, 0.21), wood),
        block((-x, x), (y - 0.025, y), (height, height + 0.62), palette.labelled(palette.wood, "furniture-other")),
    ]
    for k in range(4):
        start = -x + 0.18 + k * (2 * x - 0.3) / 4
        length = float(rng.uniform(0.18, 0.38))
        parts.append(
            block((start, start + 0.05), (y - 0.05, y - 0.025), (height + 0.55 - length, height + 0.55), metal)
        )
    return Piece(name="workbench", parts=tuple(parts), landmark="table")
