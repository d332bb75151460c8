"""The palette of a room: woods, fabrics, paints, walls and floor, sampled from its seed."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.scene.procedural.parts import Appearance, Colour

_WOODS: tuple[Colour, ...] = (
    (0.46, 0.27, 0.13), (0.55, 0.38, 0.21), (0.25, 0.13, 0.06), (0.36, 0.20, 0.10), (0.62, 0.47, 0.30),
)  # fmt: skip
_CLOTHS: tuple[Colour, ...] = (
    (0.085, 0.13, 0.19), (0.30, 0.28, 0.25), (0.12, 0.16, 0.11), (0.35, 0.10, 0.07), (0.48, 0.40, 0.30),
    (0.10, 0.10, 0.11), (0.42, 0.24, 0.08), (0.20, 0.12, 0.20),
)  # fmt: skip
_PAINTS: tuple[Colour, ...] = (
    (0.74, 0.71, 0.65), (0.72, 0.73, 0.72), (0.66, 0.62, 0.50), (0.50, 0.60, 0.62), (0.62, 0.66, 0.55),
    (0.70, 0.58, 0.50), (0.45, 0.52, 0.60),
)  # fmt: skip
_FLOORS: dict[str, tuple[tuple[Colour, str, str, str], ...]] = {
    "boards": (
        ((0.46, 0.27, 0.13), "floorboard", "floor-wood", "boards"),
        ((0.30, 0.17, 0.09), "floorboard", "floor-wood", "boards"),
        ((0.56, 0.42, 0.27), "floorboard", "floor-wood", "boards"),
    ),
    "tiles": (
        ((0.55, 0.53, 0.50), "marble", "floor-tile", "tiles"),
        ((0.34, 0.33, 0.33), "marble", "floor-tile", "tiles"),
        ((0.60, 0.52, 0.42), "marble", "floor-tile", "tiles"),
    ),
    "carpet": (
        ((0.16, 0.18, 0.22), "concrete", "carpet", "pile"),
        ((0.30, 0.27, 0.23), "concrete", "carpet", "pile"),
    ),
    "linoleum": (
        ((0.35, 0.38, 0.38), "concrete", "floor-other", "speckle"),
        ((0.42, 0.38, 0.32), "concrete", "floor-other", "speckle"),
    ),
    "concrete": (((0.30, 0.30, 0.29), "concrete", "floor-stone", "concrete"),),
}
_WALLS: dict[str, tuple[str, str, str]] = {
    "paint": ("plasterboard", "wall-other", "plaster"),
    "concrete": ("concrete", "wall-concrete", "concrete"),
    "brick": ("brick", "wall-brick", "brick"),
    "panels": ("wood", "wall-wood", "panels"),
    "tiles": ("marble", "wall-tile", "tiles"),
}


@dataclass(frozen=True, kw_only=True)
class Palette:
    """Appearances to build furniture with; `labelled` sets the class of the object that one is used for."""

    wood: Appearance
    dark_wood: Appearance
    cloth: Appearance
    accent: Appearance
    metal: Appearance
    dark: Appearance
    white: Appearance
    wall: Appearance
    floor: Appearance
    ceiling: Appearance

    @staticmethod
    def labelled(appearance: Appearance, coco: str) -> Appearance:
        return replace(appearance, coco=coco)


def sample_palette(rng: np.random.Generator, walls: tuple[str, ...], floors: tuple[str, ...]) -> Palette:
    """Samples a palette with walls and a floor of the given kinds."""
    wood, dark = _WOODS[int(rng.integers(len(_WOODS)))], _WOODS[2 + int(rng.integers(2))]
    cloth, accent = (_CLOTHS[int(i)] for i in rng.permutation(len(_CLOTHS))[:2])
    wall_kind = _WALLS[walls[int(rng.integers(len(walls)))]]
    floor = _FLOORS[floors[int(rng.integers(len(floors)))]]
    colour, material, coco, pattern = floor[int(rng.integers(len(floor)))]
    wall = _PAINTS[int(rng.integers(len(_PAINTS)))]
    if wall_kind[2] == "brick":
        wall = (0.38, 0.16, 0.10)
    elif wall_kind[2] == "panels":
        wall = wood
    elif wall_kind[2] == "concrete":
        wall = (0.48, 0.47, 0.45)
    return Palette(
        wood=Appearance(_varied(rng, wood), "wood", "furniture-other", "grain"),
        dark_wood=Appearance(_varied(rng, dark), "wood", "furniture-other", "grain"),
        cloth=Appearance(_varied(rng, cloth), "fabric", "furniture-other", "weave"),
        accent=Appearance(_varied(rng, accent), "fabric", "furniture-other", "weave"),
        metal=Appearance((0.35, 0.35, 0.36), "metal", "furniture-other"),
        dark=Appearance((0.03, 0.03, 0.032), "chipboard", "furniture-other"),
        white=Appearance(_varied(rng, (0.66, 0.65, 0.62)), "chipboard", "furniture-other"),
        wall=Appearance(_varied(rng, wall), wall_kind[0], wall_kind[1], wall_kind[2]),
        floor=Appearance(_varied(rng, colour), material, coco, pattern),
        ceiling=Appearance((0.82, 0.82, 0.80), "ceiling_board", "ceiling-other", "plaster"),
    )


def _varied(rng: np.random.Generator, colour: Colour) -> Colour:
    shade = rng.uniform(0.85, 1.15)
    varied = np.clip(np.array(colour) * shade * rng.uniform(0.96, 1.04, 3), 0.01, 0.9)
    return float(varied[0]), float(varied[1]), float(varied[2])
