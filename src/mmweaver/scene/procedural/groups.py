"""Groups of furniture. The origin of a group is on the floor at the wall behind it, its front towards -y.

Groups for the middle of a room have their origin at their own middle.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.scene.procedural.furniture import Span, make_piece
from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import OVERLAP_M, Piece, PlacedPiece, bounding_boxes

WALL, BACK, MIDDLE = "wall", "back", "middle"
_MAX_DRAWS = 20
GAP_M = 0.02  # between furniture and the wall behind it


@dataclass(frozen=True, kw_only=True)
class FurnitureGroup:
    """Pieces in the group's own frame, and where in a room the group may stand."""

    items: tuple[PlacedPiece, ...]
    site: str = WALL  # wall (any), back, middle


class GroupBuilder:
    """Collects pieces in a group's frame; random places are sampled from `rng` in the order of the calls."""

    def __init__(self, palette: Palette, rng: np.random.Generator):
        self.palette, self.rng = palette, rng
        self.items: list[PlacedPiece] = []

    def uniform(self, low: float, high: float) -> float:
        """A random length, metres, or angle, degrees."""
        return float(self.rng.uniform(low, high))

    def make(self, name: str, **sizes: Any) -> Piece:
        """A piece by its name, not yet placed."""
        return make_piece(name, self.palette, self.rng, **sizes)

    def put(
        self, piece: str | Piece, x: Span = 0.0, y: Span = 0.0, z: float = 0.0, turn: Span = 0.0, sway: float = 0.0
    ) -> PlacedPiece:
        """Places a piece, or makes it first by its name; ranges are sampled afterwards.

        Args:
            piece: the piece or its name.
            x, y, z: its place in the group's frame, metres.
            turn: counterclockwise, degrees.
            sway: greatest random deviation from that.
        """
        piece = self.make(piece) if isinstance(piece, str) else piece
        x, y, turn = (self.uniform(*v) if isinstance(v, tuple) else v for v in (x, y, turn))
        turn += self.uniform(-sway, sway) if sway else 0.0
        item = PlacedPiece(piece=piece, x_m=float(x), y_m=float(y), z_m=float(z), yaw_rad=float(np.deg2rad(turn)))
        self.items.append(item)
        return item

    def at_wall(self, piece: str | Piece, x: float = 0.0) -> PlacedPiece:
        """Places a piece with its back close to the wall."""
        piece = self.make(piece) if isinstance(piece, str) else piece
        return self.put(piece, x, -float(piece.high_m[1]) - GAP_M)


GROUPS: dict[str, tuple[Callable[[GroupBuilder], Any], str]] = {}


def group(site: str = WALL) -> Callable:
    """Registers the function that builds a group, under its own name."""

    def register(build: Any) -> Any:
        GROUPS[build.__name__.replace("_", " ")] = build, site
        return build

    return register


def sample_group(name: str, palette: Palette, rng: np.random.Generator) -> FurnitureGroup:
    """Samples a group, or a single piece, by its name until its pieces do not penetrate each other."""
    for _ in range(_MAX_DRAWS):
        builder = GroupBuilder(palette, rng)
        if name in GROUPS:
            build, site = GROUPS[name]
            build(builder)
        else:
            piece = builder.make(name)
            (builder.put if piece.on_wall or piece.is_free else builder.at_wall)(piece)
            site = MIDDLE if piece.is_free else WALL
        boxes = bounding_boxes(builder.items)
        number = np.array(boxes.piece)
        if not (boxes.overlap(boxes, OVERLAP_M) & (number[:, None] != number[None, :])).any():
            return FurnitureGroup(items=tuple(builder.items), site=site)
    raise RuntimeError(f"the pieces of {name!r} always overlap")


# Work ---------------------------------------------------------------------------------------------------------------
@group()
def desk_place(g: GroupBuilder):
    """Desk with monitor, keyboard and cup, and an office chair."""
    desk = g.make("desk", width=(1.2, 1.6))
    y, top, half = g.at_wall(desk).y_m, desk.top_m, float(desk.high_m[0])
    screen = g.put("monitor", (-0.1, 0.2), y + 0.14, top)
    g.put("keyboard", screen.x_m, y - 0.16, top)
    g.put("cup", -half + 0.18, y - 0.05, top)
    if g.rng.random() < 0.5:
        g.put("books", half - 0.22, y + 0.05, top)
    away = float(-desk.low_m[1]) + g.uniform(0.22, 0.42)
    g.put("office chair", (-0.08, 0.12), y - away, turn=180.0, sway=35.0)


@group()
def laptop_desk(g: GroupBuilder):
    """Desk with laptop and lamp, and a plain chair."""
    desk = g.make("desk", width=(1.0, 1.25))
    y, top = g.at_wall(desk).y_m, desk.top_m
    away = float(-desk.low_m[1]) + g.uniform(0.24, 0.4)
    g.put("laptop", 0.0, y - 0.08, top)
    g.put("table lamp", float(desk.low_m[0]) + 0.16, y + 0.12, top)
    g.put("chair", (-0.1, 0.1), y - away, turn=180.0, sway=15.0)


@group()
def lab_bench_place(g: GroupBuilder):
    """Laboratory bench with instruments and a stool."""
    bench = g.make("lab bench", width=(1.5, 2.1))
    y, half = g.at_wall(bench).y_m, float(bench.high_m[0])
    g.put("instrument", -half + 0.4, y - 0.05, 0.90)
    g.put("monitor", half - 0.45, y + 0.02, 0.90)
    g.put("stool", (-0.4, 0.4), y - 0.62, turn=(0.0, 40.0))


@group()
def workbench_place(g: GroupBuilder):
    """Workbench with a carton, and a stool."""
    bench = g.make("workbench", width=(1.4, 1.8))
    y = g.at_wall(bench).y_m
    g.put("carton", -0.3, y - 0.03, bench.parts[4].high_m[2])
    g.put("stool", (0.0, 0.4), y - 0.62)


@group(MIDDLE)
def meeting_place(g: GroupBuilder):
    """A long table with chairs on both sides, laptops on it."""
    table = g.put("meeting table").piece
    g.put("laptop", -0.3, -0.15, table.top_m)
    quarter, out = float(table.high_m[0]) / 2, float(table.high_m[1]) + 0.30
    for x in (-quarter, quarter):
        for side, turn in ((-1, 180.0), (1, 0.0)):
            g.put("office chair", x, side * (out + g.uniform(0.0, 0.1)), turn=turn, sway=15.0)


@group(MIDDLE)
def pupils_place(g: GroupBuilder):
    """A school table for two with two chairs, facing the wall behind it."""
    table = g.put("school table").piece
    g.put("books", -0.3, 0.0, table.top_m)
    for x in (-0.33, 0.33):
        chair = g.make("chair")
        g.put(chair, x, -0.52 - g.uniform(0.0, 0.1), turn=180.0, sway=12.0)


@group(BACK)
def teacher_place(g: GroupBuilder):
    """A whiteboard with a desk in front of it."""
    desk, y = g.make("desk", width=1.3), -1.25
    g.put(g.make("whiteboard", width=2.0))
    g.put(desk, 0.9, y, turn=180.0)
    g.put("laptop", 0.9, y, desk.top_m, turn=180.0)
    g.put("chair", 0.9, y + 0.68)


# Home ---------------------------------------------------------------------------------------------------------------
@group()
def sofa_place(g: GroupBuilder):
    """A sofa with a coffee table, often with a floor lamp."""
    sofa = g.make("sofa")
    front = g.at_wall(sofa).y_m + float(sofa.low_m[1])
    table = g.make("coffee table")
    y = front - 0.42 - float(table.high_m[1])
    x = g.put(table, (-0.2, 0.2), y).x_m
    g.put("books", x + 0.1, y, table.top_m)
    if g.rng.random() < 0.7:
        side = 1 if g.rng.random() < 0.5 else -1
        g.put("floor lamp", side * (float(sofa.high_m[0]) + 0.26), -0.30)


@group()
def armchair_place(g: GroupBuilder):
    """An armchair at a small angle to the wall."""
    g.put("armchair", 0.0, -0.62, sway=20.0)


@group()
def television_place(g: GroupBuilder):
    """A low sideboard with a television."""
    g.put("television", 0.0, g.at_wall("sideboard").y_m + 0.02, 0.48)


@group()
def bed_place(g: GroupBuilder):
    """Bed and nightstands with lamps."""
    bed = g.at_wall("bed").piece
    for side in (-1, 1):
        if side > 0 or g.rng.random() < 0.6:
            x = side * (float(bed.high_m[0]) + 0.25)
            g.put("table lamp", x, g.at_wall("nightstand", x).y_m, 0.48)


@group(MIDDLE)
def dining_place(g: GroupBuilder):
    """A dining table with a bowl and four chairs."""
    table = g.put("dining table").piece
    g.put("bowl", (-0.2, 0.2), 0.0, table.top_m)
    for x in (-0.33, 0.33):
        for side, turn in ((-1, 180.0), (1, 0.0)):
            g.put("chair", x, side * (float(table.high_m[1]) + g.uniform(0.17, 0.34)), turn=turn, sway=8.0)


@group(MIDDLE)
def small_dining_place(g: GroupBuilder):
    """A small table and two chairs."""
    table = g.put("small dining table").piece
    g.put("cup", 0.15, 0.1, table.top_m)
    for side, turn in ((-1, 90.0), (1, -90.0)):
        g.put("chair", side * (0.4 + g.uniform(0.2, 0.36)), (-0.1, 0.1), turn=turn, sway=20.0)


@group()
def kitchen_row(g: GroupBuilder):
    """Counter, cooker, refrigerator, cabinets above."""
    counter, oven, fridge = g.make("counter", width=(1.4, 1.9)), g.make("oven"), g.make("refrigerator")
    width = 2 * float(counter.high_m[0])
    left = -(width + 0.6 + 0.62) / 2
    x = g.at_wall(counter, left + width / 2).x_m
    g.at_wall(oven, left + width + 0.31)
    g.at_wall(fridge, left + width + 0.62 + 0.31)
    g.put(g.make("wall cabinet", width=width - 0.2), x)
    sink = counter.parts[3]
    away = 0.28 - width / 2 if sink.low_m[0] + sink.high_m[0] > 0 else width / 2 - 0.28  # the end without the sink
    g.put("microwave", x + away, -0.22, 0.91)


@group()
def counter_place(g: GroupBuilder):
    """A counter with cabinets above."""
    counter = g.at_wall(g.make("counter", width=(1.2, 1.6))).piece
    g.put(g.make("wall cabinet", width=2 * float(counter.high_m[0])))


def _bookcases(g: GroupBuilder, count: int):
    width, height = g.uniform(0.75, 0.95), g.uniform(1.7, 2.1)
    cases = [g.make("bookcase", width=width, height=height) for _ in range(count)]
    start = -(count - 1) * (width + 0.005) / 2
    for k, case in enumerate(cases):
        g.at_wall(case, start + k * (width + 0.005))


@group()
def bookcases(g: GroupBuilder):
    """One bookcase."""
    _bookcases(g, 1)


@group()
def two_bookcases(g: GroupBuilder):
    """A row of two."""
    _bookcases(g, 2)


@group()
def three_bookcases(g: GroupBuilder):
    """A row of three."""
    _bookcases(g, 3)


@group()
def treadmill_place(g: GroupBuilder):
    """A treadmill with its front towards the room."""
    g.put("treadmill", 0.0, -0.85)
