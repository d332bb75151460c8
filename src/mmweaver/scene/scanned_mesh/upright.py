"""A mesh in metres with gravity along -z: unit and upward direction are checked against the size of rooms."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from mmweaver.core.errors import InputError
from mmweaver.core.shapes import Array
from mmweaver.scene.scanned_mesh.read_mesh import ColouredMesh

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
