"""Builds the furniture of procedural rooms from the records of furniture.toml."""

import ast
import operator
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from mmweaver.scene.procedural.palette import COLOURS, Palette, read_tables
from mmweaver.scene.procedural.parts import Appearance, LocalSeat, Part, Piece

Span = float | tuple[float, float]

RECORDS = read_tables("furniture.toml")
_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    "min": min,
    "max": max,
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_FLAGS = ("landmark", "on_wall", "is_free")


def make_piece(name: str, palette: Palette, rng: np.random.Generator, **sizes: Any) -> Piece:
    """Makes a piece of furniture from its record.

    Args:
        name: Name of the record.
        palette: Surfaces by name; those without a class take the piece's.
        rng: Random stream of the sizes, sampled in the order of the record.
        **sizes: Replace those of the record; a pair is a range.

    Returns:
        The piece in its own frame.
    """
    record: dict[str, Any] = RECORDS[name]
    if "form" in record:
        form = RECORDS[record["form"]]
        record = form | record | {"sizes": form["sizes"] | record["sizes"]}
    builder = Builder(palette, rng, record.get("class", "furniture-other"))
    known = builder.sampled(record.get("sizes", {}) | sizes)
    for surface, *spans, options in ((*row, {}) if len(row) == 4 else row for row in record["parts"]):
        if evaluate(options.get("if", True), known):
            repeat = REPEATS[options.get("repeat", "box")]
            own = {key: options[key] for key in options if key not in ("if", "repeat")}
            own |= {key: known.get(own[key], own[key]) for key in ("shape", "count") if key in own}
            repeat(builder, known.get(surface, surface), *(evaluate(span, known) for span in spans), **own)
    seats = [LocalSeat(*(float(evaluate(number, known)) for number in row)) for row in record.get("seats", ())]
    return Piece(
        name=record.get("called", name),
        parts=tuple(builder.parts),
        seats=(*seats, *builder.seats),
        sizes=known,
        **{flag: record[flag] for flag in _FLAGS if flag in record},
    )


def evaluate(formula: Any, sizes: dict[str, Any]) -> Any:
    """A number or a range (as they are), or the value of a formula: numbers, sizes, + - * /, min, max.

    Raises ValueError for a formula that has anything else, or no value.
    """
    if isinstance(formula, tuple):
        return tuple(evaluate(part, sizes) for part in formula)
    if not isinstance(formula, str):
        return formula
    try:
        return _value(_parsed(formula), sizes)
    except (SyntaxError, TypeError, KeyError, ZeroDivisionError):
        raise ValueError(
            f"no value for {formula!r}: a formula has numbers, + - * /, min, max and {', '.join(sizes)}"
        ) from None


@cache
def _parsed(formula: str) -> ast.expr:
    return ast.parse(formula, mode="eval").body


def _value(node: ast.expr, sizes: dict[str, Any]) -> Any:
    match node:
        case ast.Constant(value=int() | float() as number):
            return number
        case ast.Name(id=name):
            return sizes[name]
        case ast.UnaryOp(op=ast.USub(), operand=of):
            return -_value(of, sizes)
        case ast.BinOp(left=left, op=op, right=right):
            return _FUNCTIONS[type(op)](_value(left, sizes), _value(right, sizes))
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            return _FUNCTIONS[name](*(_value(each, sizes) for each in args))
    raise TypeError(f"{ast.unparse(node)} is not arithmetic")


class Builder:
    """Collects the parts and seats of a piece of furniture.

    Args:
        palette: Surfaces by name.
        rng: Random stream, consumed in the order of the calls.
        coco: COCO-Stuff class of parts whose surface has none.
    """

    def __init__(self, palette: Palette, rng: np.random.Generator, coco: str):
        self.palette, self.rng, self.coco = palette, rng, coco
        self.parts: list[Part] = []
        self.seats: list[LocalSeat] = []

    def sampled(self, sizes: dict[str, Any]) -> dict[str, Any]:
        """Samples the sizes of a record.

        Args:
            sizes: Number, range, formula of earlier sizes, or table with a probability `share`, by name.

        Returns:
            The sampled sizes by name.
        """
        known: dict[str, Any] = {}
        for name, size in sizes.items():
            if isinstance(size, dict):
                is_so = "share" not in size or self.chance(size["share"])
                known[name] = size.get("yes", True) if is_so else size.get("no", False)
            else:
                value = evaluate(size, known)
                known[name] = self.uniform(*value) if isinstance(value, tuple) else value
        return known

    def uniform(self, low: float, high: float) -> float:
        """Samples a length in metres uniformly."""
        return float(self.rng.uniform(low, high))

    def chance(self, share: float) -> bool:
        """Samples True with probability `share`."""
        return bool(self.rng.random() < share)

    def box(self, surface: str | Appearance, x: Span, y: Span, z: Span, shape: str = "box", **options: str):
        """Adds a solid inscribed in a box.

        Args:
            surface: Appearance, or its name in the palette.
            x: From and to, metres; a single number is half the size of a centred solid.
            y: As `x`.
            z: From and to, metres; a single number is the height of a solid on the floor.
            shape: "box", "rounded", "cylinder" or "cone".
            **options: `class` if it differs from the piece's.
        """
        (x0, x1), (y0, y1) = (a if isinstance(a, tuple) else (-a, a) for a in (x, y))
        z0, z1 = z if isinstance(z, tuple) else (0.0, z)
        look = self.palette[surface] if isinstance(surface, str) else surface
        look = replace(look, coco=options.get("class") or look.coco or self.coco)
        self.parts.append(Part((x0, y0, z0), (x1, y1, z1), look, shape))


# Repeated parts: each builds the row of furniture.toml that names it under `repeat`.
def _legs(b: Builder, surface: str, x: float, y: Span, height: float, thick: float):
    """Four legs at the corners of a rectangle, inside it."""
    y0, y1 = y if isinstance(y, tuple) else (-y, y)
    for a in (-x, x - thick):
        for c in (y0, y1 - thick):
            b.box(surface, (a, a + thick), (c, c + thick), height)


def _cushions(b: Builder, surface: str, half: float, y: float, heights: tuple[float, float], count: int):
    """Cushions to sit on and to lean against, side by side, often with a pillow; one seat each."""
    height, back = heights
    each = (2 * half - 0.36) / count
    for k in range(count):
        start = -half + 0.18 + k * each
        across = (start + 0.004, start + each - 0.004)
        b.box(surface, across, (-y, y - 0.22), (height - 0.16, height), "rounded")
        b.box(surface, across, (y - 0.27, y - 0.07), (height - 0.02, back), "rounded")
        b.seats.append(LocalSeat(start + each / 2, -y + 0.32, height, each, 2 * y - 0.27))
    if count > 1 and b.chance(0.7):
        x = -half + 0.22 + b.uniform(0.0, 0.1)
        pillow = (x, x + 0.38), (y - 0.40, y - 0.26), (height - 0.005, height + 0.34)
        b.box("accent", *pillow, "rounded", **{"class": "pillow"})


def _fronts(b: Builder, surface: str, x: float, front: float, heights: tuple[float, float]):
    """Door fronts with handles across the top."""
    high = heights[1]
    count = max(2, round(2 * x / 0.5))
    each = 2 * x / count
    for k in range(count):
        start = -x + k * each
        b.box(surface, (start + 0.006, start + each - 0.006), (front - 0.014, front), heights)
        middle = start + each / 2
        b.box("metal", (middle - 0.07, middle + 0.07), (front - 0.034, front - 0.014), (high - 0.08, high - 0.065))


def _wall_doors(b: Builder, surface: str, x: float, y: tuple[float, float], z: tuple[float, float]):
    """Doors of a cabinet on a wall, with upright handles."""
    count = max(2, round(2 * x / 0.45))
    for k in range(count):
        start = -x + k * (2 * x) / count
        end = start + 2 * x / count
        b.box(surface, (start + 0.006, end - 0.006), y, z)
        b.box("metal", (end - 0.05, end - 0.036), (-0.365, y[0]), (1.48, 1.60))


def _doors(b: Builder, surface: str, x: float, front: float, height: float):
    """Doors of a cabinet on the floor."""
    count = max(1, round(2 * x / 0.5))
    for k in range(count):
        each = 2 * x / count
        start = -x + k * each
        b.box(surface, (start + 0.006, start + each - 0.006), (front, front + 0.02), (0.075, height - 0.012))
        at, middle = start + (each - 0.05 if k % 2 == 0 else 0.035), 0.55 * height
        b.box("metal", (at, at + 0.015), (front - 0.02, front), (middle - 0.07, middle + 0.07))


def _drawers(b: Builder, surface: str, x: float, front: float, height: float, count: int):
    for k in range(count):
        each = (height - 0.09) / count
        low = 0.075 + k * each
        b.box(surface, x - 0.01, (front, front + 0.02), (low, low + each - 0.012))
        b.box("metal", 0.06, (front - 0.02, front), (low + each * 0.6, low + each * 0.6 + 0.014))


def _tools(b: Builder, surface: str, x: float, y: tuple[float, float], top: float, count: int):
    """Tools that hang on a pegboard."""
    for k in range(count):
        start = -x + 0.18 + k * (2 * x - 0.3) / count
        b.box(surface, (start, start + 0.05), y, (top - b.uniform(0.18, 0.38), top))


def _bookshelves(b: Builder, surface: str, x: float, y: float, height: float):
    """Shelves with rows of books of different heights."""
    count = max(2, round(height / 0.36))
    each = height / count
    for k in range(count + 1):
        foot = min(k * each, height - 0.02)
        b.box(surface, x - 0.02, (-y, y - 0.01), (foot, foot + 0.02))
        if k == count:
            break
        at, back, room = -(x - 0.025), y - 0.012, each - 0.04
        end = -at - (0.0 if b.chance(0.6) else b.uniform(0.1, 0.3))
        while at + (width := b.uniform(0.05, 0.14)) <= end:
            high, deep = b.uniform(0.62, 0.95) * room, b.uniform(0.14, 0.20)
            colour = COLOURS["spines"][int(b.rng.integers(len(COLOURS["spines"])))]
            spine = replace(b.palette["spine"], colour=colour)
            b.box(spine, (at, at + width), (back - deep, back), (foot + 0.02, foot + 0.02 + high))
            at += width + (0.0 if b.chance(0.85) else b.uniform(0.03, 0.12))


def _loaded_shelves(b: Builder, surface: str, x: float, y: float, thick: float, count: int):
    """Shelves with boxes on them."""
    for k in range(count):
        foot = 0.12 + k * 0.53
        b.box(surface, x, y, (foot, foot + thick))
        at = -x + 0.05
        while at < x - 0.35:
            width = b.uniform(0.18, 0.32)
            if b.chance(0.75):
                high = b.uniform(0.12, 0.32) if k < count - 1 else 0.02
                b.box("cardboard", (at, at + width), (-y + 0.03, y - 0.05), (foot + thick, foot + thick + high))
            at += width + 0.03


def _dumbbells(b: Builder, surface: str, x: float, front: float, foot: float, row: int, **options: str):
    for k in range(4):
        at, wide = x - 0.46 + k * 0.27, 0.05 + 0.012 * k + 0.01 * row
        y, z = (front + 0.02, front + 0.18), (foot + 0.03, foot + 0.03 + 2 * wide)
        b.box(surface, (at - wide, at + wide), y, z, "rounded", **options)


def _leaves(b: Builder, surface: str, x: float, y: float, height: float, count: int):
    """Clumps of leaves of different shades around a stem."""
    for k in range(count):
        shade, leaf = b.uniform(0.7, 1.6), b.palette[surface]
        red, green, blue = leaf.colour
        turn, out = 2 * np.pi * k / count + b.uniform(-0.3, 0.3), 0.10 * height
        x, y, z = float(out * np.cos(turn)), float(out * np.sin(turn)), height * (0.48 + 0.08 * (k % 4))
        size = height * b.uniform(0.10, 0.15)
        leaf = replace(leaf, colour=(red * shade, green * shade, blue * shade))
        b.box(leaf, (x - size, x + size), (y - size, y + size), (z - 0.8 * size, z + 0.9 * size), "rounded")


def _glazed(b: Builder, surface: str, x: float, y: float, z: float):
    """A cylinder whose glaze has its own red."""
    _, green, blue = b.palette[surface].colour
    b.box(replace(b.palette[surface], colour=(b.uniform(0.2, 0.7), green, blue)), x, y, z, "cylinder")


def _curtains(b: Builder, surface: str, x: float, y: Span, z: Span, **options: str):
    for a in (-x - 0.34, x + 0.04):
        for k in range(5):
            start = a + 0.06 * k
            b.box(surface, (start, start + 0.06), y, z, "cylinder", **options)


REPEATS: dict[str, Callable[..., None]] = {
    "box": Builder.box,
    **{
        build.__name__.strip("_"): build
        for build in (
            _legs,
            _cushions,
            _fronts,
            _wall_doors,
            _doors,
            _drawers,
            _tools,
            _bookshelves,
            _loaded_shelves,
            _dumbbells,
            _leaves,
            _glazed,
            _curtains,
        )
    },
}
