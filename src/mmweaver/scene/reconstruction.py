"""Reconstructs a room from a photo. Read `reconstruct` first: it names the steps in order."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import Plane, RgbdPhoto, Scene
from mmweaver.core.shapes import Array
from mmweaver.scene.affordances.free_space import find_assumed_floor
from mmweaver.scene.affordances.landmarks import find_landmarks
from mmweaver.scene.layout.mesh import joined_meshes, rectangle_faces
from mmweaver.scene.layout.panes import add_wall_panels, find_wall_panels
from mmweaver.scene.layout.room_layout import estimate_layout
from mmweaver.scene.layout.surface_materials import ASSUMPTION, ASSUMPTION_OF_CLASSES, MATERIAL_NAMES
from mmweaver.scene.layout.surfaces import AlignedGrid
from mmweaver.scene.photo.depth_grid import GridBool
from mmweaver.scene.single_view import see

DEFAULT_FLOOR = "concrete"  # where none is seen
_FLOOR_MARGIN_M = 0.3
_MIN_FLOOR_M = 3.0  # length and width of the floor at least


def reconstruct(photo: RgbdPhoto, *, assumptions: tuple[str, ...] = ()) -> Scene:
    """The room of a photo, in the frame of a level radar that stands at the camera.

    `assumptions` are put before those made here. Raises InputError where the depth shows no surfaces.
    """
    # 1. Geometry, gravity, places where one can stand and sit, materials.
    seen = see(photo)

    # 2. Room layout: specular planes for the radar, walls extended beyond the picture, panels on walls.
    layout = estimate_layout(seen.room.grid, seen.smooth_planes, seen.is_wall)
    walls = [plane for plane in layout.planes if plane.kind == "wall"]
    panels = find_wall_panels(seen.view, walls)
    floor = floor_plane(seen.room.grid, seen.is_floor, seen.floor_material or DEFAULT_FLOOR)
    assumed = find_assumed_floor(seen.height_map, seen.view, walls, seen.free_space.is_free)
    free_space = replace(seen.free_space, is_assumed=assumed)

    # 3. Mesh for the ray caster.
    vertices_m, faces, face_material = joined_meshes([seen.mesh(), rectangle_faces([floor, *layout.extended])])
    return Scene(
        photo=seen.view.photo,
        radar_from_camera=seen.room.radar_from_camera,
        vertices_m=vertices_m,
        faces=faces,
        face_material=face_material,
        material_names=MATERIAL_NAMES,
        planes=(floor, *add_wall_panels(layout.planes, panels, layout.extended)),
        floor_z_m=seen.view.floor_z_m,
        free_space=free_space,
        seats=seen.seats,
        landmarks=find_landmarks(seen.view, (floor, *seen.planes), seen.height_map, free_space, seen.seats),
        assumptions=(
            *assumptions,
            *seen.assumptions,
            *layout.assumptions,
            *general_assumptions(floor, has_classes=photo.classes is not None),
        ),
    )


def floor_plane(grid: AlignedGrid, is_floor: GridBool, material: str, *, is_whole: bool = False) -> Plane:
    """The floor as a rectangle from below the radar to behind the farthest point.

    `is_whole`: the grid shows what is behind the radar, too, and the floor reaches there.
    """
    points = grid.points_m[np.isfinite(grid.depth_m)]
    visible_floor = grid.points_m[is_floor]
    left, right = _extent([points[:, 0], visible_floor[:, 0]])
    far = max(_extent([points[:, 1], visible_floor[:, 1]])[1], _MIN_FLOOR_M)
    left, right = min(left, -_MIN_FLOOR_M / 2), max(right, _MIN_FLOOR_M / 2)
    near = min(0.0, _extent([points[:, 1]])[0]) if is_whole else 0.0
    left, right, far = left - _FLOOR_MARGIN_M, right + _FLOOR_MARGIN_M, far + _FLOOR_MARGIN_M
    x, y, z = np.eye(3)
    plane = Plane(
        kind="floor",
        centre_m=grid.floor_z_m * z,
        normal=z,
        axis_u=x,
        axis_v=y,
        half_size_m=(0.0, 0.0),
        material=material,
    )
    return plane.spanned((left, near), (right, far))


def _extent(parts: Sequence[Float[Array, " _"]]) -> tuple[float, float]:
    """The least 2nd and the greatest 98th percentile of several sets of coordinates, metres."""
    ends = [np.percentile(part, [2, 98]) for part in parts if len(part)]
    return float(min(end[0] for end in ends)), float(max(end[1] for end in ends))


def general_assumptions(floor: Plane, *, has_classes: bool) -> tuple[str, ...]:
    """What is assumed of every room, as sentences."""
    width, length = 2 * floor.half_size_m[0], 2 * floor.half_size_m[1]
    sentences = (
        "The radar stands level at the camera and points where the camera points.",
        f"The floor was extended to a level rectangle of {width:.1f} x {length:.1f} m, and walls down to it.",
        "Places below the picture's lower edge, before the visible floor, were assumed to be free.",
        ASSUMPTION_OF_CLASSES if has_classes else ASSUMPTION,
    )
    return tuple(map(UsualAssumption, sentences))
