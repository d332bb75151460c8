"""The furniture of procedural rooms: a function per piece, which builds it from solids.

A new piece is one function here or in `objects`, or a row of [furniture] in rooms.toml where it is another piece in
other sizes. Pieces have their origin on the floor and their front towards -y.
"""

from dataclasses import replace
from typing import Any

import numpy as np

import mmweaver.scene.procedural.objects  # noqa: F401 - registers the objects, too
from mmweaver.scene.procedural.builder import BUILDERS, Builder, Extent, Size, piece
from mmweaver.scene.procedural.palette import COLOURS, TABLES, Palette
from mmweaver.scene.procedural.parts import Piece


def make_piece(name: str, palette: Palette, rng: np.random.Generator, **sizes: Any) -> Piece:
    """Makes a piece by its name in BUILDERS or in [furniture] of rooms.toml."""
    row = TABLES["furniture"].get(name)
    if row is not None:
        name, sizes = row["form"], {"name": name, **row, **sizes}
        del sizes["form"]
    return BUILDERS[name](palette, rng, **sizes)


# To sit and lie on --------------------------------------------------------------------------------------------------
@piece("chair")
def chair(b: Builder):
    """Four legs, a seat, a slatted or a solid back."""
    height = b.uniform(0.43, 0.48)
    seat = "accent" if b.chance(0.4) else "wood"
    half, back = b.uniform(0.19, 0.23), b.uniform(0.84, 0.98)
    b.legs("wood", half, 0.2, height - 0.03, 0.035)
    b.box(seat, half, 0.2, (height - 0.03, height))
    for x in ((-half, -half + 0.035), (half - 0.035, half)):
        b.box("wood", x, (0.2 - 0.035, 0.2), (height, back))
    for z in ((height + 0.12, back),) if b.chance(0.5) else ((back - 0.09, back), (back - 0.26, back - 0.19)):
        b.box("wood", half - 0.035, (0.2 - 0.03, 0.2 - 0.008), z)
    b.seat(0.0, 0.0, height, 2 * half, 0.4)


@piece("chair")
def office_chair(b: Builder):
    """Star foot, column, upholstered seat and back, often armrests."""
    height, half = b.uniform(0.44, 0.50), 0.24
    b.box("dark", 0.29, 0.03, (0.03, 0.08))
    b.box("dark", 0.03, 0.29, (0.03, 0.08))
    b.cylinder("dark", 0.03, (0.08, height - 0.09))
    b.rounded("accent", half, (-0.24, 0.23), (height - 0.09, height))
    b.box("dark", 0.03, (0.22, 0.25), (height - 0.08, height + 0.22))
    b.rounded("accent", 0.22, (0.22, 0.29), (height + 0.12, height + 0.52))
    for x, y in ((-0.27, 0.0), (0.27, 0.0), (0.0, -0.27), (0.0, 0.27)):
        b.cylinder("dark", 0.025, 0.05, x, y)
    if b.chance(0.6):
        for edge in (-half - 0.02, half + 0.02):
            b.box("dark", (edge - 0.02, edge + 0.02), 0.02, (height - 0.07, height + 0.19))
            b.box("dark", (edge - 0.03, edge + 0.03), (-0.15, 0.13), (height + 0.19, height + 0.22))
    b.seat(0.0, 0.0, height, 0.46, 0.46)


@piece("couch")
def sofa(b: Builder, places: int = 0):
    """Arms, seat cushions, back cushions, short feet; two or three places where none are given."""
    places = places or 2 + b.chance(0.45)
    half, y, height = (0.62 * places + 0.36) / 2, b.uniform(0.82, 0.95) / 2, b.uniform(0.40, 0.46)
    back = b.uniform(0.78, 0.90)
    b.legs("dark_wood", half - 0.05, (-y + 0.06, y - 0.04), 0.08, 0.05)
    b.box("cloth", half - 0.1, (-y + 0.03, y), (0.08, height - 0.14))
    b.rounded("cloth", half - 0.1, (y - 0.13, y), (height - 0.14, back - 0.06))
    for x in ((-half, -half + 0.18), (half - 0.18, half)):
        b.rounded("cloth", x, (-y + 0.02, y), (0.08, height + 0.17))
    each = (2 * half - 0.36) / places
    for k in range(places):
        start = -half + 0.18 + k * each
        across = (start + 0.004, start + each - 0.004)
        b.rounded("cloth", across, (-y, y - 0.22), (height - 0.16, height))
        b.rounded("cloth", across, (y - 0.27, y - 0.07), (height - 0.02, back))
        b.seat(start + each / 2, -y + 0.32, height, each, 2 * y - 0.27)
    if places > 1 and b.chance(0.7):
        x = -half + 0.22 + b.uniform(0.0, 0.1)
        b.rounded("accent", (x, x + 0.38), (y - 0.40, y - 0.26), (height - 0.005, height + 0.34), "pillow")


@piece("chair", is_free=True)
def stool(b: Builder):
    """Four legs and a round or square top, no back."""
    height = b.uniform(0.43, 0.50)
    shape = "cylinder" if b.chance(0.6) else "box"
    b.legs("wood", 0.12, 0.12, height - 0.035, 0.03)
    b.box("wood", 0.17, 0.17, (height - 0.035, height), shape=shape)
    b.seat(0.0, 0.0, height, 0.34, 0.34)


@piece("bench")
def bench(b: Builder):
    """A plank on two trestles."""
    height, half = b.uniform(0.42, 0.47), b.uniform(0.5, 0.7)
    b.box("wood", half, 0.18, (height - 0.04, height))
    for x in (-half + 0.08, half - 0.13):
        b.box("wood", (x, x + 0.05), 0.16, height - 0.04)
    for x in (-half / 2, half / 2):
        b.seat(x, 0.0, height, half, 0.36)


@piece("bench", is_free=True)
def weight_bench(b: Builder):
    """A padded bench for a gym."""
    height = b.uniform(0.42, 0.46)
    b.rounded("dark", 0.14, 0.6, (height - 0.08, height))
    b.box("metal", 0.03, 0.55, (height - 0.13, height - 0.07))
    for x, z in ((0.22, 0.06), (0.03, (0.06, height - 0.13))):
        for y in ((-0.5, -0.44), (0.44, 0.5)):
            b.box("metal", x, y, z)
    b.seat(0.0, -0.3, height, 0.28, 0.5)


@piece("bed", landmark="bed")
def bed(b: Builder):
    """Frame, mattress, pillows and blanket, its head at y = 1; one can sit on the foot end."""
    half, height = (0.50 if b.chance(0.5) else 0.72), b.uniform(0.46, 0.54)
    b.legs("wood", half, 1.0, 0.14, 0.06)
    b.box("wood", half, (-1.0, 0.96), (0.14, 0.30))
    b.box("wood", half, (0.96, 1.0), (0.14, b.uniform(0.85, 1.1)))
    b.rounded("white", half - 0.02, (-0.98, 0.96), (0.28, height))
    b.rounded("cloth", half - 0.005, (-0.99, 0.35), (0.33, height + 0.02), "blanket")
    for x in (0.0,) if half < 0.6 else (-0.36, 0.36):
        b.rounded("white", (x - 0.30, x + 0.30), (0.48, 0.90), (height - 0.01, height + 0.11), "pillow")
    b.seat(0.0, -0.72, height + 0.02, 2 * half, 0.5)


# Tables, desks, benches and counters --------------------------------------------------------------------------------
@piece("table", landmark="table")
def table(b: Builder, width_m: Size, depth_m: Size, height_m: Size = 0.74, shelf_m: Extent = 0.0):
    """A top on four legs, with a shelf below from and to `shelf_m` if that is not 0."""
    x, y = b.size(width_m) / 2, b.size(depth_m) / 2
    height = b.size(height_m) + b.uniform(-0.02, 0.02)
    b.legs("wood", x - 0.04, y - 0.04, height - 0.035, 0.06)
    b.box("wood", x, y, (height - 0.035, height))
    if shelf_m:
        b.box("wood", x - 0.05, y - 0.05, shelf_m)


@piece("desk-stuff", landmark="table")
def desk(b: Builder, width_m: Size):
    """A top on two sides and a modesty panel, or on metal legs; its back at y = depth / 2."""
    x = b.size(width_m) / 2
    top = "wood" if b.chance(0.6) else "white"
    y, height = b.uniform(0.33, 0.40), b.uniform(0.72, 0.75)
    b.box(top, x, y, (height - 0.03, height))
    if b.chance(0.5):
        for side in (-x, x - 0.03):
            b.box(top, (side, side + 0.03), (-y + 0.02, y - 0.01), height - 0.03)
        b.box(top, x - 0.03, (y - 0.08, y - 0.06), (0.25, height - 0.03))
    else:
        b.legs("metal", x - 0.04, y - 0.04, height - 0.03, 0.05)


@piece("cabinet", landmark="table")
def lab_bench(b: Builder, width_m: Size):
    """Cabinets below a stone top, with a shelf on posts above its back."""
    x, y = b.size(width_m) / 2, 0.36
    b.box("dark", x - 0.02, (-y + 0.06, y), 0.10)
    b.box("white", x, (-y + 0.03, y), (0.10, 0.87))
    b.box("dark", x, y, (0.87, 0.90), "counter")
    b.box("white", x, (y - 0.22, y), (1.33, 1.36), "shelf")
    for a in (-x, x - 0.03):
        b.box("metal", (a, a + 0.03), (y - 0.03, y), (0.90, 1.33), "shelf")
    _fronts(b, x, -y + 0.03, 0.12, 0.85)


@piece("cabinet", name="kitchen counter", landmark="counter")
def counter(b: Builder, width_m: Size):
    """A kitchen's base cabinets, worktop, sink and tap."""
    x, y = b.size(width_m) / 2, 0.30
    at = b.uniform(-x + 0.35, x - 0.35)
    b.box("dark", x, (-y + 0.06, y), 0.10)
    b.box("white", x, (-y + 0.03, y), (0.10, 0.87))
    b.box("dark_wood", x, y, (0.87, 0.91), "counter")
    b.box("metal", (at - 0.25, at + 0.25), (-0.20, 0.16), (0.91, 0.918), "sink")
    b.box("metal", (at - 0.02, at + 0.02), (0.19, 0.23), (0.91, 1.16), "sink", "cylinder")
    b.box("metal", (at - 0.015, at + 0.015), (0.03, 0.21), (1.13, 1.16), "sink")
    _fronts(b, x, -y + 0.03, 0.13, 0.85)


def _fronts(b: Builder, x: float, front: float, low: float, high: float):
    """Door fronts with handles."""
    count = max(2, round(2 * x / 0.5))
    each = 2 * x / count
    for k in range(count):
        start = -x + k * each
        b.box("white", (start + 0.006, start + each - 0.006), (front - 0.014, front), (low, high))
        middle = start + each / 2
        b.box("metal", (middle - 0.07, middle + 0.07), (front - 0.034, front - 0.014), (high - 0.08, high - 0.065))


@piece("table", landmark="table")
def workbench(b: Builder, width_m: Size):
    """Thick top on heavy legs, with a shelf below and a pegboard behind."""
    x, y, height = b.size(width_m) / 2, 0.34, b.uniform(0.84, 0.92)
    b.legs("wood", x - 0.03, y - 0.03, height - 0.06, 0.09)
    b.box("wood", x, y, (height - 0.06, height))
    b.box("wood", x - 0.05, y - 0.05, (0.18, 0.21))
    b.box("wood", x, (y - 0.025, y), (height, height + 0.62), "furniture-other")
    for k in range(4):
        start = -x + 0.18 + k * (2 * x - 0.3) / 4
        length = b.uniform(0.18, 0.38)
        b.box("metal", (start, start + 0.05), (y - 0.05, y - 0.025), (height + 0.55 - length, height + 0.55))


# Shelves, cupboards and large appliances ----------------------------------------------------------------------------
@piece("shelf")
def bookcase(b: Builder, width_m: float, height_m: float):
    """Sides, back, shelves, and rows of books of different heights."""
    x, y = width_m / 2, 0.15
    b.box("wood", (-x, -x + 0.02), y, height_m)
    b.box("wood", (x - 0.02, x), y, height_m)
    b.box("wood", x - 0.02, (y - 0.01, y), height_m)
    count = max(2, round(height_m / 0.36))
    each = height_m / count
    for k in range(count + 1):
        foot = min(k * each, height_m - 0.02)
        b.box("wood", x - 0.02, (-y, y - 0.01), (foot, foot + 0.02))
        if k < count:
            _row_of_books(b, x - 0.025, y - 0.012, foot + 0.02, each - 0.04)


def _row_of_books(b: Builder, half: float, back: float, foot: float, room_m: float):
    at, end = -half, half - (0.0 if b.chance(0.6) else b.uniform(0.1, 0.3))
    while at + (width := b.uniform(0.05, 0.14)) <= end:
        height, depth = b.uniform(0.62, 0.95) * room_m, b.uniform(0.14, 0.20)
        colour = COLOURS["spines"][int(b.rng.integers(len(COLOURS["spines"])))]
        spine = replace(b.palette["spine"], colour=colour)
        b.box(spine, (at, at + width), (back - depth, back), (foot, foot + height))
        at += width + (0.0 if b.chance(0.85) else b.uniform(0.03, 0.12))


@piece("cabinet")
def cabinet(b: Builder, size_m: tuple[Size, Size, Size] = (0.9, 0.42, 0.8), finish: str = "", drawers: int = 0):
    """A body with doors or drawers; `size_m` is width, depth, height."""
    width, depth, height = map(b.size, size_m)
    body = finish or ("wood" if b.chance(0.5) else "white")
    x, y = width / 2, depth / 2
    b.box("dark", x - 0.02, (-y + 0.04, y), 0.06)
    b.box(body, x, (-y + 0.02, y), (0.06, height))
    for k in range(drawers):
        each = (height - 0.09) / drawers
        low = 0.075 + k * each
        b.box(body, x - 0.01, (-y, -y + 0.02), (low, low + each - 0.012))
        b.box("metal", 0.06, (-y - 0.02, -y), (low + each * 0.6, low + each * 0.6 + 0.014))
    count = 0 if drawers else max(1, round(width / 0.5))
    for k in range(count):
        each = 2 * x / count
        start = -x + k * each
        b.box(body, (start + 0.006, start + each - 0.006), (-y, -y + 0.02), (0.075, height - 0.012))
        at, middle = start + (each - 0.05 if k % 2 == 0 else 0.035), 0.55 * height
        b.box("metal", (at, at + 0.015), (-y - 0.02, -y), (middle - 0.07, middle + 0.07))


@piece("refrigerator")
def refrigerator(b: Builder):
    """A tall white or steel box with two doors."""
    body, height = "metal" if b.chance(0.5) else "white steel", b.uniform(1.65, 1.85)
    b.box(body, 0.30, (-0.26, 0.32), height)
    b.box(body, 0.295, (-0.31, -0.26), (0.05, 0.62 * height))
    b.box(body, 0.295, (-0.31, -0.26), (0.64 * height, height - 0.01))
    b.box("metal", (0.22, 0.24), (-0.35, -0.31), (0.40 * height, 0.59 * height))
    b.box("metal", (0.22, 0.24), (-0.35, -0.31), (0.67 * height, 0.82 * height))


@piece("oven")
def oven(b: Builder):
    """A cooker as high as the counter."""
    b.box("oven steel", 0.30, (-0.27, 0.30), 0.91)
    b.box("oven glass", 0.29, (-0.30, -0.27), (0.10, 0.68))
    b.box("oven steel", 0.25, (-0.335, -0.30), (0.62, 0.64))
    b.box("oven glass", 0.28, (-0.22, 0.26), (0.91, 0.92))


@piece("shelf")
def steel_rack(b: Builder):
    """Four posts and four shelves with boxes."""
    x, y = b.uniform(0.42, 0.55), 0.20
    b.legs("metal", x, y, 1.75, 0.03)
    for k in range(4):
        foot = 0.12 + k * 0.53
        b.box("metal", x, y, (foot, foot + 0.025))
        at = -x + 0.05
        while at < x - 0.35:
            width = b.uniform(0.18, 0.32)
            if b.chance(0.75):
                high = b.uniform(0.12, 0.32) if k < 3 else 0.02
                b.box("cardboard", (at, at + width), (-y + 0.03, y - 0.05), (foot + 0.025, foot + 0.025 + high))
            at += width + 0.03


@piece()
def dumbbell_rack(b: Builder):
    """A rack with two rows of weights."""
    for a in (-0.62, 0.56):
        b.box("metal", (a, a + 0.06), 0.22, 0.80)
    for row, (front, foot) in enumerate(((-0.20, 0.32), (0.0, 0.70))):
        b.box("metal", 0.56, (front, front + 0.20), (foot, foot + 0.03))
        for k in range(4):
            at, wide = -0.46 + k * 0.27, 0.05 + 0.012 * k + 0.01 * row
            y, z = (front + 0.02, front + 0.18), (foot + 0.03, foot + 0.03 + 2 * wide)
            b.rounded("dark", (at - wide, at + wide), y, z, "sports ball")


@piece()
def treadmill(b: Builder):
    """Deck, posts and console; its front, where the runner steps on, towards -y."""
    b.box("dark", 0.36, (-0.8, 0.75), 0.16)
    b.box("metal", (-0.36, -0.30), (0.45, 0.55), (0.16, 1.15))
    b.box("metal", (0.30, 0.36), (0.45, 0.55), (0.16, 1.15))
    b.box("dark", 0.36, (0.38, 0.60), (1.15, 1.35))
