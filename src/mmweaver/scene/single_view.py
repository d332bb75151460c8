"""The room as one photo shows it, in the level frame of its own camera: geometry, places and materials."""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.aligned_photo import AlignedPhoto
from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.records import FreeSpace, Plane, RgbdPhoto, Seat
from mmweaver.core.shapes import Faces, PerFace, Vertices
from mmweaver.scene.affordances.landmarks import find_free_space
from mmweaver.scene.affordances.seats import find_seats
from mmweaver.scene.coco_stuff import ROUGH, WALLS
from mmweaver.scene.layout.class_evidence import cells_of, seat_evidence
from mmweaver.scene.layout.doors_and_windows import fill_panes
from mmweaver.scene.layout.gravity import AlignedRoom, Gravity, align_room
from mmweaver.scene.layout.height_map import HeightMap, make_height_map
from mmweaver.scene.layout.mesh import make_mesh
from mmweaver.scene.layout.surfaces import (
    MATERIAL_NAMES,
    Surface,
    apply_class_materials,
    cell_materials,
    floor_cells,
)
from mmweaver.scene.photo.depth_grid import DepthGrid, GridBool, GridInt, make_grid


@dataclass(frozen=True, kw_only=True)
class SingleView:
    """The room as one photo shows it, in the level frame of its camera.

    Attributes:
        view: The photo aligned with gravity.
        grid: Its depth grid in the camera frame.
        room: The aligned grid with its planar surfaces.
        is_floor: Cells of the floor, (row, column).
        height_map: The room from above.
        free_space: Floor on which a body may stand.
        seats: Seats, the best first.
        material: Index into MATERIAL_NAMES of each cell, (row, column).
        planes: Planes of `room.surfaces` with their materials.
        assumptions: Sentences on what was assumed.
    """

    view: AlignedPhoto
    grid: DepthGrid
    room: AlignedRoom
    is_floor: GridBool
    height_map: HeightMap
    free_space: FreeSpace
    seats: tuple[Seat, ...]
    material: GridInt
    planes: tuple[Plane, ...]
    assumptions: tuple[str, ...]

    @property
    def floor_material(self) -> str | None:
        """The name of the floor's material; None if no floor is visible."""
        return MATERIAL_NAMES[self.material[self.is_floor][0]] if self.is_floor.any() else None

    @property
    def smooth_planes(self) -> list[Plane]:
        """Planes that return specular echoes: not mostly of a rough class, such as curtains."""
        is_rough = cells_of(self.grid, self.view.photo, ROUGH)
        pairs = zip(self.planes, self.room.surfaces, strict=True)
        return [plane for plane, surface in pairs if not _is_mostly(surface, is_rough)]

    @property
    def is_wall(self) -> GridBool | None:
        """Cells that a class mask labels as wall; None without a mask."""
        return cells_of(self.grid, self.view.photo, WALLS)

    def mesh(self) -> tuple[Vertices, Faces, PerFace]:
        """Triangulates the visible surfaces except the floor: vertices in metres, faces, material index per face."""
        rays = viewing_rays(self.grid.intrinsics) @ self.room.radar_from_camera.T
        return make_mesh(self.room.grid, rays, self.room.surfaces, self.is_floor, self.material)


def see(photo: RgbdPhoto, gravity: Gravity | None = None) -> SingleView:
    """Finds surfaces, places and materials in a photo.

    Args:
        photo: Photo with depth and, optionally, classes.
        gravity: Gravity if it is known better than from this photo alone, in the camera frame.

    Returns:
        The room in the level frame of this camera.

    Raises:
        InputError: If the depth shows no surfaces.
    """
    photo, pane_assumptions = fill_panes(photo)
    grid = make_grid(photo)
    room = align_room(grid, gravity)
    gravity, aligned, surfaces = room.gravity, room.grid, room.surfaces
    view = AlignedPhoto(photo=photo, radar_from_camera=room.radar_from_camera, floor_z_m=gravity.floor_z_m)
    is_floor = floor_cells(aligned) if gravity.has_floor else np.zeros(grid.depth_m.shape, bool)

    height_map = make_height_map(view)
    free_space = find_free_space(height_map)
    seats = find_seats(height_map, seat_evidence(view))

    # Materials, from geometry and colour, then from the class mask.
    material, surface_names = cell_materials(aligned, grid.rgb, surfaces, is_floor, seats)
    if grid.class_index is not None and photo.classes is not None:
        material, surface_names = apply_class_materials(
            material, surface_names, grid.class_index, photo.classes.names, surfaces, is_floor
        )
    planes = tuple(replace(surface.plane, material=name) for surface, name in zip(surfaces, surface_names, strict=True))
    return SingleView(
        view=view,
        grid=grid,
        room=room,
        is_floor=is_floor,
        height_map=height_map,
        free_space=free_space,
        seats=seats,
        material=material,
        planes=planes,
        assumptions=(*pane_assumptions, *gravity.assumptions),
    )


def _is_mostly(surface: Surface, cells: GridBool | None) -> bool:
    return cells is not None and bool((surface.cells & cells).sum() > 0.5 * surface.cells.sum())
