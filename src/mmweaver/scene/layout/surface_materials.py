"""Materials of surfaces: from the class of each pixel where a mask gives one, else guessed from geometry and colour.

Metal and glass are never guessed.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import Seat
from mmweaver.core.shapes import Array
from mmweaver.scene.coco_stuff import material_of
from mmweaver.scene.layout.surfaces import AlignedGrid, Surface
from mmweaver.scene.photo.depth_grid import GridBool, GridInt, GridVectors

# ITU-R P.2040-3, table 3, and upholstery (fabric), which it does not list.
MATERIAL_NAMES = (
    "concrete",
    "brick",
    "plasterboard",
    "wood",
    "glass",
    "ceiling_board",
    "chipboard",
    "plywood",
    "marble",
    "floorboard",
    "metal",
    "fabric",
)

ASSUMPTION = (
    "Materials were guessed from geometry and colour: walls plasterboard, a warm and saturated floor floorboard and any"
    " other concrete, seats fabric if wide or of no wooden colour, the rest wood or chipboard by colour."
)

ASSUMPTION_OF_CLASSES = (
    "Materials follow from the class of each pixel (COCO-Stuff to ITU-R P.2040) where it says one; elsewhere they were"
    " guessed from geometry and colour: walls plasterboard, a warm and saturated floor floorboard and any other"
    " concrete, seats fabric if wide or of no wooden colour, the rest wood or chipboard by colour."
)

_BY_KIND = {"wall": "plasterboard", "ceiling": "ceiling_board"}  # of surfaces; others by colour
_SEAT_REACH_M = 0.55
_SOFA_M = 0.8  # a seat of at least this width is upholstered, whatever its colour


def floor_material(colours: Float[Array, "cell 3"]) -> str:
    """Guesses the floor's material from its colour.

    Args:
        colours: Colours 0 to 1 of the floor's cells, (cell, 3).

    Returns:
        "floorboard" if the colour is that of wood, else "concrete".
    """
    return "floorboard" if _is_wooden(colours) else "concrete"


def cell_materials(
    grid: AlignedGrid,
    rgb: GridVectors,
    surfaces: Sequence[Surface],
    is_floor: GridBool,
    seats: Sequence[Seat],
) -> tuple[GridInt, tuple[str, ...]]:
    """Guesses materials from geometry and colour.

    Args:
        grid: Depth grid in the radar's frame.
        rgb: Colour of each cell, 0 to 1, (row, column, 3).
        surfaces: Planar surfaces except the floor.
        is_floor: Cells of the floor, (row, column).
        seats: Seats of the room; wide ones, and those not of a wooden colour, are upholstered.

    Returns:
        Index into MATERIAL_NAMES of every cell, (row, column); and the material of each surface.
    """
    wooden = _wooden_cells(rgb)
    material = np.where(wooden, MATERIAL_NAMES.index("wood"), MATERIAL_NAMES.index("chipboard"))
    names = [
        _BY_KIND.get(surface.plane.kind) or ("wood" if _is_wooden(rgb[surface.cells]) else "chipboard")
        for surface in surfaces
    ]
    for surface, name in zip(surfaces, names, strict=True):
        material[surface.cells] = MATERIAL_NAMES.index(name)
    fixed = is_floor.copy()
    highest_seat_m = max((float(seat.position_m[2]) for seat in seats), default=0.0)
    for surface in surfaces:
        is_table = surface.plane.kind == "top" and surface.plane.centre_m[2] > highest_seat_m + 0.1
        if is_table or surface.plane.kind in ("wall", "ceiling"):
            fixed |= surface.cells
    for cells in _upholstered(grid, rgb, ~fixed, seats):
        material[cells] = MATERIAL_NAMES.index("fabric")
        for index, surface in enumerate(surfaces):
            if (cells & surface.cells).sum() > 0.3 * min(cells.sum(), surface.cells.sum()):
                names[index] = "fabric"
                material[surface.cells] = MATERIAL_NAMES.index("fabric")
    material[is_floor] = MATERIAL_NAMES.index(floor_material(rgb[is_floor]))
    return material, tuple(names)


def apply_class_materials(
    material: GridInt,
    names: tuple[str, ...],
    class_index: GridInt,
    class_names: tuple[str, ...],
    surfaces: Sequence[Surface],
    is_floor: GridBool,
) -> tuple[GridInt, tuple[str, ...]]:
    """Replaces the guesses of `cell_materials` where the class of a cell implies a material.

    A surface, or the floor, takes the majority's material if the classes of more than half of its cells imply one.

    Args:
        material: Guessed index into MATERIAL_NAMES of each cell, (row, column).
        names: Guessed material of each surface.
        class_index: Class of each cell, (row, column), index into `class_names`.
        class_names: COCO-Stuff classes of the mask.
        surfaces: Planar surfaces except the floor.
        is_floor: Cells of the floor, (row, column).

    Returns:
        The corrected `material` and `names`.
    """
    of_class = np.array([MATERIAL_NAMES.index(m) if (m := material_of(name)) else -1 for name in class_names])
    implied = of_class[np.clip(class_index, 0, len(of_class) - 1)]
    guessed, material = material, np.where(implied >= 0, implied, material)
    new = list(names)
    for index, surface in enumerate(surfaces):
        majority = _majority(implied[surface.cells])
        if majority is not None:
            new[index] = MATERIAL_NAMES[majority]
            material[surface.cells] = np.where(implied[surface.cells] >= 0, implied[surface.cells], majority)
    majority = _majority(implied[is_floor])
    material[is_floor] = guessed[is_floor] if majority is None else majority
    return material, tuple(new)


def _majority(implied: Int[Array, " cell"]) -> int | None:
    """The most frequent material of the cells that have one (-1: none); None if fewer than half have one."""
    known = implied[implied >= 0]
    return int(np.bincount(known).argmax()) if len(known) > 0.5 * len(implied) else None


def _upholstered(grid: AlignedGrid, rgb: GridVectors, open_cells: GridBool, seats: Sequence[Seat]) -> list[GridBool]:
    """The cells around each seat that is as wide as a sofa or not of a wooden colour."""
    found = []
    above_floor = grid.points_m[..., 2] - grid.floor_z_m
    for seat in seats:
        offset = grid.points_m - seat.position_m
        cells = open_cells & (np.hypot(offset[..., 0], offset[..., 1]) < _SEAT_REACH_M)
        cells &= (above_floor > 0.12) & (above_floor < 1.2)
        if cells.sum() < 20:
            continue
        if max(seat.size_m) >= _SOFA_M or not _is_wooden(rgb[cells]):
            found.append(cells)
    return found


def _is_wooden(colours: Float[Array, "cell 3"]) -> bool:
    """Whether the median of colours (cell, 3) is that of wood."""
    return bool(len(colours)) and bool(_wooden_cells(np.median(colours, axis=0)))


def _wooden_cells(rgb: Float[Array, "*cells 3"]) -> Bool[Array, "*cells"] | np.bool_:
    """Whether colours, 0 to 1, are those of wood: hues from yellow to red-brown, saturated, not too dark."""
    red, green, blue = rgb[..., 0], rgb[..., 1], rgb[..., 2]
    span = np.maximum(red - blue, 1e-6)
    hue_deg = 60 * (green - blue) / span
    saturation = (red - blue) / np.maximum(red, 1e-6)
    return (red >= green) & (green >= blue) & (hue_deg > 8) & (hue_deg < 52) & (saturation > 0.3) & (red > 0.12)
