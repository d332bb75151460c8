"""The depth grid turned level: gravity from the floor, then from the walls too, and the flat surfaces found then."""

from dataclasses import dataclass

from mmweaver.core.shapes import Rotation
from mmweaver.geometry.rotations import level_from_camera
from mmweaver.scene.layout.gravity import Gravity, corrected_by_walls, find_gravity
from mmweaver.scene.layout.surfaces import LevelGrid, Surface, find_surfaces, floor_cells
from mmweaver.scene.photo.depth_grid import DepthGrid


@dataclass(frozen=True, kw_only=True)
class LevelRoom:
    """What is known of a room as soon as up is known."""

    gravity: Gravity
    radar_from_camera: Rotation
    grid: LevelGrid
    surfaces: tuple[Surface, ...]


def level_room(grid: DepthGrid) -> LevelRoom:
    """Raises InputError where the depth shows no surfaces."""
    gravity = find_gravity(grid)
    level = levelled(grid, level_from_camera(gravity.up_camera), gravity.floor_z_m)
    walls = [surface.cells for surface in find_surfaces(level) if surface.plane.kind == "wall"]
    gravity = corrected_by_walls(gravity, grid, floor_cells(level), walls)
    radar_from_camera = level_from_camera(gravity.up_camera)
    level = levelled(grid, radar_from_camera, gravity.floor_z_m)
    return LevelRoom(gravity=gravity, radar_from_camera=radar_from_camera, grid=level, surfaces=find_surfaces(level))


def levelled(grid: DepthGrid, radar_from_camera: Rotation, floor_z_m: float) -> LevelGrid:
    """The grid in the radar's frame."""
    return LevelGrid(
        points_m=grid.points_m @ radar_from_camera.T,
        normals=grid.normals @ radar_from_camera.T,
        depth_m=grid.depth_m,
        floor_z_m=floor_z_m,
        focal_cells=grid.intrinsics.fx,
    )
