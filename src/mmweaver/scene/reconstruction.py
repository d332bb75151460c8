"""Reconstructs a room from one or several photos. Start with `reconstruct`, which lists the steps in order."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from mmweaver.core.assumptions import UsualAssumption
from mmweaver.core.records import Landmark, Plane, RgbdPhoto, Scene
from mmweaver.core.shapes import Array
from mmweaver.scene.affordances.landmarks import find_assumed_floor, find_landmarks
from mmweaver.scene.layout.doors_and_windows import add_wall_panels, find_wall_panels
from mmweaver.scene.layout.gravity import room_gravity
from mmweaver.scene.layout.mesh import joined_meshes, rectangle_faces
from mmweaver.scene.layout.room_layout import estimate_layout
from mmweaver.scene.layout.surfaces import ASSUMPTION, ASSUMPTION_OF_CLASSES, MATERIAL_NAMES, AlignedGrid
from mmweaver.scene.multiview.fusion import joined_free_space, joined_grid, joined_places, joined_planes
from mmweaver.scene.multiview.registration import ALONE, LevelPose, common_gravity, corrected_poses
from mmweaver.scene.photo.capture_photo import PosedPhoto
from mmweaver.scene.photo.depth_grid import GridBool, make_grid
from mmweaver.scene.single_view import SingleView, see

DEFAULT_FLOOR = "concrete"  # if no floor is visible
_FLOOR_MARGIN_M = 0.3
_MIN_FLOOR_M = 3.0  # length and width of the floor at least


def reconstruct(photo: RgbdPhoto, others: Sequence[PosedPhoto] = (), *, assumptions: tuple[str, ...] = ()) -> Scene:
    """Reconstructs the room of one or several photos, in the frame of a level radar at the first photo's camera.

    Args:
        photo: First photo, with depth.
        others: Further photos of the room, with poses relative to the first.
        assumptions: Sentences that precede the assumptions made here.

    Returns:
        The room: mesh, planes, materials, floor, seats and landmarks.

    Raises:
        InputError: If the depth of a photo shows no surfaces.
    """
    # 1. Geometry, gravity, free floor, seats and materials of each photo, registered to the earlier ones.
    is_whole, photos = bool(others), [photo, *(one.photo for one in others)]
    if is_whole:
        gravities, given = common_gravity([room_gravity(make_grid(one)) for one in photos], others)
        seen = [see(one, gravity) for one, gravity in zip(photos, gravities, strict=True)]
        poses = corrected_poses(seen, given, others)
        notes = (_note(given, poses[1:], others),)
    else:
        seen, poses, notes = [see(photo)], (ALONE,), ()
    first, pairs = seen[0], list(zip(seen, poses, strict=True))

    # 2. Room layout: specular planes for the radar, walls extended beyond the pictures, panels on walls.
    grid = joined_grid(seen, poses)
    planes = joined_planes([pose.plane(plane) for one, pose in pairs for plane in one.smooth_planes], is_whole)
    masks = [one.is_wall for one in seen]
    is_wall = None if any(mask is None for mask in masks) else _joined(masks, is_whole)
    layout = estimate_layout(grid, planes, is_wall, is_whole=is_whole)
    walls = [plane for plane in layout.planes if plane.kind == "wall"]
    panels = joined_planes([panel for one, pose in pairs for panel in _panels(one, pose, walls)], is_whole)
    material = next((one.floor_material for one in seen if one.floor_material), DEFAULT_FLOOR)
    floor = floor_plane(grid, _joined([one.is_floor for one in seen], is_whole), material, is_whole=is_whole)

    # 3. Places for people.
    free = joined_free_space(seen, poses)
    assumed = find_assumed_floor(first.height_map, first.view, walls, free.is_free)
    landmarks = [pose.landmark(mark) for one, pose in pairs for mark in _landmarks(one)]
    seats = [pose.seat(seat) for one, pose in pairs for seat in one.seats]
    if is_whole:
        landmarks, seats = joined_places(landmarks), joined_places(seats)

    # 4. Mesh for the ray caster.
    meshes = [(pose.points(mesh[0]), *mesh[1:]) for mesh, pose in ((one.mesh(), pose) for one, pose in pairs)]
    vertices_m, faces, face_material = joined_meshes([*meshes, rectangle_faces([floor, *layout.extended])])
    own_notes = dict.fromkeys(note for one in seen for note in one.assumptions)
    return Scene(
        photo=first.view.photo,
        radar_from_camera=first.room.radar_from_camera,
        vertices_m=vertices_m,
        faces=faces,
        face_material=face_material,
        material_names=MATERIAL_NAMES,
        planes=(floor, *add_wall_panels(layout.planes, panels, layout.extended)),
        floor_z_m=first.view.floor_z_m,
        free_space=replace(free, is_assumed=assumed),
        seats=tuple(seats),
        landmarks=tuple(landmarks),
        assumptions=(
            *assumptions,
            *notes,
            *own_notes,
            *layout.assumptions,
            *_general_assumptions(floor, has_classes=any(one.classes is not None for one in photos)),
        ),
    )


def _joined(masks: Sequence[GridBool | None], is_whole: bool) -> np.ndarray:
    """Masks of all photos in one row, (1, cell), in the order of `joined_grid`; that of a single photo unchanged."""
    own = [mask for mask in masks if mask is not None]
    return np.concatenate([mask.ravel() for mask in own])[None] if is_whole else own[0]


def _panels(one: SingleView, pose: LevelPose, walls: Sequence[Plane]) -> list[Plane]:
    own_walls = [pose.inverse.plane(wall) for wall in walls]
    return [pose.plane(panel) for panel in find_wall_panels(one.view, own_walls)]


def _landmarks(one: SingleView) -> tuple[Landmark, ...]:
    floor = floor_plane(one.room.grid, one.is_floor, one.floor_material or DEFAULT_FLOOR)
    return find_landmarks(one.view, (floor, *one.planes), one.height_map, one.free_space, one.seats)


def floor_plane(grid: AlignedGrid, is_floor: GridBool, material: str, *, is_whole: bool = False) -> Plane:
    """The floor as a rectangle from below the radar to behind the farthest point.

    Args:
        grid: Depth grid in the radar's frame.
        is_floor: Cells of the floor, (row, column).
        material: Material of the floor.
        is_whole: Whether the grid also covers what is behind the radar; the floor then extends there.

    Returns:
        The rectangle, at least 3 x 3 m plus a margin of 0.3 m.
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
    """The minimum of the 2nd and the maximum of the 98th percentiles of several sets of coordinates, metres."""
    ends = [np.percentile(part, [2, 98]) for part in parts if len(part)]
    return float(min(end[0] for end in ends)), float(max(end[1] for end in ends))


def _general_assumptions(floor: Plane, *, has_classes: bool) -> tuple[str, ...]:
    """Assumptions made for every room, as sentences."""
    width, length = 2 * floor.half_size_m[0], 2 * floor.half_size_m[1]
    sentences = (
        "The radar stands level at the camera and points where the camera points.",
        f"The floor was extended to a level rectangle of {width:.1f} x {length:.1f} m, and walls down to it.",
        "Places below the picture's lower edge, before the visible floor, were assumed to be free.",
        ASSUMPTION_OF_CLASSES if has_classes else ASSUMPTION,
    )
    return tuple(map(UsualAssumption, sentences))


def _note(given: Sequence[LevelPose], placed: Sequence[LevelPose], others: Sequence[PosedPhoto]) -> str:
    """A sentence with the number of photos that were fused and how far the walls moved them."""
    pairs = list(zip(given, placed, strict=True))
    shifts_m = [float(np.linalg.norm(b.position_m - a.position_m)) for a, b in pairs]
    turns_deg = [abs(np.degrees(np.angle(np.exp(1j * (b.azimuth_rad - a.azimuth_rad))))) for a, b in pairs]
    rough = [one.is_rough for one in others]
    how = f"{sum(rough)} of them by rough places" if any(rough) else "by their poses"
    moves = enumerate(zip(rough, shifts_m, turns_deg, strict=True), start=2)
    unmoved = [str(number) for number, (is_rough, shift_m, turn_deg) in moves if is_rough and not shift_m + turn_deg]
    alone = f" Nothing in photo {', '.join(unmoved)} bears out where it was taken: that stays as stated."
    return (
        f"{1 + len(others)} photos were joined, {how}; common walls moved them by up to {max(shifts_m):.2f} m and"
        f" {max(turns_deg):.1f} degrees.{alone if unmoved else ''}"
    )
