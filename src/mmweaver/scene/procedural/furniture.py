"""The furniture of procedural rooms: a function per piece, which builds it from solids.

A new piece is one function here, or a row of [furniture] in rooms.toml where it is another piece in other sizes. Pieces
have their origin on the floor and their front towards -y; those on walls have their back at y = 0.
"""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mmweaver.scene.procedural.palette import COLOURS, TABLES, Palette
from mmweaver.scene.procedural.parts import Appearance, LocalSeat, Part, Piece

Extent = float | tuple[float, float]
Size = float | tuple[float, float]

BUILDERS: dict[str, Callable[..., Piece]] = {}


class Builder:
    """Collects the parts and seats of a piece of furniture.

    Args:
        palette: surfaces by name; those without a class take `coco`, the piece's.
        rng: from which random sizes are sampled, in the order of the calls.
    """

    def __init__(self, palette: Palette, rng: np.random.Generator, coco: str):
        self.palette, self.rng, self.coco = palette, rng, coco
        self.parts: list[Part] = []
        self.seats: list[LocalSeat] = []

    def uniform(self, low: float, high: float) -> float:
        """A random length, metres."""
        return float(self.rng.uniform(low, high))

    def size(self, size_m: Size) -> float:
        """A length, sampled where it is a range."""
        return size_m if isinstance(size_m, int | float) else self.uniform(*size_m)

    def chance(self, share: float) -> bool:
        """True in this share of pieces."""
        return bool(self.rng.random() < share)

    def box(self, finish: str | Appearance, x: Extent, y: Extent, z: Extent, coco: str = "", shape: str = "box"):
        """Adds a solid inscribed in a box, metres.

        Args:
            finish: a surface, or its name in the palette.
            x, y: from and to; one number is half the size of a solid in the middle.
            z: from and to; one number is the height of a solid on the floor.
            coco: class of the part where it is not that of the piece.
            shape: "box", "rounded", "cylinder" or "cone".
        """
        (x0, x1), (y0, y1) = ((-a, a) if isinstance(a, int | float) else a for a in (x, y))
        z0, z1 = (0.0, z) if isinstance(z, int | float) else z
        look = self.palette[finish] if isinstance(finish, str) else finish
        look = replace(look, coco=coco or look.coco or self.coco)
        self.parts.append(Part((x0, y0, z0), (x1, y1, z1), look, shape))

    def rounded(self, finish: str | Appearance, x: Extent, y: Extent, z: Extent, coco: str = ""):
        """Adds a box with rounded edges."""
        self.box(finish, x, y, z, coco, "rounded")

    def cylinder(self, finish: str | Appearance, radius_m: float, z: Extent, x: float = 0.0, y: float = 0.0):
        """Adds an upright cylinder around (x, y)."""
        across, along = ((a - radius_m, a + radius_m) if a else radius_m for a in (x, y))
        self.box(finish, across, along, z, shape="cylinder")

    def legs(self, finish: str, x: float, y: Extent, height_m: float, thick_m: float, coco: str = ""):
        """Adds four legs at the corners of a rectangle, inside it."""
        y0, y1 = (-y, y) if isinstance(y, int | float) else y
        for a in (-x, x - thick_m):
            for b in (y0, y1 - thick_m):
                self.box(finish, (a, a + thick_m), (b, b + thick_m), height_m, coco)

    def seat(self, x: float, y: float, height_m: float, width_m: float, depth_m: float):
        """Adds a place to sit, facing -y."""
        self.seats.append(LocalSeat(x, y, height_m, width_m, depth_m))


def piece(coco: str = "furniture-other", name: str = "", landmark: str = "", **flags: bool) -> Callable:
    """Registers the function that builds a piece, under its own name; `name`: what several such pieces are called."""

    def register(build: Any) -> Any:
        own = build.__name__.strip("_").replace("_", " ")

        def make(palette: Palette, rng: np.random.Generator, coco: str = coco, name: str = name or own, **sizes: Any):
            builder = Builder(palette, rng, coco)
            build(builder, **sizes)
            parts, seats = tuple(builder.parts), tuple(builder.seats)
            return Piece(name=name, parts=parts, seats=seats, landmark=landmark, **flags)

        BUILDERS[own] = make
        return build

    return register


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


# Objects ------------------------------------------------------------------------------------------------------------
@piece("tv")
def monitor(b: Builder):
    """A screen on a foot."""
    x = b.uniform(0.24, 0.31)
    b.box("black", 0.12, 0.09, 0.015)
    b.box("black", 0.025, (0.01, 0.04), (0.015, 0.20))
    b.box("black", x, (-0.02, 0.01), (0.11, 0.11 + 1.15 * x))
    b.box("monitor screen", x - 0.012, (-0.024, -0.02), (0.122, 0.098 + 1.15 * x))


@piece("laptop")
def laptop(b: Builder):
    """An open laptop."""
    b.box("aluminium", 0.17, 0.12, 0.018)
    b.box("aluminium", 0.17, (0.10, 0.115), (0.018, 0.24))
    b.box("laptop screen", 0.16, (0.097, 0.10), (0.03, 0.23))


@piece("keyboard")
def keyboard(b: Builder):
    """A keyboard."""
    b.box("keys", 0.21, 0.07, 0.02)


@piece("tv")
def television(b: Builder):
    """A television on its foot."""
    x = b.uniform(0.45, 0.62)
    b.box("television body", 0.25, 0.10, 0.02)
    b.box("television body", 0.04, 0.02, (0.02, 0.10))
    b.box("television body", x, 0.025, (0.06, 0.06 + 1.15 * x))
    b.box("television screen", x - 0.01, (-0.029, -0.025), (0.07, 0.05 + 1.15 * x))


@piece("tv", name="television", on_wall=True)
def wall_television(b: Builder):
    """A television mounted on the wall."""
    x = b.uniform(0.45, 0.62)
    high = 1.0 + 1.15 * x
    b.box("television body", x, (-0.06, 0.0), (1.0, high))
    b.box("television screen", x - 0.01, (-0.064, -0.06), (1.01, high - 0.01))


@piece("potted plant")
def plant(b: Builder):
    """A pot, a stem and clumps of leaves."""
    height = 1.1
    wide = 0.16 * (0.5 + 0.5 * height)
    b.box("clay", wide, wide, 0.28 * height, shape="cone")
    b.cylinder("stem", 0.015, (0.28 * height, 0.6 * height))
    for k in range(7):
        shade, leaf = b.uniform(0.7, 1.6), b.palette["leaf"]
        red, green, blue = leaf.colour
        turn, out = 2 * np.pi * k / 7 + b.uniform(-0.3, 0.3), 0.10 * height
        x, y, z = float(out * np.cos(turn)), float(out * np.sin(turn)), height * (0.48 + 0.08 * (k % 4))
        size = height * b.uniform(0.10, 0.15)
        leaf = replace(leaf, colour=(red * shade, green * shade, blue * shade))
        b.rounded(leaf, (x - size, x + size), (y - size, y + size), (z - 0.8 * size, z + 0.9 * size))


@piece("light")
def floor_lamp(b: Builder):
    """A foot, a rod and a luminous shade."""
    b.cylinder("metal", 0.13, 0.025)
    b.cylinder("metal", 0.012, (0.025, 1.45))
    b.box("large shade", 0.19, 0.19, (1.38, 1.64), shape="cone")


@piece("light")
def table_lamp(b: Builder):
    """A small lamp with a luminous shade."""
    b.cylinder("metal", 0.06, 0.02)
    b.cylinder("metal", 0.015, (0.02, 0.28))
    b.box("small shade", 0.11, 0.11, (0.22, 0.40), shape="cone")


@piece("cup")
def cup(b: Builder):
    """A mug."""
    _, green, blue = b.palette["china"].colour
    b.cylinder(replace(b.palette["china"], colour=(b.uniform(0.2, 0.7), green, blue)), 0.04, 0.10)


@piece("book")
def books(b: Builder):
    """A small pile of books."""
    b.box("red book", 0.12, 0.09, 0.025)
    b.box("white book", (-0.10, 0.11), 0.08, (0.025, 0.045))
    b.box("blue book", (-0.11, 0.10), (-0.085, 0.08), (0.045, 0.08))


@piece("bowl")
def bowl(b: Builder):
    """A bowl with fruit."""
    b.cylinder("bowl", 0.12, 0.06)
    b.rounded("fruit", (-0.09, 0.0), (-0.05, 0.04), (0.05, 0.14))
    b.rounded("fruit", (0.0, 0.09), (-0.03, 0.06), (0.05, 0.14))


@piece("microwave")
def microwave(b: Builder):
    """A microwave oven."""
    b.box("grey steel", 0.24, (-0.17, 0.18), 0.28)
    b.box("dark glass", (-0.22, 0.10), (-0.175, -0.17), (0.03, 0.25))


@piece()
def instrument(b: Builder):
    """A laboratory instrument: a grey box with a small screen."""
    wide, high = b.uniform(0.16, 0.24), b.uniform(0.16, 0.30)
    b.box("instrument", wide, (-0.16, 0.18), high)
    b.box("instrument screen", (-wide + 0.03, 0.02), (-0.165, -0.16), (0.05, high - 0.03))


@piece("cardboard")
def carton(b: Builder):
    """A cardboard box."""
    x, y, z = b.uniform(0.18, 0.28), b.uniform(0.15, 0.24), b.uniform(0.25, 0.42)
    b.box("cardboard", x, y, z)
    b.box("tape", 0.03, y, (z, z + 0.002))


@piece()
def bin(b: Builder):
    """A wastepaper bin."""
    b.box("dark", 0.13, 0.13, 0.32, shape="cone")


@piece("rug", is_free=True)
def rug(b: Builder):
    """A rug, flat enough to walk on."""
    b.box("accent", 0.9, 0.6, 0.012)


@piece("rug", is_free=True)
def mat(b: Builder):
    """An exercise mat."""
    b.box("foam", 0.32, 0.9, 0.015)


# On walls -----------------------------------------------------------------------------------------------------------
@piece(on_wall=True)
def picture(b: Builder):
    """A framed picture."""
    x, z = b.uniform(0.22, 0.45), b.uniform(0.18, 0.32)
    b.box("dark_wood", x, (-0.025, 0.0), (1.5 - z, 1.5 + z))
    b.box("print", x - 0.03, (-0.028, -0.025), (1.53 - z, 1.47 + z))


@piece(on_wall=True)
def whiteboard(b: Builder, width_m: Size = (1.2, 1.8)):
    """A whiteboard with scribbles."""
    x = b.size(width_m) / 2
    b.box("metal", x, (-0.03, 0.0), (0.95, 1.95))
    b.box("enamel", x - 0.03, (-0.034, -0.03), (0.98, 1.92))
    b.box("metal", x - 0.1, (-0.08, -0.03), (0.93, 0.96))


@piece("cabinet", on_wall=True)
def wall_cabinet(b: Builder, width_m: float):
    """A cabinet above a counter."""
    x, count = width_m / 2, max(2, round(width_m / 0.45))
    b.box("white", x, (-0.33, 0.0), (1.45, 2.05))
    for k in range(count):
        start = -x + k * width_m / count
        end = start + width_m / count
        b.box("white", (start + 0.006, end - 0.006), (-0.348, -0.33), (1.46, 2.04))
        b.box("metal", (end - 0.05, end - 0.036), (-0.365, -0.348), (1.48, 1.60))


@piece("mirror-stuff", on_wall=True)
def mirror(b: Builder):
    """A tall mirror: depth cameras measure nothing there."""
    b.box("metal", 0.5, (-0.02, 0.0), (0.4, 2.0))
    b.box("mirror", 0.48, (-0.024, -0.02), (0.42, 1.98))


@piece("door-stuff", landmark="door", on_wall=True)
def door(b: Builder):
    """A closed door: leaf, frame and handle."""
    x, high = b.uniform(0.8, 0.95) / 2, 2.03
    leaf = replace(b.palette["wood"], pattern="upright") if b.chance(0.6) else b.palette["white"]
    side = 1.0 if b.chance(0.5) else -1.0
    at = side * (x - 0.08)
    b.box(leaf, x, (-0.025, 0.0), high)
    b.box("white", (-x - 0.07, -x), (-0.04, 0.0), high + 0.07)
    b.box("white", (x, x + 0.07), (-0.04, 0.0), high + 0.07)
    b.box("white", x, (-0.04, 0.0), (high, high + 0.07))
    b.box(leaf, x - 0.14, (-0.032, -0.025), (1.15, 1.85))
    b.box(leaf, x - 0.14, (-0.032, -0.025), (0.2, 0.95))
    b.box("metal", (min(at, at - 0.12 * side), max(at, at - 0.12 * side)), (-0.075, -0.06), (1.03, 1.05))
    b.box("metal", (at - 0.012, at + 0.012), (-0.075, -0.025), (1.02, 1.06))


@piece("window-other", landmark="window", on_wall=True)
def window(b: Builder):
    """A bright pane in a frame with a sill, sometimes with curtains."""
    x, low, high = b.uniform(1.1, 1.7) / 2, 0.92, 2.12
    b.box("window pane", x, (-0.012, 0.0), (low, high))
    for a in (-x - 0.06, -0.03, x):
        b.box("window frame", (a, a + 0.06), (-0.05, 0.0), (low - 0.06, high + 0.06))
    for z in (low - 0.06, high):
        b.box("window frame", x, (-0.05, 0.0), (z, z + 0.06))
    b.box("window frame", x + 0.08, (-0.14, 0.0), (low - 0.09, low - 0.06))
    if b.chance(0.5):
        for a in (-x - 0.34, x + 0.04):
            for k in range(5):
                start = a + 0.06 * k
                b.box("cloth", (start, start + 0.06), (-0.20, -0.15), (0.05, 2.26), "curtain", "cylinder")
        b.box("metal", x + 0.36, (-0.19, -0.16), (2.26, 2.285), "curtain")
        for a in (-x - 0.36, x + 0.33):
            b.box("metal", (a, a + 0.03), (-0.19, 0.0), (2.26, 2.285), "curtain")


@piece("light", on_wall=True)
def ceiling_lamp(b: Builder):
    """A flat panel below the ceiling; its origin is on the ceiling."""
    b.box("light panel", 0.3, 0.3, (-0.04, 0.0))
