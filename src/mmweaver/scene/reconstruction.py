"""Photo -> Scene. Read `reconstruct` first: it names the steps in order."""

from collections.abc import Sequence

import numpy as np

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import CameraIntrinsics, Plane, RgbdPhoto, Scene
from mmweaver.core.shapes import Rotation
from mmweaver.geometry.pinhole import unproject
from mmweaver.scene.affordances.free_space import find_free_space
from mmweaver.scene.affordances.landmarks import find_landmarks
from mmweaver.scene.affordances.seats import find_seats
from mmweaver.scene.coco_stuff import ROUGH, WALLS
from mmweaver.scene.layout.class_evidence import cells_of, sittable_squares
from mmweaver.scene.layout.gravity_alignment import level_room
from mmweaver.scene.layout.height_map import make_height_map
from mmweaver.scene.layout.mesh import floor_faces, make_mesh
from mmweaver.scene.layout.room_layout import close_room, wall_faces
from mmweaver.scene.layout.surface_materials import (
    ASSUMPTION,
    ASSUMPTION_OF_CLASSES,
    MATERIAL_NAMES,
    by_class,
    cell_materials,
    with_material,
)
from mmweaver.scene.layout.surfaces import LevelGrid, Surface, floor_cells
from mmweaver.scene.layout.transparent_surfaces import with_transparent_surfaces
from mmweaver.scene.layout.wall_panels import hung_panels, with_hung
from mmweaver.scene.photo.depth_grid import GridBool, GridVectors, make_grid

_FLOOR_MARGIN_M = 0.3
_MIN_FLOOR_M = 3.0  # length and half width that the floor is given at least


def reconstruct(photo: RgbdPhoto, *, assumptions: tuple[str, ...] = ()) -> Scene:
    """The room of a photo, in the frame of a level radar that stands at the camera.

    Steps: thin the depth to a grid, find gravity from the floor and then from the walls too, turn the room level, find
    its flat surfaces, look at it from above for free places and seats, guess materials, make the mesh. `assumptions`
    are put before its own.

    Raises InputError where the depth shows no surfaces.
    """
    photo, closed_panes = with_transparent_surfaces(photo)
    grid = make_grid(photo)
    room = level_room(grid)
    gravity, radar_from_camera, level, surfaces = room.gravity, room.radar_from_camera, room.grid, room.surfaces
    is_floor = floor_cells(level) if gravity.has_floor else np.zeros(grid.depth_m.shape, bool)

    height_map = make_height_map(photo, radar_from_camera, gravity.floor_z_m)
    free_space = find_free_space(height_map, -gravity.floor_z_m)
    seats = find_seats(height_map, gravity.floor_z_m, sittable_squares(photo, radar_from_camera, gravity.floor_z_m))

    material, surface_names = cell_materials(level, grid.rgb, surfaces, is_floor, seats)
    if grid.class_index is not None and photo.classes is not None:
        material, surface_names = by_class(
            material, surface_names, grid.class_index, photo.classes.names, surfaces, is_floor
        )
    floor = _floor(level, is_floor, _floor_material(material, is_floor))
    planes = [with_material(surface.plane, name) for surface, name in zip(surfaces, surface_names, strict=True)]
    rays = _rays(grid.intrinsics, radar_from_camera)
    vertices_m, faces, face_material = make_mesh(level, rays, surfaces, is_floor, material)
    rough = cells_of(grid, photo, ROUGH)
    smooth = [plane for plane, surface in zip(planes, surfaces, strict=True) if not _is_mostly(surface, rough)]
    closed = close_room(level, smooth, cells_of(grid, photo, WALLS))
    hung = hung_panels(photo, radar_from_camera, [plane for plane in closed.planes if plane.kind == "wall"])
    corners_m, large_faces, large_material = _rectangles(floor, closed.added)
    return Scene(
        photo=photo,
        radar_from_camera=radar_from_camera,
        vertices_m=np.concatenate([vertices_m, corners_m]),
        faces=np.concatenate([faces, large_faces + len(vertices_m)]),
        face_material=np.concatenate([face_material, large_material]),
        material_names=MATERIAL_NAMES,
        planes=(floor, *with_hung(closed.planes, hung, closed.added)),
        floor_z_m=gravity.floor_z_m,
        free_space=free_space,
        seats=seats,
        landmarks=find_landmarks(
            photo, radar_from_camera, gravity.floor_z_m, (floor, *planes), height_map, free_space, seats
        ),
        assumptions=(
            *assumptions,
            *closed_panes,
            *gravity.assumptions,
            *closed.assumptions,
            *_own_assumptions(floor, has_classes=photo.classes is not None),
        ),
    )


def _rectangles(floor: Plane, walls: Sequence[Plane]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The whole floor and the walls that close the room, two triangles each."""
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


def _rays(intrinsics: CameraIntrinsics, radar_from_camera: Rotation) -> GridVectors:
    ones = np.ones((intrinsics.height, intrinsics.width))
    return unproject(ones, intrinsics) @ radar_from_camera.T


def _floor_material(material: np.ndarray, is_floor: GridBool) -> str:
    return MATERIAL_NAMES[material[is_floor][0]] if is_floor.any() else "concrete"


def _floor(grid: LevelGrid, is_floor: GridBool, material: str) -> Plane:
    """The floor as a rectangle from under the radar to behind the farthest that is seen."""
    points = grid.points_m[np.isfinite(grid.depth_m)]
    seen = grid.points_m[is_floor]
    left, right = _spread([points[:, 0], seen[:, 0]])
    far = max(_spread([points[:, 1], seen[:, 1]])[1], _MIN_FLOOR_M)
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


def _spread(parts: list[np.ndarray]) -> tuple[float, float]:
    """From the least to the greatest of some sets, each without its outer two hundredths."""
    ends = [np.percentile(part, [2, 98]) for part in parts if len(part)]
    return float(min(end[0] for end in ends)), float(max(end[1] for end in ends))


def _own_assumptions(floor: Plane, *, has_classes: bool) -> tuple[str, ...]:
    width, length = 2 * floor.half_size_m[0], 2 * floor.half_size_m[1]
    sentences = (
        "The radar stands level at the camera and looks where it looks.",
        f"The floor was completed to a level rectangle of {width:.1f} x {length:.1f} m; walls were taken to reach it.",
        "Places under the picture's lower edge, before floor that is seen, were taken to be free.",
        ASSUMPTION_OF_CLASSES if has_classes else ASSUMPTION,
    )
    return tuple(map(UsualAssumption, sentences))
