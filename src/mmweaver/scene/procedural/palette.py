"""The surfaces of a room by name: fixed ones, and woods, fabrics, paints, walls and floor sampled from its seed."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.scene.procedural.parts import Appearance


def _frozen(value: Any) -> Any:
    """Converts lists to tuples recursively."""
    if isinstance(value, dict):
        return {key: _frozen(inner) for key, inner in value.items()}
    return tuple(map(_frozen, value)) if isinstance(value, list) else value


def read_tables(name: str) -> Any:
    """Reads a TOML file of this folder with lists converted to tuples."""
    return _frozen(read_toml(Path(__file__).with_name(name)))


TABLES = read_tables("rooms.toml")  # kinds, finishes, colours, textures, lightings
COLOURS = TABLES["colours"]

Palette = dict[str, Appearance]


def sample_palette(rng: np.random.Generator, walls: tuple[str, ...], floors: tuple[str, ...]) -> Palette:
    """Samples a palette: woods, fabrics and paints, one kind of wall and one of floor.

    Args:
        rng: Random stream.
        walls: Kinds of walls to choose from.
        floors: Kinds of floors to choose from.

    Returns:
        Appearance by name; those without a class (`coco`) take that of the piece they are used for.
    """

    def chosen(options: Any) -> Any:
        return options[int(rng.integers(len(options)))]

    def varied(colour: Any, material: str, **other: Any) -> Appearance:
        shade = rng.uniform(0.85, 1.15)
        colours = np.clip(np.array(colour) * shade * rng.uniform(0.96, 1.04, 3), 0.01, 0.9)
        return Appearance(tuple(colours.tolist()), material, **other)

    wood, dark = chosen(COLOURS["woods"]), chosen(COLOURS["woods"][2:4])
    cloth, accent = (COLOURS["cloths"][int(i)] for i in rng.permutation(len(COLOURS["cloths"]))[:2])
    wall, floor = TABLES["walls"][chosen(walls)], dict(TABLES["floors"][chosen(floors)])
    floor_colour, paint = chosen(floor.pop("colours")), chosen(COLOURS["paints"])
    if wall["pattern"] == "panels":
        paint = wood
    palette = {name: Appearance(**row) for name, row in TABLES["finishes"].items()}
    palette["wood"] = varied(wood, "wood", pattern="grain")
    palette["dark_wood"] = varied(dark, "wood", pattern="grain")
    palette["upright wood"] = replace(palette["wood"], pattern="upright")
    palette["cloth"] = varied(cloth, "fabric", pattern="weave")
    palette["accent"] = varied(accent, "fabric", pattern="weave")
    palette["white"] = varied(COLOURS["white"], "chipboard")
    palette["wall"] = varied(**{"colour": paint, **wall})
    palette["floor"] = varied(floor_colour, **floor)
    return palette
