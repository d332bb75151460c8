"""Builds a piece of furniture from solids, with random sizes."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mmweaver.scene.procedural.palette import Palette
from mmweaver.scene.procedural.parts import Appearance, LocalSeat, Part, Piece

Extent = float | tuple[float, float]
Size = float | tuple[float, float]


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


BUILDERS: dict[str, Callable[..., Piece]] = {}


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
