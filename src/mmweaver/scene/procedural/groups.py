"""Groups of furniture. The origin of a group is on the floor at the wall behind it, its front towards -y.

Groups for the middle of a room have their origin at their own middle.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from mmweaver.scene.procedural import objects, seat_furniture, storage_furniture, table_furniture
from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import OVERLAP_M, Piece, PlacedPiece, bounding_boxes

WALL, BACK, MIDDLE = "wall", "back", "middle"
_MAX_DRAWS = 20
GAP_M = 0.02  # between furniture and the wall behind it


@dataclass(frozen=True, kw_only=True)
class FurnitureGroup:
    """Pieces in the group's own frame, and where in a room the group may stand."""

    items: tuple[PlacedPiece, ...]
    site: str = WALL  # wall (any), back, side, middle


Maker = Callable[[Palette, np.random.Generator], FurnitureGroup]


def at(piece: Piece, x: float | int, y: float | int, z: float = 0.0, turn_deg: float = 0.0) -> PlacedPiece:
    """A piece at a position in its group's frame."""
    return PlacedPiece(piece=piece, x_m=float(x), y_m=float(y), z_m=float(z), yaw_rad=float(np.deg2rad(turn_deg)))


def at_wall(piece: Piece, x: float = 0.0) -> PlacedPiece:
    """A piece with its back close to the wall."""
    return at(piece, x, -float(piece.high_m[1]) - GAP_M)


def _top_m(piece: Piece, lowest: float = 0.0) -> float:
    """Height of the surface for objects, metres: the highest box top larger than 0.1 m2."""
    areas = [
        part.high_m[2]
        for part in piece.parts
        if (part.high_m[0] - part.low_m[0]) * (part.high_m[1] - part.low_m[1]) > 0.1 and part.shape == "box"
    ]
    return max(top for top in areas if top > lowest)


def sample_group(make: Maker, palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Samples a group until its pieces do not penetrate each other."""
    for _ in range(_MAX_DRAWS):
        group = make(palette, rng)
        boxes = bounding_boxes(group.items)
        piece = np.array(boxes.piece)
        if not (boxes.overlap(boxes, OVERLAP_M) & (piece[:, None] != piece[None, :])).any():
            return group
    raise RuntimeError(f"the pieces of {group.items[0].piece.name!r} always overlap")


# Work ---------------------------------------------------------------------------------------------------------------
def desk_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Desk with monitor, keyboard and cup, and an office chair."""
    desk = table_furniture.desk(palette, rng, float(rng.uniform(1.2, 1.6)))
    wall = at_wall(desk)
    top, half = _top_m(desk), float(desk.high_m[0])
    items = [wall, at(objects.monitor(palette, rng), rng.uniform(-0.1, 0.2), wall.y_m + 0.14, top)]
    items.append(at(objects.keyboard(palette, rng), items[-1].x_m, wall.y_m - 0.16, top))
    items.append(at(objects.cup(palette, rng), -half + 0.18, wall.y_m - 0.05, top))
    if rng.random() < 0.5:
        items.append(at(objects.books(palette, rng), half - 0.22, wall.y_m + 0.05, top))
    away = float(-desk.low_m[1]) + rng.uniform(0.22, 0.42)
    items.append(
        at(
            seat_furniture.office_chair(palette, rng),
            rng.uniform(-0.08, 0.12),
            wall.y_m - away,
            0.0,
            180 + rng.uniform(-35, 35),
        )
    )
    return FurnitureGroup(items=tuple(items))


def laptop_desk(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Desk with laptop and lamp, and a plain chair."""
    desk = table_furniture.desk(palette, rng, float(rng.uniform(1.0, 1.25)))
    wall, top = at_wall(desk), _top_m(desk)
    away = float(-desk.low_m[1]) + rng.uniform(0.24, 0.4)
    items = (
        wall,
        at(objects.laptop(palette, rng), 0.0, wall.y_m - 0.08, top),
        at(objects.table_lamp(palette, rng), float(desk.low_m[0]) + 0.16, wall.y_m + 0.12, top),
        at(
            seat_furniture.chair(palette, rng), rng.uniform(-0.1, 0.1), wall.y_m - away, 0.0, 180 + rng.uniform(-15, 15)
        ),
    )
    return FurnitureGroup(items=items)


def bench_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Laboratory bench with instruments and a stool."""
    made = table_furniture.lab_bench(palette, rng, float(rng.uniform(1.5, 2.1)))
    wall, half = at_wall(made), float(made.high_m[0])
    items = [wall, at(objects.instrument(palette, rng), -half + 0.4, wall.y_m - 0.05, 0.90)]
    items.append(at(objects.monitor(palette, rng), half - 0.45, wall.y_m + 0.02, 0.90))
    items.append(
        at(seat_furniture.stool(palette, rng), rng.uniform(-0.4, 0.4), wall.y_m - 0.62, 0.0, rng.uniform(0, 40))
    )
    return FurnitureGroup(items=tuple(items))


def workbench_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Workbench with a carton, and a stool."""
    made = table_furniture.workbench(palette, rng, float(rng.uniform(1.4, 1.8)))
    wall = at_wall(made)
    top = float(made.parts[4].high_m[2])
    items = [wall, at(objects.carton(palette, rng), -0.3, wall.y_m - 0.03, top)]
    items.append(at(seat_furniture.stool(palette, rng), rng.uniform(0.0, 0.4), wall.y_m - 0.62))
    return FurnitureGroup(items=tuple(items))


def meeting_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A long table with chairs on both sides, laptops on it."""
    length = float(rng.uniform(1.5, 1.9))
    made = table_furniture.table(palette, rng, (length, float(rng.uniform(0.8, 0.95))), name="meeting table")
    items = [at(made, 0, 0), at(objects.laptop(palette, rng), -0.3, -0.15, _top_m(made))]
    out = float(made.high_m[1]) + 0.30
    for x in (-length / 4, length / 4):
        for side, turn in ((-1, 180.0), (1, 0.0)):
            y = side * (out + rng.uniform(0.0, 0.1))
            items.append(at(seat_furniture.office_chair(palette, rng), x, y, 0.0, turn + rng.uniform(-15, 15)))
    return FurnitureGroup(items=tuple(items), site=MIDDLE)


def pupils(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A school table for two with two chairs, facing the wall behind it."""
    made = table_furniture.table(palette, rng, (1.3, 0.55), name="school table")
    items = [at(made, 0, 0), at(objects.books(palette, rng), -0.3, 0.0, _top_m(made))]
    for x in (-0.33, 0.33):
        items.append(
            at(seat_furniture.chair(palette, rng), x, -0.52 - rng.uniform(0, 0.1), 0.0, 180 + rng.uniform(-12, 12))
        )
    return FurnitureGroup(items=tuple(items), site=MIDDLE)


def teacher(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A whiteboard with a desk in front of it."""
    made = table_furniture.desk(palette, rng, 1.3)
    y = -1.25
    items = (
        at(objects.whiteboard(palette, rng, 2.0), 0, 0),
        at(made, 0.9, y, 0.0, 180.0),
        at(objects.laptop(palette, rng), 0.9, y, _top_m(made), 180.0),
        at(seat_furniture.chair(palette, rng), 0.9, y + 0.68),
    )
    return FurnitureGroup(items=items, site=BACK)


def board(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A whiteboard alone."""
    return FurnitureGroup(items=(at(objects.whiteboard(palette, rng, float(rng.uniform(1.2, 1.8))), 0, 0),))


# Home ---------------------------------------------------------------------------------------------------------------
def sofa_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A sofa with a coffee table, often with a floor lamp."""
    made = seat_furniture.sofa(palette, rng, 2 + int(rng.random() < 0.45))
    wall = at_wall(made)
    front = wall.y_m + float(made.low_m[1])
    low = table_furniture.coffee_table(palette, rng)
    y = front - 0.42 - float(low.high_m[1])
    items = [wall, at(low, rng.uniform(-0.2, 0.2), y)]
    items.append(at(objects.books(palette, rng), items[1].x_m + 0.1, y, _top_m(low)))
    if rng.random() < 0.7:
        side = 1 if rng.random() < 0.5 else -1
        items.append(at(objects.floor_lamp(palette, rng), side * (float(made.high_m[0]) + 0.26), -0.30))
    return FurnitureGroup(items=tuple(items))


def armchair_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """An armchair at a small angle to the wall."""
    made = seat_furniture.armchair(palette, rng)
    return FurnitureGroup(items=(at(made, 0, -0.62, 0.0, rng.uniform(-20, 20)),))


def television_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A low sideboard with a television."""
    made = storage_furniture.cabinet(palette, rng, (float(rng.uniform(1.3, 1.7)), 0.40, 0.48), name="sideboard")
    wall = at_wall(made)
    return FurnitureGroup(items=(wall, at(objects.television(palette, rng), 0, wall.y_m + 0.02, 0.48)))


def television_on_wall(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A television mounted on the wall."""
    return FurnitureGroup(items=(at(objects.television(palette, rng, on_wall=True), 0, 0),))


def bed_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Bed and nightstands with lamps."""
    made = seat_furniture.bed(palette, rng)
    items = [at_wall(made)]
    for side in (-1, 1):
        if side > 0 or rng.random() < 0.6:
            stand = storage_furniture.nightstand(palette, rng)
            x = side * (float(made.high_m[0]) + 0.25)
            wall = at_wall(stand, x)
            items += [wall, at(objects.table_lamp(palette, rng), x, wall.y_m, 0.48)]
    return FurnitureGroup(items=tuple(items))


def dining_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A dining table with a bowl and four chairs."""
    size = (float(rng.uniform(1.2, 1.5)), float(rng.uniform(0.8, 0.95)))
    made = table_furniture.table(palette, rng, size, name="dining table")
    items = [at(made, 0, 0), at(objects.bowl(palette, rng), rng.uniform(-0.2, 0.2), 0.0, _top_m(made))]
    for x in (-0.33, 0.33):
        for side, turn in ((-1, 180.0), (1, 0.0)):
            y = side * (size[1] / 2 + rng.uniform(0.17, 0.34))
            items.append(at(seat_furniture.chair(palette, rng), x, y, 0.0, turn + rng.uniform(-8, 8)))
    return FurnitureGroup(items=tuple(items), site=MIDDLE)


def small_dining(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A small table and two chairs."""
    made = table_furniture.table(palette, rng, (0.8, 0.75), name="dining table")
    items = [at(made, 0, 0), at(objects.cup(palette, rng), 0.15, 0.1, _top_m(made))]
    for side, turn in ((-1, 90.0), (1, -90.0)):
        x = side * (0.4 + rng.uniform(0.2, 0.36))
        items.append(
            at(seat_furniture.chair(palette, rng), x, rng.uniform(-0.1, 0.1), 0.0, turn + rng.uniform(-20, 20))
        )
    return FurnitureGroup(items=tuple(items), site=MIDDLE)


def kitchen_row(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Counter, cooker, refrigerator, cabinets above."""
    width = float(rng.uniform(1.4, 1.9))
    made, cooker, cold = (
        table_furniture.counter(palette, rng, width),
        storage_furniture.oven(palette, rng),
        storage_furniture.fridge(palette, rng),
    )
    left = -(width + 0.6 + 0.62) / 2
    wall = at_wall(made, left + width / 2)
    items = [wall, at_wall(cooker, left + width + 0.31), at_wall(cold, left + width + 0.62 + 0.31)]
    items.append(at(objects.wall_cabinet(palette, rng, width - 0.2), wall.x_m, 0))
    sink = made.parts[3]
    away = 0.28 - width / 2 if sink.low_m[0] + sink.high_m[0] > 0 else width / 2 - 0.28  # the end without the sink
    items.append(at(objects.microwave(palette, rng), wall.x_m + away, -0.22, 0.91))
    return FurnitureGroup(items=tuple(items))


def kitchen_counter(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A counter with cabinets above."""
    width = float(rng.uniform(1.2, 1.6))
    wall = at_wall(table_furniture.counter(palette, rng, width))
    return FurnitureGroup(items=(wall, at(objects.wall_cabinet(palette, rng, width), 0, 0)))


# One piece at a wall -------------------------------------------------------------------------------------------------
def single(make: Callable[[Palette, np.random.Generator], Piece], site: str = WALL) -> Maker:
    """A group of one piece with its back at the wall."""
    return lambda palette, rng: FurnitureGroup(items=(at_wall(make(palette, rng)),), site=site)


def on_wall_group(make: Callable[[Palette, np.random.Generator], Piece]) -> Maker:
    """A group of one piece mounted on a wall."""
    return lambda palette, rng: FurnitureGroup(items=(at(make(palette, rng), 0, 0),))


def freestanding(make: Callable[[Palette, np.random.Generator], Piece]) -> Maker:
    """A group of one piece in the open."""
    return lambda palette, rng: FurnitureGroup(items=(at(make(palette, rng), 0, 0),), site=MIDDLE)


def shelves(count: int) -> Maker:
    """A row of bookcases."""

    def make(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
        width = float(rng.uniform(0.75, 0.95))
        height = float(rng.uniform(1.7, 2.1))
        cases = [storage_furniture.bookcase(palette, rng, width, height) for _ in range(count)]
        start = -(count - 1) * (width + 0.005) / 2
        return FurnitureGroup(items=tuple(at_wall(case, start + k * (width + 0.005)) for k, case in enumerate(cases)))

    return make


def treadmill_place(palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """A treadmill with its front towards the room."""
    return FurnitureGroup(items=(at(objects.treadmill(palette, rng), 0, -0.85),))
