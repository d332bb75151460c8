"""Wide photos with depth and classes of a mesh, taken at the radar's position; the room is reconstructed from them.

Each picture spans 100 degrees, one per quarter of the horizon: walls to the sides of the radar and behind it return its
strongest echoes.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import ClassMask, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.scene.coco_stuff import CLASS_OF_MATERIAL, MATERIAL, NAMES, UNLABELED, coco_class
from mmweaver.scene.photo.camera_file import centred_intrinsics
from mmweaver.scene.photo.capture_photo import CapturedPhoto
from mmweaver.scene.photo.posed_photo import PosedPhoto
from mmweaver.scene.scanned_mesh.read_mesh import ColouredMesh, read_mesh
from mmweaver.scene.scanned_mesh.upright import upright
from mmweaver.scene.scanned_mesh.viewpoint import Viewpoint, find_viewpoint

WIDTH, HEIGHT, VIEW_DEG = 640, 480, 100.0
UPWARDS_RAD = np.deg2rad(40.0)
MAX_NAMES = 12  # listed in a note
MIN_SEEN = 0.2  # share of a picture's pixels
TILT_RAD = np.deg2rad(-8.0)  # slightly down, so that more of the near floor is visible


def read_mesh_photo(
    path: Path,
    *,
    eye: Sequence[float] | None = None,
    look_deg: float | None = None,
    unit: str | None = None,
    up: str | None = None,
    materials: Path | None = None,
) -> CapturedPhoto:
    """Renders the photos of a mesh (GLB, PLY, OBJ): one ahead of the radar, the others around it and up.

    Args:
        path: The mesh.
        eye: Position of the radar in the mesh's own axes and unit; None chooses one.
        look_deg: Boresight azimuth in degrees from the mesh's x axis, counterclockwise from above; None chooses one.
        unit: Unit of the file (m, cm, mm, inch, foot); None infers it.
        up: Axis that points up (y or z); None infers it.
        materials: JSON object from names in the mesh to COCO-Stuff classes or materials, such as {"Material.003":
            "couch", "pane": "glass"}; names that are classes need no entry.

    Returns:
        The photo ahead with the others posed relative to it, and the assumptions made.

    Raises:
        InputError: If the mesh or the table cannot be used, or hardly anything is visible from the position.
    """
    given = {} if materials is None else _table(materials)
    found = upright(path, read_mesh(path), unit=unit, up=up)
    mesh = found.mesh
    caster = RayCaster(mesh.vertices, mesh.faces)
    view = find_viewpoint(caster, mesh.vertices, None if eye is None else found.converted(np.asarray(eye, float)))
    if look_deg is not None:
        view = Viewpoint(eye_m=view.eye_m, azimuth_rad=float(np.deg2rad(look_deg)))
    classes = _classes(mesh, given)
    first_axes = _camera_axes(view.azimuth_rad)
    photo, share = _photo(mesh, caster, view.eye_m, first_axes, classes)
    if share < MIN_SEEN:
        raise InputError(f"{path}: from the radar's place hardly anything of the mesh is seen; give another place")
    around = [(axes, *_photo(mesh, caster, view.eye_m, axes, classes)) for axes in _axes_around(view.azimuth_rad)]
    others = [PosedPhoto(photo=one, pose=_pose(first_axes, axes)) for axes, one, share in around if share >= MIN_SEEN]
    place = ", ".join(f"{value:.2f}" for value in view.eye_m)
    chosen = "given" if eye is not None else "chosen"
    notes = (
        f"The radar's place in the mesh, {place} m (z above its floor), was {chosen}; it looks at"
        f" {np.rad2deg(view.azimuth_rad):.0f} degrees from the mesh's x axis.",
        *found.assumptions,
        *_unused(mesh, given),
        *(() if mesh.has_colours else ("The mesh has no colours: materials follow from names and geometry alone.",)),
    )
    return CapturedPhoto(photo=photo, folder=path.parent, files={"mesh": path}, assumptions=notes, others=tuple(others))


def _axes_around(azimuth_rad: float) -> list[np.ndarray]:
    """Axes of cameras that look at the other three quarters of the horizon, and ahead at the ceiling."""
    quarters = [_camera_axes(azimuth_rad + quarter * np.pi / 2) for quarter in (1, 2, 3)]
    return [*quarters, _camera_axes(azimuth_rad, UPWARDS_RAD)]


def _pose(first_axes: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Transform (4, 4) from another camera at the same position to the first."""
    pose = np.eye(4)
    pose[:3, :3] = first_axes @ axes.T
    return pose


def _photo(
    mesh: ColouredMesh, caster: RayCaster, eye_m: np.ndarray, axes: np.ndarray, classes: np.ndarray | None
) -> tuple[RgbdPhoto, float]:
    """The picture from a position, and the share of its pixels that show anything."""
    camera = centred_intrinsics(WIDTH, HEIGHT, WIDTH / 2 / np.tan(np.deg2rad(VIEW_DEG) / 2))
    rays = viewing_rays(camera).reshape(-1, 3) @ axes
    length = np.linalg.norm(rays, axis=1)
    distance_m, face = caster.first_hit(np.broadcast_to(eye_m, rays.shape), rays / length[:, None])
    is_hit = face >= 0
    rgb = np.where(is_hit[:, None], mesh.rgb[np.maximum(face, 0)], 0).astype(np.uint8)
    depth_m = np.where(is_hit, distance_m / length, np.nan)
    mask = None
    if classes is not None:
        index = np.where(is_hit, classes[mesh.name[np.maximum(face, 0)]], 0)
        mask = ClassMask(index=index.reshape(HEIGHT, WIDTH).astype(np.uint8), names=NAMES)
    shape = (HEIGHT, WIDTH)
    photo = RgbdPhoto(rgb=rgb.reshape(*shape, 3), depth_m=depth_m.reshape(shape), intrinsics=camera, classes=mask)
    return photo, float(is_hit.mean())


def _camera_axes(azimuth_rad: float, tilt_rad: float = TILT_RAD) -> np.ndarray:
    """Rows: the camera's x (right), y (down) and z (ahead) in the mesh's upright frame."""
    ahead = np.array([np.cos(azimuth_rad), np.sin(azimuth_rad), 0.0])
    right = np.array([ahead[1], -ahead[0], 0.0])
    looking = np.cos(tilt_rad) * ahead + np.sin(tilt_rad) * np.array([0.0, 0.0, 1.0])
    return np.stack([right, np.cross(looking, right), looking])


def _classes(mesh: ColouredMesh, given: dict[str, str]) -> np.ndarray | None:
    """Class of each name of the mesh, as an index into NAMES; None if no name implies a class."""
    index = np.array([NAMES.index(given.get(name) or _class_in(name)) for name in mesh.names])
    return index if index.any() else None


def _class_in(name: str) -> str:
    """The class that a name of a mesh mentions, such as "Sofa.001" or "wall_north"."""
    if (whole := coco_class(name.rstrip(".0123456789"))) is not None:
        return whole
    words = "".join(one if one.isalpha() else " " for one in name.lower()).split()
    pairs = [" ".join(words[at : at + 2]) for at in range(len(words) - 1)]
    return next((found for word in (*pairs, *words) if (found := coco_class(word)) is not None), UNLABELED)


def _unused(mesh: ColouredMesh, given: dict[str, str]) -> tuple[str, ...]:
    """Reports table entries that the mesh does not have, and the names it has, since misspelt names have no effect."""
    unused = [name for name in given if name not in mesh.names]
    if not unused:
        return ()
    has = ", ".join(repr(name[:40]) for name in mesh.names[:MAX_NAMES] if name) or "no names at all"
    return (f"The mesh has no {', '.join(repr(name[:40]) for name in unused[:MAX_NAMES])}; it has {has}.",)


def _table(path: Path) -> dict[str, str]:
    content: Any = read_json(path)
    if not isinstance(content, dict):
        raise InputError(f'{path} is no JSON object of names and classes, such as {{"Material.003": "couch"}}')
    table = {}
    for name, label in content.items():
        known = CLASS_OF_MATERIAL.get(str(label)) or coco_class(str(label))
        if known is None:
            materials = ", ".join(sorted({*MATERIAL.values()} & {*CLASS_OF_MATERIAL}))
            raise InputError(f"{path}: {name!r} is {str(label)[:40]!r}, no class of COCO-Stuff and none of {materials}")
        table[name] = known
    return table
