"""Furniture to sit and lie on."""

import numpy as np

from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import LocalSeat, Part, Piece, block, legs


def chair(palette: Palette, rng: np.random.Generator) -> Piece:
    """Four legs, a seat, a slatted or a solid back."""
    wood, height = palette.labelled(palette.wood, "chair"), float(rng.uniform(0.43, 0.48))
    seat_appearance = palette.labelled(palette.accent, "chair") if rng.random() < 0.4 else wood
    half, depth, back = float(rng.uniform(0.19, 0.23)), 0.40, float(rng.uniform(0.84, 0.98))
    parts = [
        *legs((-half, half), (-depth / 2, depth / 2), height - 0.03, 0.035, wood),
        block((-half, half), (-depth / 2, depth / 2), (height - 0.03, height), seat_appearance),
        block((-half, -half + 0.035), (depth / 2 - 0.035, depth / 2), (height, back), wood),
        block((half - 0.035, half), (depth / 2 - 0.035, depth / 2), (height, back), wood),
    ]
    rails = ((height + 0.12, back),) if rng.random() < 0.5 else ((back - 0.09, back), (back - 0.26, back - 0.19))
    for low, high in rails:
        parts.append(block((-half + 0.035, half - 0.035), (depth / 2 - 0.03, depth / 2 - 0.008), (low, high), wood))
    seat = LocalSeat(0.0, 0.0, height, 2 * half, depth)
    return Piece(name="chair", parts=tuple(parts), seats=(seat,))


def office_chair(palette: Palette, rng: np.random.Generator) -> Piece:
    """Star foot, column, upholstered seat and back, often armrests."""
    cloth, dark = palette.labelled(palette.accent, "chair"), palette.labelled(palette.dark, "chair")
    height, half = float(rng.uniform(0.44, 0.50)), 0.24
    parts = [
        block((-0.29, 0.29), (-0.03, 0.03), (0.03, 0.08), dark),
        block((-0.03, 0.03), (-0.29, 0.29), (0.03, 0.08), dark),
        block((-0.03, 0.03), (-0.03, 0.03), (0.08, height - 0.09), dark, "cylinder"),
        block((-half, half), (-0.24, 0.23), (height - 0.09, height), cloth, "rounded"),
        block((-0.03, 0.03), (0.22, 0.25), (height - 0.08, height + 0.22), dark),
        block((-0.22, 0.22), (0.22, 0.29), (height + 0.12, height + 0.52), cloth, "rounded"),
    ]
    parts += [
        block((x - 0.025, x + 0.025), (y - 0.025, y + 0.025), (0.0, 0.05), dark, "cylinder")
        for x, y in ((-0.27, 0.0), (0.27, 0.0), (0.0, -0.27), (0.0, 0.27))
    ]
    if rng.random() < 0.6:
        for side in (-1, 1):
            edge = side * (half + 0.02)
            parts.append(block((edge - 0.02, edge + 0.02), (-0.02, 0.02), (height - 0.07, height + 0.19), dark))
            parts.append(block((edge - 0.03, edge + 0.03), (-0.15, 0.13), (height + 0.19, height + 0.22), dark))
    return Piece(name="office chair", parts=tuple(parts), seats=(LocalSeat(0.0, 0.0, height, 0.46, 0.46),))


def sofa(palette: Palette, rng: np.random.Generator, places: int = 2) -> Piece:
    """Arms, seat cushions, back cushions, short feet; its back at y = 0.45."""
    cloth = palette.labelled(palette.cloth, "couch")
    width, depth, height = 0.62 * places + 0.36, float(rng.uniform(0.82, 0.95)), float(rng.uniform(0.40, 0.46))
    back = float(rng.uniform(0.78, 0.90))
    left, front, rear = -width / 2, -depth / 2, depth / 2
    parts = [
        *legs(
            (left + 0.05, -left - 0.05),
            (front + 0.06, rear - 0.04),
            0.08,
            0.05,
            palette.labelled(palette.dark_wood, "couch"),
        ),
        block((left + 0.1, -left - 0.1), (front + 0.03, rear), (0.08, height - 0.14), cloth),
        block((left + 0.1, -left - 0.1), (rear - 0.13, rear), (height - 0.14, back - 0.06), cloth, "rounded"),
    ]
    for side in (-1, 1):
        x = (left, left + 0.18) if side < 0 else (-left - 0.18, -left)
        parts.append(block(x, (front + 0.02, rear), (0.08, height + 0.17), cloth, "rounded"))
    each = (width - 0.36) / places
    seats = []
    for k in range(places):
        start = left + 0.18 + k * each
        across = (start + 0.004, start + each - 0.004)
        parts.append(block(across, (front, rear - 0.22), (height - 0.16, height), cloth, "rounded"))
        parts.append(block(across, (rear - 0.27, rear - 0.07), (height - 0.02, back), cloth, "rounded"))
        seats.append(LocalSeat(start + each / 2, front + 0.32, height, each, depth - 0.27))
    name = "sofa" if places > 1 else "armchair"
    if places > 1 and rng.random() < 0.7:
        pillow = palette.labelled(palette.accent, "pillow")
        x = left + 0.22 + float(rng.uniform(0, 0.1))
        parts.append(
            block((x, x + 0.38), (rear - 0.40, rear - 0.26), (height - 0.005, height + 0.34), pillow, "rounded")
        )
    return Piece(name=name, parts=tuple(parts), seats=tuple(seats))


def armchair(palette: Palette, rng: np.random.Generator) -> Piece:
    """A sofa with one seat."""
    return sofa(palette, rng, 1)


def stool(palette: Palette, rng: np.random.Generator) -> Piece:
    """Four legs and a round or square top, no back."""
    wood, height, half = palette.labelled(palette.wood, "chair"), float(rng.uniform(0.43, 0.50)), 0.17
    shape = "cylinder" if rng.random() < 0.6 else "box"
    top = block((-half, half), (-half, half), (height - 0.035, height), wood, shape)
    leg = legs((-0.12, 0.12), (-0.12, 0.12), height - 0.035, 0.03, wood)
    return Piece(name="stool", parts=(*leg, top), seats=(LocalSeat(0.0, 0.0, height, 2 * half, 2 * half),))


def bench(palette: Palette, rng: np.random.Generator) -> Piece:
    """A plank on two trestles."""
    wood, height, half = (
        palette.labelled(palette.wood, "bench"),
        float(rng.uniform(0.42, 0.47)),
        float(rng.uniform(0.5, 0.7)),
    )
    parts = [block((-half, half), (-0.18, 0.18), (height - 0.04, height), wood)]
    for x in (-half + 0.08, half - 0.13):
        parts.append(block((x, x + 0.05), (-0.16, 0.16), (0.0, height - 0.04), wood))
    seats = tuple(LocalSeat(x, 0.0, height, half, 0.36) for x in (-half / 2, half / 2))
    return Piece(name="bench", parts=tuple(parts), seats=seats)


def bed(palette: Palette, rng: np.random.Generator) -> Piece:
    """Frame, mattress, pillows and blanket, its head at y = 1; one can sit on the foot end."""
    wood, white = palette.labelled(palette.wood, "bed"), palette.labelled(palette.white, "bed")
    half, height = (0.50 if rng.random() < 0.5 else 0.72), float(rng.uniform(0.46, 0.54))
    parts: list[Part] = [
        *legs((-half, half), (-1.0, 1.0), 0.14, 0.06, wood),
        block((-half, half), (-1.0, 0.96), (0.14, 0.30), wood),
        block((-half, half), (0.96, 1.0), (0.14, float(rng.uniform(0.85, 1.1))), wood),
        block((-half + 0.02, half - 0.02), (-0.98, 0.96), (0.28, height), white, "rounded"),
        block(
            (-half + 0.005, half - 0.005),
            (-0.99, 0.35),
            (0.33, height + 0.02),
            palette.labelled(palette.cloth, "blanket"),
            "rounded",
        ),
    ]
    centres = (0.0,) if half < 0.6 else (-0.36, 0.36)
    for x in centres:
        pillow = palette.labelled(palette.white, "pillow")
        parts.append(block((x - 0.30, x + 0.30), (0.48, 0.90), (height - 0.01, height + 0.11), pillow, "rounded"))
    seat = LocalSeat(0.0, -0.72, height + 0.02, 2 * half, 0.5)
    return Piece(name="bed", parts=tuple(parts), seats=(seat,), landmark="bed")


def weight_bench(palette: Palette, rng: np.random.Generator) -> Piece:
    """A padded bench for a gym."""
    dark, metal = palette.labelled(palette.dark, "bench"), palette.labelled(palette.metal, "bench")
    height = float(rng.uniform(0.42, 0.46))
    parts = (
        block((-0.14, 0.14), (-0.6, 0.6), (height - 0.08, height), dark, "rounded"),
        block((-0.03, 0.03), (-0.55, 0.55), (height - 0.13, height - 0.07), metal),
        block((-0.22, 0.22), (-0.5, -0.44), (0.0, 0.06), metal),
        block((-0.22, 0.22), (0.44, 0.5), (0.0, 0.06), metal),
        block((-0.03, 0.03), (-0.5, -0.44), (0.06, height - 0.13), metal),
        block((-0.03, 0.03), (0.44, 0.5), (0.06, height - 0.13), metal),
    )
    return Piece(name="weight bench", parts=parts, seats=(LocalSeat(0.0, -0.3, height, 0.28, 0.5),))
