"""Wide photos with depth and classes of a mesh, taken at the radar's position; the room is reconstructed from them.

Each picture spans 100 degrees, one per quarter of the horizon: walls to the sides of the radar and behind it return its
strongest echoes.

A radar position in a scanned room: near a wall, with much of the room ahead.

A mesh in metres with gravity along -z: unit and upward direction are checked against the size of rooms.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import ClassMask, RgbdPhoto
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.shapes import Array, Vec3
from mmweaver.scene.coco_stuff import CLASS_OF_MATERIAL, MATERIAL, NAMES, UNLABELED, coco_class
from mmweaver.scene.photo.camera_file import centred_intrinsics
from mmweaver.scene.photo.capture_photo import CapturedPhoto, PosedPhoto
from mmweaver.scene.scanned_mesh.read_mesh import ColouredMesh, read_mesh

UNITS_M = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}
GUESSED = ("m", "cm", "mm")  # for files without a unit; glTF is in metres
HEIGHT_M, WIDTH_M = (1.6, 12.0), (1.5, 80.0)  # of rooms
LEVEL = np.cos(np.deg2rad(12))  # cosine between up and the normals of level surfaces, at least
MIN_LEVEL = 0.08  # share of the area: of floors, and tops of furniture
FLOOR_BIN_M = 0.05
MAX_FLOOR_M, SLAB_SHARE = 0.4, 0.7  # of a modelled slab: its top has nearly the area of its underside
CLEARLY_MORE = 1.2  # ratio of level area with another axis up, to report it
UPWARDS = {"y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True, kw_only=True)
class UprightMesh:
    """A mesh in metres, z up, its floor at z = 0."""

    mesh: ColouredMesh
    to_mesh: Float[Array, "3 3"]  # rows: x, y, z of this frame in the file's axes
    unit_m: float
    floor: float  # height of the floor along the upward direction, in the file's unit
    assumptions: tuple[str, ...]

    def converted(self, place: np.ndarray) -> np.ndarray:
        """Converts a position from the file's axes and unit to this frame.

        Args:
            place: Position in the file's axes and unit, (3,).

        Returns:
            Metres in this frame, (3,).
        """
        return self.unit_m * (self.to_mesh @ place - np.array([0.0, 0.0, self.floor]))


def upright(path: Path, mesh: ColouredMesh, *, unit: str | None = None, up: str | None = None) -> UprightMesh:
    """Finds unit, upward direction and floor of a mesh.

    Args:
        path: File of the mesh; glTF is in metres with y up.
        mesh: The mesh as stored.
        unit: Key of UNITS_M; None infers it from the size of rooms.
        up: "y" or "z"; None infers it from the area of level surfaces.

    Returns:
        The mesh in metres, z up, floor at 0.

    Raises:
        InputError: If the mesh is not a room: no plausible size in any unit, or no level surfaces.
    """
    if unit is not None and unit not in UNITS_M:
        raise InputError(f"unknown unit {unit!r}; known: {', '.join(UNITS_M)}")
    if up is not None and up not in UPWARDS:
        raise InputError(f"up must be y or z, not {up!r}")
    normals, area = _normals_and_areas(mesh)
    named = "y" if path.suffix.lower() == ".glb" else None  # glTF: +y is up
    level = {name: float(area[np.abs(normals @ along) > LEVEL].sum()) for name, along in UPWARDS.items()}
    axis = up or named or max(level, key=lambda name: level[name])
    direction, is_level = _refined(np.array(UPWARDS[axis]), normals, area)
    if area[is_level].sum() < MIN_LEVEL * area.sum():
        raise InputError(f"{path}: no level surfaces with {axis} up; say which axis is up, or turn the mesh upright")
    to_mesh = _axes(direction)
    turned = mesh.vertices @ to_mesh.T
    unit_m, said = _unit(path, turned, unit or ("m" if named else None))
    floor = _floor(turned[:, 2], mesh.faces[is_level], area[is_level], unit_m)
    notes = [] if up or named else [f"{axis} was taken as upwards: more of the mesh is level that way."]
    if named and not up and level["z"] > CLEARLY_MORE * level["y"]:
        notes = [
            "y was taken as upwards, as glTF says, though more of the mesh is level with z up: if the room lies on its"
            " side, z is up (--mesh-set up=z)."
        ]
    moved = replace(mesh, vertices=unit_m * (turned - np.array([0.0, 0.0, floor])))
    return UprightMesh(mesh=moved, to_mesh=to_mesh, unit_m=unit_m, floor=floor, assumptions=(*notes, *said))


def _normals_and_areas(mesh: ColouredMesh) -> tuple[np.ndarray, np.ndarray]:
    corners = mesh.vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1)
    return normals / np.maximum(length, 1e-300)[:, None], length / 2


def _refined(up: np.ndarray, normals: np.ndarray, area: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mean normal of the surfaces that are nearly level, and which these are."""
    for _ in range(2):
        is_level = np.abs(normals @ up) > LEVEL
        if not is_level.any():
            return up, is_level
        signed = normals[is_level] * np.sign(normals[is_level] @ up)[:, None]
        mean = (signed * area[is_level][:, None]).sum(axis=0)
        up = mean / np.linalg.norm(mean)
    return up, is_level


def _axes(up: np.ndarray) -> np.ndarray:
    """A right-handed frame whose third axis is up."""
    x = np.cross((0.0, 0.0, 1.0) if abs(up[1]) > abs(up[2]) else (0.0, 1.0, 0.0), up)
    x /= -np.linalg.norm(x) if abs(up[1]) <= abs(up[2]) else np.linalg.norm(x)
    x = x if x[0] >= 0 else -x
    return np.stack([x, np.cross(up, x), up])


def _unit(path: Path, turned: np.ndarray, unit: str | None) -> tuple[float, tuple[str, ...]]:
    """The unit in which the mesh has the size of a room, and the assumption made."""
    low, high = np.percentile(turned, [1, 99], axis=0)
    width, height = float((high - low)[:2].max()), float((high - low)[2])
    if unit is not None:
        if not WIDTH_M[0] <= width * UNITS_M[unit] <= WIDTH_M[1]:
            fitting = [name for name in GUESSED if HEIGHT_M[0] <= height * UNITS_M[name] <= HEIGHT_M[1]]
            other = f"; in {fitting[0]} it would be {width * UNITS_M[fitting[0]]:.3g} m" if fitting else ""
            raise InputError(f"{path} is {width * UNITS_M[unit]:.3g} m wide in {unit}; is that the right unit{other}?")
        return UNITS_M[unit], ()
    for name in GUESSED:
        fits = WIDTH_M[0] <= width * UNITS_M[name] <= WIDTH_M[1] and height * UNITS_M[name] <= HEIGHT_M[1]
        if fits and height * UNITS_M[name] >= HEIGHT_M[0]:
            note = f"The mesh's unit was taken as {name}, in which it is {height * UNITS_M[name]:.1f} m high."
            return UNITS_M[name], (note,)
    raise InputError(f"{path} is {width:.3g} wide and {height:.3g} high, no room's size in m, cm or mm; say its unit")


def _floor(height: np.ndarray, faces: np.ndarray, area: np.ndarray, unit_m: float) -> float:
    """The lowest height with much level surface; of a slab its top, on which people stand."""
    middle = unit_m * height[faces].mean(axis=1)
    bins = np.floor((middle - middle.min()) / FLOOR_BIN_M).astype(int)
    held = np.bincount(bins, weights=area)
    lowest = int(np.flatnonzero(held > 0.15 * held.max())[0])
    slab = held[lowest : lowest + round(MAX_FLOOR_M / FLOOR_BIN_M) + 1]
    top = lowest + int(np.flatnonzero(slab > SLAB_SHARE * held[lowest])[-1])
    chosen = np.abs(bins - top) <= 1
    order = np.argsort(middle[chosen])
    share = np.cumsum(area[chosen][order])
    return float(middle[chosen][order][np.searchsorted(share, share[-1] / 2)] / unit_m)


EYE_HEIGHT_M = 1.2
STEP_M, MIN_FREE = 0.4, 4  # between candidates; free neighbours of a place
HEAD_M, FOOT_M = 1.9, 0.12
FAR_M = 6.0  # larger distances do not count
_DIRECTIONS = 48
_HALF_VIEW = 6  # directions to either side: 45 degrees
_MAX_CANDIDATES = 400


@dataclass(frozen=True, kw_only=True)
class Viewpoint:
    """A position in metres (z up, floor at 0) and the boresight azimuth, from +x towards +y."""

    eye_m: Vec3
    azimuth_rad: float


def find_viewpoint(caster: RayCaster, vertices_m: np.ndarray, place_m: Vec3 | None = None) -> Viewpoint:
    """Finds the position above free floor, near a wall, with most of the room ahead.

    Args:
        caster: Ray caster of the upright mesh.
        vertices_m: Vertices of the mesh in metres, (vertex, 3).
        place_m: Fixed position in metres, (3,); only the azimuth is then chosen. None searches a grid.

    Returns:
        Position and azimuth.

    Raises:
        InputError: If no floor is free.
    """
    places = _free_places(caster, vertices_m) if place_m is None else np.asarray(place_m, float)[None]
    if not len(places):
        raise InputError("the mesh has no free floor below 1.9 m of air; give the place of the radar")
    azimuth = np.arange(_DIRECTIONS) * 2 * np.pi / _DIRECTIONS
    rays = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(_DIRECTIONS)], axis=-1)
    origins = np.repeat(places, _DIRECTIONS, axis=0)
    reach = np.minimum(caster.distance_m(origins, np.tile(rays, (len(places), 1))), FAR_M).reshape(len(places), -1)
    ahead = np.mean([np.roll(reach, shift, axis=1) for shift in range(-_HALF_VIEW, _HALF_VIEW + 1)], axis=0)
    behind = np.roll(reach, _DIRECTIONS // 2, axis=1)
    best, look = np.unravel_index(np.argmax(ahead - 0.5 * behind), ahead.shape)
    return Viewpoint(eye_m=places[best], azimuth_rad=float(azimuth[look]))


def _free_places(caster: RayCaster, vertices_m: np.ndarray) -> np.ndarray:
    """Places at eye height over a grid of free floor, (place, 3)."""
    low, high = np.percentile(vertices_m[:, :2], [1, 99], axis=0)
    step_m = max(STEP_M, float(np.sqrt(np.prod(high - low) / _MAX_CANDIDATES)))
    x, y = np.meshgrid(*(np.arange(a + step_m / 2, b, step_m) for a, b in zip(low, high, strict=True)))
    above = np.stack([x, y, np.full(x.shape, HEAD_M)], axis=-1)
    flat = above.reshape(-1, 3)
    down = np.broadcast_to((0.0, 0.0, -1.0), flat.shape)
    is_free = (np.abs(caster.distance_m(flat, down) - HEAD_M) < FOOT_M).reshape(x.shape)
    padded = np.pad(is_free, 1)
    around = sum(padded[1 + r : 1 + r + len(x), 1 + c : 1 + c + x.shape[1]].astype(int) for r, c in _AROUND)
    chosen = is_free & (around >= min(MIN_FREE, 2)) if is_free.any() else is_free
    return np.stack([x[chosen], y[chosen], np.full(chosen.sum(), EYE_HEIGHT_M)], axis=-1)


_AROUND = ((0, 1), (1, 0), (0, -1), (-1, 0))


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
