"""Aligns the depth grid with gravity: estimates gravity, rotates the grid, and segments its planar surfaces."""

from dataclasses import dataclass

from mmweaver.core.shapes import Rotation
from mmweaver.geometry.rotations import level_from_camera
from mmweaver.scene.layout.gravity import Gravity, find_gravity, refined_by_walls
from mmweaver.scene.layout.surfaces import AlignedGrid, Surface, find_surfaces, floor_cells
from mmweaver.scene.photo.depth_grid import DepthGrid


@dataclass(frozen=True, kw_only=True)
class AlignedRoom:
    """A depth grid in the radar's frame and its planar surfaces, the floor excepted."""

    gravity: Gravity
    radar_from_camera: Rotation
    grid: AlignedGrid
    surfaces: tuple[Surface, ...]


def align_room(grid: DepthGrid, gravity: Gravity | None = None) -> AlignedRoom:
    """Aligns the grid with gravity, by default that of `room_gravity`. Raises InputError where it shows no surfaces."""
    gravity = room_gravity(grid) if gravity is None else gravity
    radar_from_camera = level_from_camera(gravity.up_camera)
    aligned = _aligned(grid, radar_from_camera, gravity.floor_z_m)
    return AlignedRoom(
        gravity=gravity, radar_from_camera=radar_from_camera, grid=aligned, surfaces=find_surfaces(aligned)
    )


def room_gravity(grid: DepthGrid) -> Gravity:
    """Gravity by the floor, refined by the walls found with that estimate.

    Raises InputError where the depth shows no surfaces.
    """
    gravity = find_gravity(grid)
    first = _aligned(grid, level_from_camera(gravity.up_camera), gravity.floor_z_m)
    walls = [surface.cells for surface in find_surfaces(first) if surface.plane.kind == "wall"]
    return refined_by_walls(gravity, grid, floor_cells(first), walls)


def _aligned(grid: DepthGrid, radar_from_camera: Rotation, floor_z_m: float) -> AlignedGrid:
    """The grid rotated into the radar's frame."""
    return AlignedGrid(
        points_m=grid.points_m @ radar_from_camera.T,
        normals=grid.normals @ radar_from_camera.T,
        depth_m=grid.depth_m,
        floor_z_m=floor_z_m,
        focal_cells=grid.intrinsics.fx,
    )
