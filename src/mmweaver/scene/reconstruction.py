"""Reconstructs a room from a photo. Read `reconstruct` first: it names the steps in order."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import Plane, RgbdPhoto, Scene
from mmweaver.core.shapes import Array, Faces, PerFace, Vertices
from mmweaver.geometry.aligned_photo import AlignedPhoto
from mmweaver.geometry.pinhole import viewing_rays
from mmweaver.scene.affordances.assumed_floor import find_assumed_floor
from mmweaver.scene.affordances.free_space import find_free_space
from mmweaver.scene.affordances.landmarks import find_landmarks
from mmweaver.scene.affordances.seats import find_seats
from mmweaver.scene.coco_stuff import ROUGH, WALLS
from mmweaver.scene.layout.class_evidence import cells_of, seat_evidence
from mmweaver.scene.layout.gravity_alignment import align_room
from mmweaver.scene.layout.height_map import make_height_map
from mmweaver.scene.layout.mesh import floor_faces, make_mesh
from mmweaver.scene.layout.room_layout import estimate_layout, wall_faces
from mmweaver.scene.layout.surface_materials import (
    ASSUMPTION,
    ASSUMPTION_OF_CLASSES,
    MATERIAL_NAMES,
    cell_materials,
    with_class_materials,
    with_material,
)
from mmweaver.scene.layout.surfaces import AlignedGrid, Surface, floor_cells
from mmweaver.scene.layout.transparent_surfaces import with_transparent_surfaces
from mmweaver.scene.layout.wall_panels import find_wall_panels, with_wall_panels
from mmweaver.scene.photo.depth_grid import GridBool, make_grid

_FLOOR_MARGIN_M = 0.3
_MIN_FLOOR_M = 3.0  # length and width of the floor at least


def reconstruct(photo: RgbdPhoto, *, assumptions: tuple[str, ...] = ()) -> Scene:
    """The room of a photo, in the frame of a level radar that stands at the camera.

    `assumptions` are put before those made here. Raises InputError where the depth shows no surfaces.
    """
    # 1. Geometry: depth grid, gravity, planar surfaces.
    photo, pane_assumptions = with_transparent_surfaces(photo)
    grid = make_grid(photo)
    room = align_room(grid)
    gravity, aligned, surfaces = room.gravity, room.grid, room.surfaces
    view = AlignedPhoto(photo=photo, radar_from_camera=room.radar_from_camera, floor_z_m=gravity.floor_z_m)
    is_floor = floor_cells(aligned) if gravity.has_floor else np.zeros(grid.depth_m.shape, bool)

    # 2. What one can do in the room: stand and sit.
    height_map = make_height_map(view)
    free_space = find_free_space(height_map)
    seats = find_seats(height_map, seat_evidence(view))

    # 3. Materials, from geometry and colour, then from the class mask.
    material, surface_names = cell_materials(aligned, grid.rgb, surfaces, is_floor, seats)
    if grid.class_index is not None and photo.classes is not None:
        material, surface_names = with_class_materials(
            material, surface_names, grid.class_index, photo.classes.names, surfaces, is_floor
        )
    planes = [with_material(surface.plane, name) for surface, name in zip(surfaces, surface_names, strict=True)]
    floor = _floor_plane(aligned, is_floor, MATERIAL_NAMES[material[is_floor][0]] if is_floor.any() else "concrete")

    # 4. Room layout: specular planes for the radar, walls extended beyond the picture, panels on walls.
    is_rough = cells_of(grid, photo, ROUGH)
    smooth = [plane for plane, surface in zip(planes, surfaces, strict=True) if not _is_mostly(surface, is_rough)]
    layout = estimate_layout(aligned, smooth, cells_of(grid, photo, WALLS))
    walls = [plane for plane in layout.planes if plane.kind == "wall"]
    panels = find_wall_panels(view, walls)

    free_space = replace(free_space, is_assumed=find_assumed_floor(height_map, view, walls, free_space.is_free))

    # 5. Mesh for the ray caster.
    rays = viewing_rays(grid.intrinsics) @ room.radar_from_camera.T
    vertices_m, faces, face_material = make_mesh(aligned, rays, surfaces, is_floor, material)
    corners_m, large_faces, large_material = _rectangles(floor, layout.extended)
    return Scene(
        photo=photo,
        radar_from_camera=room.radar_from_camera,
        vertices_m=np.concatenate([vertices_m, corners_m]),
        faces=np.concatenate([faces, large_faces + len(vertices_m)]),
        face_material=np.concatenate([face_material, large_material]),
        material_names=MATERIAL_NAMES,
        planes=(floor, *with_wall_panels(layout.planes, panels, layout.extended)),
        floor_z_m=gravity.floor_z_m,
        free_space=free_space,
        seats=seats,
        landmarks=find_landmarks(view, (floor, *planes), height_map, free_space, seats),
        assumptions=(
            *assumptions,
            *pane_assumptions,
            *gravity.assumptions,
            *layout.assumptions,
            *_general_assumptions(floor, has_classes=photo.classes is not None),
        ),
    )


def _rectangles(floor: Plane, walls: Sequence[Plane]) -> tuple[Vertices, Faces, PerFace]:
    """The floor and the extended walls as two triangles each: vertices in metres, faces, material of each face."""
    corners_m, triangles = floor_faces(floor)
    wall_corners_m, wall_triangles = wall_faces(walls)
    names = [plane.material for plane in (floor, *walls) for _ in range(2)]
    return (
        np.concatenate([corners_m, wall_corners_m]),
        np.concatenate([triangles, wall_triangles + len(corners_m)]),
        np.array([MATERIAL_NAMES.index(name) for name in names]),
    )


def _is_mostly(surface: Surface, cells: GridBool | None) -> bool:
    return cells is not None and bool((surface.cells & cells).sum() > 0.5 * surface.cells.sum())


def _floor_plane(grid: AlignedGrid, is_floor: GridBool, material: str) -> Plane:
    """The floor as a rectangle from below the radar to behind the farthest point."""
    points = grid.points_m[np.isfinite(grid.depth_m)]
    visible_floor = grid.points_m[is_floor]
    left, right = _extent([points[:, 0], visible_floor[:, 0]])
    far = max(_extent([points[:, 1], visible_floor[:, 1]])[1], _MIN_FLOOR_M)
    left, right = min(left, -_MIN_FLOOR_M / 2), max(right, _MIN_FLOOR_M / 2)
    near = 0.0
    left, right, far = left - _FLOOR_MARGIN_M, right + _FLOOR_MARGIN_M, far + _FLOOR_MARGIN_M
    return Plane(
        kind="floor",
        centre_m=np.array([(left + right) / 2, (near + far) / 2, grid.floor_z_m]),
        normal=np.array([0.0, 0.0, 1.0]),
        axis_u=np.array([1.0, 0.0, 0.0]),
        axis_v=np.array([0.0, 1.0, 0.0]),
        half_size_m=((right - left) / 2, (far - near) / 2),
        material=material,
    )


def _extent(parts: Sequence[Float[Array, " _"]]) -> tuple[float, float]:
    """The least 2nd and the greatest 98th percentile of several sets of coordinates, metres."""
    ends = [np.percentile(part, [2, 98]) for part in parts if len(part)]
    return float(min(end[0] for end in ends)), float(max(end[1] for end in ends))


def _general_assumptions(floor: Plane, *, has_classes: bool) -> tuple[str, ...]:
    width, length = 2 * floor.half_size_m[0], 2 * floor.half_size_m[1]
    sentences = (
        "The radar stands level at the camera and points where the camera points.",
        f"The floor was extended to a level rectangle of {width:.1f} x {length:.1f} m, and walls down to it.",
        "Places below the picture's lower edge, before the visible floor, were assumed to be free.",
        ASSUMPTION_OF_CLASSES if has_classes else ASSUMPTION,
    )
    return tuple(map(UsualAssumption, sentences))
