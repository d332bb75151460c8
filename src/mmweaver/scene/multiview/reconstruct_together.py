"""One room from several photos of it, or from views of a scan. Read `reconstruct_together` first."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mmweaver.core.records import Plane, RgbdPhoto, Scene
from mmweaver.scene.affordances.free_space import find_assumed_floor
from mmweaver.scene.affordances.landmarks import find_landmarks
from mmweaver.scene.layout.gravity import room_gravity
from mmweaver.scene.layout.mesh import joined_meshes, rectangle_faces
from mmweaver.scene.layout.panes import add_wall_panels, find_wall_panels
from mmweaver.scene.layout.room_layout import estimate_layout
from mmweaver.scene.layout.surface_materials import MATERIAL_NAMES
from mmweaver.scene.multiview.fusion import (
    joined_free_space,
    joined_grid,
    joined_landmarks,
    joined_planes,
    joined_seats,
)
from mmweaver.scene.multiview.registration import (
    AT_FIRST,
    SPREAD_M,
    LevelPose,
    common_gravity,
    height_map,
    moved_by_walls,
    shift_by_heights,
    turned_by_walls,
)
from mmweaver.scene.photo.depth_grid import make_grid
from mmweaver.scene.photo.posed_photo import PosedPhoto
from mmweaver.scene.reconstruction import (
    DEFAULT_FLOOR,
    floor_plane,
    general_assumptions,
    reconstruct,
)
from mmweaver.scene.single_view import SingleView, see


def reconstruct_together(photo: RgbdPhoto, others: Sequence[PosedPhoto], *, assumptions: tuple[str, ...] = ()) -> Scene:
    """The room of several photos, in the frame of a level radar that stands at the first photo's camera.

    The first photo stays the scene's picture. Raises InputError where the depth of one shows no surfaces.
    """
    if not others:
        return reconstruct(photo, assumptions=assumptions)
    # 1. Gravity of all together; what each photo shows by itself, brought onto what the earlier ones show.
    gravities, poses = common_gravity([room_gravity(make_grid(one)) for one in (photo, *_photos(others))], others)
    seen = [see(one, gravity) for one, gravity in zip((photo, *_photos(others)), gravities, strict=True)]
    placed = _corrected(seen, poses, others)

    # 2. Room layout by the cells of all photos; panels by each photo's classes.
    grid = joined_grid(seen, placed)
    pairs = list(zip(seen, placed, strict=True))
    planes = joined_planes([pose.plane(plane) for one, pose in pairs for plane in one.smooth_planes])
    layout = estimate_layout(grid, planes, _is_wall(seen), is_whole=True)
    walls = [plane for plane in layout.planes if plane.kind == "wall"]
    panels = joined_planes([panel for one, pose in pairs for panel in _panels(one, pose, walls)])
    is_floor = np.concatenate([one.is_floor.ravel() for one in seen])[None]
    material = next((one.floor_material for one in seen if one.floor_material), DEFAULT_FLOOR)
    floor = floor_plane(grid, is_floor, material, is_whole=True)

    # 3. Places for people.
    free = joined_free_space(seen, placed)
    assumed = find_assumed_floor(seen[0].height_map, seen[0].view, walls, free.is_free)
    landmarks = [pose.landmark(one) for own, pose in pairs for one in _landmarks(own)]
    seats = [pose.seat(seat) for one, pose in pairs for seat in one.seats]

    # 4. Meshes of all photos, for the ray caster.
    meshes = [(one.mesh(), pose) for one, pose in pairs]
    moved = [(pose.points(mesh[0]), *mesh[1:]) for mesh, pose in meshes]
    vertices_m, faces, face_material = joined_meshes([*moved, rectangle_faces([floor, *layout.extended])])
    notes = tuple(dict.fromkeys(note for one in seen for note in one.assumptions))
    has_classes = any(one.view.photo.classes is not None for one in seen)
    return Scene(
        photo=seen[0].view.photo, radar_from_camera=seen[0].room.radar_from_camera, vertices_m=vertices_m, faces=faces,
        face_material=face_material, material_names=MATERIAL_NAMES,
        planes=(floor, *add_wall_panels(layout.planes, panels, layout.extended)),
        floor_z_m=seen[0].view.floor_z_m, free_space=replace(free, is_assumed=assumed), seats=joined_seats(seats),
        landmarks=joined_landmarks(landmarks),
        assumptions=(
            *assumptions, _note(poses, placed[1:], others), *notes, *layout.assumptions,
            *general_assumptions(floor, has_classes=has_classes),
        ),
    )  # fmt: skip


def _photos(others: Sequence[PosedPhoto]) -> tuple[RgbdPhoto, ...]:
    return tuple(one.photo for one in others)


def _corrected(
    seen: Sequence[SingleView], poses: Sequence[LevelPose], others: Sequence[PosedPhoto]
) -> tuple[LevelPose, ...]:
    """The level pose of every photo, the first's first, each corrected by what those before it show."""
    placed, known, floor_z_m = [AT_FIRST], list(seen[0].planes), seen[0].view.floor_z_m
    heights = height_map(_points(seen[0], AT_FIRST), floor_z_m)
    for one, pose, other in zip(seen[1:], poses, others, strict=True):
        pose = turned_by_walls(pose, one.planes, known, is_rough=other.is_rough)
        if other.is_rough:
            own = height_map(_points(one, pose), floor_z_m)
            pose = pose.moved(shift_by_heights(own, heights, SPREAD_M[True]))
        pose = moved_by_walls(pose, one.planes, known, is_rough=False)
        placed.append(pose)
        known += [pose.plane(plane) for plane in one.planes]
        heights = np.fmax(heights, height_map(_points(one, pose), floor_z_m))
    return tuple(placed)


def _points(one: SingleView, pose: LevelPose) -> np.ndarray:
    return pose.points(one.room.grid.points_m.reshape(-1, 3))


def _is_wall(seen: Sequence[SingleView]) -> np.ndarray | None:
    """The cells (1, cell) that class masks label as wall; None unless every photo has a mask."""
    masks = [one.is_wall for one in seen]
    if any(mask is None for mask in masks):
        return None
    return np.concatenate([mask.ravel() for mask in masks if mask is not None])[None]


def _panels(one: SingleView, pose: LevelPose, walls: Sequence[Plane]) -> list[Plane]:
    own_walls = [pose.inverse.plane(wall) for wall in walls]
    return [pose.plane(panel) for panel in find_wall_panels(one.view, own_walls)]


def _landmarks(one: SingleView):
    material = one.floor_material or DEFAULT_FLOOR
    floor = floor_plane(one.room.grid, one.is_floor, material)
    return find_landmarks(one.view, (floor, *one.planes), one.height_map, one.free_space, one.seats)


def _note(given: Sequence[LevelPose], placed: Sequence[LevelPose], others: Sequence[PosedPhoto]) -> str:
    """A sentence that says how many photos were joined and how far walls moved them."""
    shifts_m = [np.linalg.norm(b.position_m - a.position_m) for a, b in zip(given, placed, strict=True)]
    turns_deg = [
        abs(np.degrees(np.angle(np.exp(1j * (b.azimuth_rad - a.azimuth_rad)))))
        for a, b in zip(given, placed, strict=True)
    ]
    rough = [one.is_rough for one in others]
    how = "by their poses" if not any(rough) else f"{sum(rough)} of them by rough places"
    unmoved = [
        str(number)
        for number, (is_rough, shift_m, turn_deg) in enumerate(zip(rough, shifts_m, turns_deg, strict=True), start=2)
        if is_rough and shift_m == 0 and turn_deg == 0
    ]
    alone = f" Nothing in photo {', '.join(unmoved)} bears out where it was taken: that stays as stated."
    return (
        f"{1 + len(others)} photos were joined, {how}; common walls moved them by up to {max(shifts_m):.2f} m and"
        f" {max(turns_deg):.1f} degrees.{alone if unmoved else ''}"
    )
