"""Shelves, cupboards and large appliances, with their back at y = depth / 2."""

import numpy as np

from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Appearance, Colour, Part, Piece, block

_SPINES: tuple[Colour, ...] = (
    (0.45, 0.10, 0.08),
    (0.09, 0.18, 0.30),
    (0.60, 0.55, 0.44),
    (0.11, 0.22, 0.15),
    (0.35, 0.25, 0.12),
    (0.05, 0.05, 0.06),
    (0.65, 0.40, 0.12),
    (0.50, 0.50, 0.52),
)


def bookcase(palette: Palette, rng: np.random.Generator, width_m: float = 0.9, height_m: float = 1.9) -> Piece:
    """Sides, back, shelves, and rows of books of different heights."""
    wood, x, y = palette.labelled(palette.wood, "shelf"), width_m / 2, 0.15
    parts: list[Part] = [
        block((-x, -x + 0.02), (-y, y), (0.0, height_m), wood),
        block((x - 0.02, x), (-y, y), (0.0, height_m), wood),
        block((-x + 0.02, x - 0.02), (y - 0.01, y), (0.0, height_m), wood),
    ]
    count = max(2, round(height_m / 0.36))
    each = height_m / count
    for k in range(count + 1):
        foot = min(k * each, height_m - 0.02)
        parts.append(block((-x + 0.02, x - 0.02), (-y, y - 0.01), (foot, foot + 0.02), wood))
        if k < count:
            parts += _books(rng, (-x + 0.025, x - 0.025), y - 0.012, foot + 0.02, each - 0.04)
    return Piece(name="bookcase", parts=tuple(parts))


def _books(
    rng: np.random.Generator, across: tuple[float, float], back: float, foot: float, room_m: float
) -> list[Part]:
    parts, x = [], across[0]
    end = across[1] - (0.0 if rng.random() < 0.6 else float(rng.uniform(0.1, 0.3)))
    while True:
        width = float(rng.uniform(0.05, 0.14))
        if x + width > end:
            return parts
        height, depth = float(rng.uniform(0.62, 0.95)) * room_m, float(rng.uniform(0.14, 0.20))
        appearance = Appearance(_SPINES[int(rng.integers(len(_SPINES)))], "wood", "book", "books")
        parts.append(block((x, x + width), (back - depth, back), (foot, foot + height), appearance))
        x += width + (0.0 if rng.random() < 0.85 else float(rng.uniform(0.03, 0.12)))


def cabinet(
    palette: Palette,
    rng: np.random.Generator,
    size_m: tuple[float, float, float] = (0.9, 0.42, 0.8),
    *,
    name: str = "cabinet",
    coco: str = "cabinet",
    appearance: Appearance | None = None,
    drawers: int = 0,
) -> Piece:
    """A body with doors or drawers; `size_m` is width, depth, height."""
    body = palette.labelled(appearance or (palette.wood if rng.random() < 0.5 else palette.white), coco)
    x, y, height = size_m[0] / 2, size_m[1] / 2, size_m[2]
    handle = palette.labelled(palette.metal, coco)
    parts = [
        block((-x + 0.02, x - 0.02), (-y + 0.04, y), (0.0, 0.06), palette.labelled(palette.dark, coco)),
        block((-x, x), (-y + 0.02, y), (0.06, height), body),
    ]
    if drawers:
        each = (height - 0.09) / drawers
        for k in range(drawers):
            low = 0.075 + k * each
            parts.append(block((-x + 0.01, x - 0.01), (-y, -y + 0.02), (low, low + each - 0.012), body))
            parts.append(block((-0.06, 0.06), (-y - 0.02, -y), (low + each * 0.6, low + each * 0.6 + 0.014), handle))
    else:
        count = max(1, round(size_m[0] / 0.5))
        each = 2 * x / count
        for k in range(count):
            start = -x + k * each
            parts.append(block((start + 0.006, start + each - 0.006), (-y, -y + 0.02), (0.075, height - 0.012), body))
            at = start + (each - 0.05 if k % 2 == 0 else 0.035)
            middle = 0.55 * height
            parts.append(block((at, at + 0.015), (-y - 0.02, -y), (middle - 0.07, middle + 0.07), handle))
    return Piece(name=name, parts=tuple(parts))


def wardrobe(palette: Palette, rng: np.random.Generator) -> Piece:
    """A tall cabinet with two doors."""
    return cabinet(
        palette,
        rng,
        (float(rng.uniform(0.9, 1.2)), 0.58, float(rng.uniform(1.9, 2.1))),
        name="wardrobe",
        coco="cupboard",
    )


def locker(palette: Palette, rng: np.random.Generator) -> Piece:
    """A steel cabinet."""
    return cabinet(palette, rng, (0.8, 0.42, 1.85), name="steel cupboard", appearance=palette.metal)


def dresser(palette: Palette, rng: np.random.Generator) -> Piece:
    """A chest of drawers."""
    return cabinet(palette, rng, (float(rng.uniform(0.8, 1.1)), 0.45, 0.82), name="chest of drawers", drawers=3)


def nightstand(palette: Palette, rng: np.random.Generator) -> Piece:
    """A small cabinet next to a bed."""
    return cabinet(palette, rng, (0.42, 0.38, 0.48), name="nightstand", drawers=2)


def pedestal(palette: Palette, rng: np.random.Generator) -> Piece:
    """A filing cabinet."""
    return cabinet(palette, rng, (0.42, 0.55, 1.05), name="filing cabinet", appearance=palette.metal, drawers=3)


def fridge(palette: Palette, rng: np.random.Generator) -> Piece:
    """A tall white or steel box with two doors."""
    steel = palette.labelled(palette.metal, "refrigerator")
    body = steel if rng.random() < 0.5 else Appearance((0.72, 0.72, 0.72), "metal", "refrigerator")
    height = float(rng.uniform(1.65, 1.85))
    parts = (
        block((-0.30, 0.30), (-0.26, 0.32), (0.0, height), body),
        block((-0.295, 0.295), (-0.31, -0.26), (0.05, 0.62 * height), body),
        block((-0.295, 0.295), (-0.31, -0.26), (0.64 * height, height - 0.01), body),
        block((0.22, 0.24), (-0.35, -0.31), (0.40 * height, 0.59 * height), steel),
        block((0.22, 0.24), (-0.35, -0.31), (0.67 * height, 0.82 * height), steel),
    )
    return Piece(name="refrigerator", parts=parts)


def oven(palette: Palette, rng: np.random.Generator) -> Piece:
    """A cooker as high as the counter."""
    steel = Appearance((0.55, 0.55, 0.56), "metal", "oven")
    glass = Appearance((0.02, 0.02, 0.02), "glass", "oven", is_glass=True)
    parts = (
        block((-0.30, 0.30), (-0.27, 0.30), (0.0, 0.91), steel),
        block((-0.29, 0.29), (-0.30, -0.27), (0.10, 0.68), glass),
        block((-0.25, 0.25), (-0.335, -0.30), (0.62, 0.64), steel),
        block((-0.28, 0.28), (-0.22, 0.26), (0.91, 0.92), glass),
    )
    return Piece(name="oven", parts=parts)


def steel_rack(palette: Palette, rng: np.random.Generator) -> Piece:
    """Four posts and four shelves with boxes."""
    metal = palette.labelled(palette.metal, "shelf")
    carton = Appearance((0.42, 0.28, 0.16), "chipboard", "cardboard")
    x, y, height = float(rng.uniform(0.42, 0.55)), 0.20, 1.75
    parts = [block((a, a + 0.03), (b, b + 0.03), (0.0, height), metal) for a in (-x, x - 0.03) for b in (-y, y - 0.03)]
    for k in range(4):
        foot = 0.12 + k * 0.53
        parts.append(block((-x, x), (-y, y), (foot, foot + 0.025), metal))
        at = -x + 0.05
        while at < x - 0.35:
            width = float(rng.uniform(0.18, 0.32))
            if rng.random() < 0.75:
                high = float(rng.uniform(0.12, 0.32)) if k < 3 else 0.02
                parts.append(
                    block((at, at + width), (-y + 0.03, y - 0.05), (foot + 0.025, foot + 0.025 + high), carton)
                )
            at += width + 0.03
    return Piece(name="steel rack", parts=tuple(parts))


def dumbbell_rack(palette: Palette, rng: np.random.Generator) -> Piece:
    """A rack with two rows of weights."""
    metal = palette.labelled(palette.metal, "furniture-other")
    parts = [block((a, a + 0.06), (-0.22, 0.22), (0.0, 0.80), metal) for a in (-0.62, 0.56)]
    for row, (front, foot) in enumerate(((-0.20, 0.32), (0.0, 0.70))):
        parts.append(block((-0.56, 0.56), (front, front + 0.20), (foot, foot + 0.03), metal))
        for k in range(4):
            at, wide = -0.46 + k * 0.27, 0.05 + 0.012 * k + 0.01 * row
            dark = palette.labelled(palette.dark, "sports ball")
            parts.append(
                block(
                    (at - wide, at + wide),
                    (front + 0.02, front + 0.18),
                    (foot + 0.03, foot + 0.03 + 2 * wide),
                    dark,
                    "rounded",
                )
            )
    return Piece(name="dumbbell rack", parts=tuple(parts))
