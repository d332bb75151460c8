"""Renders the photo of a procedural room by ray casting: colour under a lighting, depth and class of each pixel.

Noise model of a stereo depth camera such as the RealSense D455.

Procedural textures: reflectance from surface coordinates, by value noise on a lattice.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import CameraIntrinsics, ClassMask
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array, DepthPixels, RgbPixels, Rotation, Vec3
from mmweaver.scene.procedural.lighting import LIGHTINGS, Lighting, area_lights, denoised, irradiance
from mmweaver.scene.procedural.meshing import Mesh
from mmweaver.scene.procedural.palette import TABLES
from mmweaver.scene.procedural.parts import Appearance, PlacedPiece

Plane2 = Float[Array, "point 2"]
Shade = Float[Array, " point"]
Rgb = Float[Array, "point 3"]
_TABLE = stream(0, "procedural", "lattice").uniform(-1, 1, (64, 64)).astype(np.float32)


def lattice_noise(points: Plane2, scale_m: float | tuple[float, float]) -> Shade:
    """Value noise in -1 to 1: random values on a lattice, interpolated.

    Args:
        points: Surface coordinates in metres, (point, 2).
        scale_m: Spacing of the lattice in metres, one or one per coordinate.

    Returns:
        Noise (point,).
    """
    place = points / np.asarray(scale_m, np.float32)
    cell = np.floor(place)
    fraction = place - cell
    blend = fraction * fraction * (3 - 2 * fraction)
    index = cell.astype(np.int32)
    a, b = index[:, 0] & 63, index[:, 1] & 63
    c, d = (a + 1) & 63, (b + 1) & 63
    low = _TABLE[a, b] + (_TABLE[c, b] - _TABLE[a, b]) * blend[:, 0]
    high = _TABLE[a, d] + (_TABLE[c, d] - _TABLE[a, d]) * blend[:, 0]
    return low + (high - low) * blend[:, 1]


def albedo(appearance: Appearance, plane: Plane2) -> Rgb:
    """Reflectance of a surface with its texture.

    Args:
        appearance: Colour and pattern.
        plane: Surface coordinates in metres, (point, 2).

    Returns:
        Linear RGB, (point, 3).
    """
    colour = np.asarray(appearance.colour, np.float32)
    layers = _NOISE.get(appearance.pattern)
    made = PATTERNS[appearance.pattern](plane, colour) if layers is None else _noise(plane, layers)
    return made if made.ndim == 2 else colour * made[:, None]


def _random(cell: np.ndarray, other: np.ndarray) -> Shade:
    """A random number in 0 to 1 for each pair of integers."""
    return _TABLE[(cell * 7 + other * 13).astype(int) & 63, (cell * 3 - other * 5).astype(int) & 63] / 2 + 0.5


# Each texture maps surface coordinates, (point, 2) metres, and a base colour (3,) to a factor of that colour, (point,),
# or to colours, (point, 3).
def _noise(plane: Plane2, layers: tuple) -> Shade:
    """1 plus noise of each layer's amplitude and spacing."""
    shade: Any = 1
    for amplitude, scale_m in layers:
        shade = shade + amplitude * lattice_noise(plane, scale_m)
    return shade


def _boards(plane: Plane2, colour: np.ndarray) -> Shade:
    """Floorboards, 14 cm wide, 1.1 m long, staggered."""
    board = np.floor(plane[:, 0] / 0.14)
    along = plane[:, 1] / 1.1 + _random(board, board * 0)
    piece = np.floor(along)
    shade = 0.85 + 0.3 * _random(board, piece)
    grain = 0.10 * lattice_noise(plane + 0.37 * board[:, None], (0.013, 0.12))
    seam = (np.abs(plane[:, 0] / 0.14 - board - 0.5) > 0.485) | (np.abs(along - piece - 0.5) > 0.498)
    return shade * (1 + grain) * np.where(seam, 0.55, 1.0)


def _tiled(
    plane: Plane2,
    colour: np.ndarray,
    size: tuple[float, float],
    joint_m: float,
    spread: float,
    joint: float,
    bond: bool,
) -> Shade:
    row = np.floor(plane[:, 1] / size[1])
    shifted = plane[:, 0] / size[0] + (0.5 * (row % 2) if bond else 0.0)
    column = np.floor(shifted)
    inside = (np.abs(shifted - column - 0.5) < 0.5 - joint_m / size[0]) & (
        np.abs(plane[:, 1] / size[1] - row - 0.5) < 0.5 - joint_m / size[1]
    )
    shade = 1 - spread + 2 * spread * _random(column, row)
    return np.where(inside, shade * (1 + 0.05 * lattice_noise(plane, 0.04)), joint)


def _panels(plane: Plane2, colour: np.ndarray) -> Shade:
    panel = np.floor(plane[:, 0] / 0.6)
    seam = np.abs(plane[:, 0] / 0.6 - panel - 0.5) > 0.493
    return (
        (0.9 + 0.2 * _random(panel, panel)) * (1 + 0.12 * lattice_noise(plane, (0.02, 0.4))) * np.where(seam, 0.4, 1.0)
    )


def _books(plane: Plane2, colour: np.ndarray) -> Rgb:
    """A row of book spines about 3 cm wide: each with its own shade and a band for the title."""
    spine = np.floor(plane[:, 0] / 0.031)
    tint = np.stack([_random(spine, spine * 0 + k) for k in range(3)], axis=1)
    band = np.abs((plane[:, 1] % 0.33) - 0.2) < 0.012
    mixed = colour * (0.5 + 0.5 * tint[:, :1]) + 0.22 * (tint - 0.4) * tint[:, 1:2]
    edge = np.abs(plane[:, 0] / 0.031 - spine - 0.5) > 0.44
    mixed = np.where(band[:, None], mixed + 0.2, mixed) * np.where(edge, 0.35, 1.0)[:, None]
    return np.clip(mixed, 0.01, 0.9)


def _screen(plane: Plane2, colour: np.ndarray) -> Rgb:
    """Windows and lines of text."""
    line = (np.floor(plane[:, 1] / 0.012) % 2 == 0) & (lattice_noise(plane, (0.06, 0.012)) > -0.1)
    window = lattice_noise(plane, 0.2) > 0.0
    paper = np.where(window[:, None], np.array([0.5, 0.52, 0.55]), colour + 0.05)
    return np.where((line & window)[:, None], 0.15, paper).astype(np.float32)


def _scribbles(plane: Plane2, colour: np.ndarray) -> Rgb:
    strokes = np.abs(lattice_noise(plane, 0.07)) < 0.05
    strokes &= lattice_noise(plane, 0.45) > 0.15
    ink = np.where((lattice_noise(plane, 0.6) > 0)[:, None], np.array([0.05, 0.08, 0.4]), np.array([0.4, 0.05, 0.05]))
    return np.where(strokes[:, None], ink, colour).astype(np.float32)


def _picture(plane: Plane2, colour: np.ndarray) -> Rgb:
    """Hills under a sky."""
    high = plane[:, 1] % 1.0
    ridge = 0.45 + 0.12 * lattice_noise(np.stack([plane[:, 0], plane[:, 0] * 0 + 0.3], 1), 0.16)
    near = 0.36 + 0.08 * lattice_noise(np.stack([plane[:, 0], plane[:, 0] * 0 + 0.9], 1), 0.1)
    sky = np.array([0.75, 0.5, 0.3]) * (1 - high[:, None]) + np.array([0.25, 0.4, 0.65]) * high[:, None]
    made = np.where((high < ridge)[:, None], np.array([0.18, 0.22, 0.22]), sky)
    return np.where((high < near)[:, None], np.array([0.07, 0.12, 0.05]), made).astype(np.float32)


def _sky(plane: Plane2, colour: np.ndarray) -> Rgb:
    cloud = np.clip(lattice_noise(plane, 0.7) + 0.5 * lattice_noise(plane, 0.25), 0, 1)[:, None]
    return (colour * (1 - 0.5 * cloud) + 0.4 * cloud).astype(np.float32)


def _keys(plane: Plane2, colour: np.ndarray) -> Shade:
    gap = (np.abs((plane[:, 0] % 0.019) - 0.0095) > 0.008) | (np.abs((plane[:, 1] % 0.019) - 0.0095) > 0.008)
    return np.where(gap, 0.4, 1.6)


_NOISE = TABLES["noise"]
PATTERNS: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "boards": _boards,
    "tiles": partial(_tiled, size=(0.3, 0.3), joint_m=0.004, spread=0.05, joint=0.7, bond=False),
    "brick": partial(_tiled, size=(0.24, 0.075), joint_m=0.006, spread=0.25, joint=1.6, bond=True),
    "panels": _panels,
    "books": _books,
    "screen": _screen,
    "scribbles": _scribbles,
    "picture": _picture,
    "sky": _sky,
    "keys": _keys,
}


BASELINE_M = 0.095  # of the D455
_STEP_PX, _NOISE_PX = 1 / 32, 0.06
_NEAREST_M, _FARTHEST_M = 0.4, 8.0
_GRAZING = 0.12  # cosine below which surfaces are often lost


def measured_depth(
    depth_m: DepthPixels,
    focal_px: float,
    is_glass: Bool[Array, "height width"],
    cos_view: Float[Array, "height width"],
    seed: int,
) -> DepthPixels:
    """Simulates a stereo measurement: noise and quantization of the disparity, and holes.

    Holes are occlusions of the second camera, glass, surfaces seen at grazing angles, speckles, and depths outside 0.4
    to 8 m.

    Args:
        depth_m: True depth in metres, (height, width).
        focal_px: Focal length in pixels.
        is_glass: Pixels of glass, (height, width).
        cos_view: Cosine between ray and surface normal, (height, width).
        seed: Seed of the noise.

    Returns:
        Measured depth in metres, (height, width), nan in holes.
    """
    rng = stream(seed, "procedural", "depth")
    height, width = depth_m.shape
    blocks = (-(-height // 4), -(-width // 4))
    baseline = BASELINE_M * focal_px
    disparity = baseline / depth_m
    coarse = np.kron(rng.normal(0, _NOISE_PX, blocks), np.ones((4, 4)))[:height, :width]
    disparity = disparity + coarse + rng.normal(0, _NOISE_PX / 3, depth_m.shape)
    disparity = np.round(disparity / _STEP_PX) * _STEP_PX
    measured = baseline / np.maximum(disparity, _STEP_PX)
    lost = _occluded(baseline / depth_m) | (measured < _NEAREST_M) | (measured > _FARTHEST_M)
    lost |= np.kron(rng.random(blocks) < 0.002, np.ones((4, 4), bool))[:height, :width]
    lost |= (cos_view < _GRAZING) & (np.kron(rng.random(blocks), np.ones((4, 4)))[:height, :width] < 0.5)
    lost |= is_glass & (np.kron(rng.random(blocks), np.ones((4, 4)))[:height, :width] < 0.85)
    return np.where(lost, np.nan, measured)


def _occluded(disparity: Float[Array, "height width"]) -> Bool[Array, "height width"]:
    """Pixels occluded in the second camera: a strip left of near objects, as wide as the step in disparity."""
    occluded = np.zeros_like(disparity, dtype=bool)
    jump = disparity[:, 1:] - disparity[:, :-1]
    last = occluded.shape[-1] - 1
    for columns in range(1, 24):
        near = jump[:, columns - 1 :] > max(columns, 1.5)
        occluded[:, : last - columns + 1] |= near
    return occluded


_SENSOR_NOISE = 0.008


@dataclass(frozen=True, kw_only=True)
class CameraView:
    """The surface point of each pixel, in the room's frame."""

    face: Int[Array, "row column"]  # of the mesh
    depth_m: DepthPixels  # along the optical axis
    points_m: Float[Array, "row column 3"]
    normals: Float[Array, "row column 3"]  # towards the camera


def cast_view(
    mesh: Mesh, caster: RayCaster, camera: CameraIntrinsics, room_from_camera: Rotation, eye_m: Vec3
) -> CameraView:
    """Casts a ray through the centre of every pixel.

    Args:
        mesh: Mesh of the room.
        caster: Ray caster of this mesh.
        camera: Intrinsics.
        room_from_camera: Rotation from camera axes (x right, y down, z forward) to the room's frame, (3, 3).
        eye_m: Position of the camera in the room's frame, metres.

    Returns:
        Surface point, normal and depth of each pixel.
    """
    rays = viewing_rays(camera).reshape(-1, 3) @ room_from_camera.T
    length = np.linalg.norm(rays, axis=1)
    distance, face = caster.first_hit(np.broadcast_to(eye_m, rays.shape), rays / length[:, None])
    if (face < 0).any():
        # A ray may slip between two adjacent walls; take its neighbour's hit.
        hit = np.flatnonzero(face >= 0)
        lost = np.flatnonzero(face < 0)
        other = hit[np.minimum(np.searchsorted(hit, lost), len(hit) - 1)]
        distance[lost], face[lost] = distance[other], face[other]
    normals = _normals(mesh)[face]
    normals = np.where((normals * rays).sum(axis=1)[:, None] > 0, -normals, normals)
    depth = distance / length
    shape = (camera.height, camera.width)
    return CameraView(
        face=face.reshape(shape),
        depth_m=depth.reshape(shape),
        points_m=(eye_m + depth[:, None] * rays).reshape(*shape, 3),
        normals=normals.reshape(*shape, 3),
    )


def render_rgb(
    mesh: Mesh, caster: RayCaster, view: CameraView, placed: tuple[PlacedPiece, ...], lighting: str, seed: int
) -> RgbPixels:
    """Renders the colour picture.

    Args:
        mesh: Mesh of the room.
        caster: Ray caster of this mesh.
        view: Surface point of each pixel.
        placed: All pieces, among them the lights.
        lighting: Name in LIGHTINGS.
        seed: Seed of light sampling and sensor noise.

    Returns:
        sRGB picture, uint8, (row, column, 3).
    """
    light = LIGHTINGS[lighting]
    appearance = mesh.appearance[view.face]
    colour, emission = _reflectance_and_emission(mesh, view, appearance, light)
    half = (slice(0, None, 2), slice(0, None, 2))
    points, normals = view.points_m[half], view.normals[half]
    rng = stream(seed, "procedural", "light")
    received = irradiance(
        caster, area_lights(placed, light), light, points.reshape(-1, 3), normals.reshape(-1, 3), rng
    ).reshape(points.shape)
    received = _upsampled(denoised(received, points, normals), view)
    radiance = colour * (1.15 * received + 0.02) + emission
    value = 1.7 * light.exposure * radiance
    value = value * (1 + value / 9) / (1 + 0.75 * value)
    value = np.clip(value + _SENSOR_NOISE * rng.standard_normal(value.shape, dtype=np.float32), 0, 1)
    value = np.where(value < 0.0031308, 12.92 * value, 1.055 * np.maximum(value, 1e-9) ** (1 / 2.4) - 0.055)
    return np.round(255 * value).astype(np.uint8)


def render_classes(mesh: Mesh, view: CameraView) -> ClassMask:
    """The COCO-Stuff class of every pixel.

    Args:
        mesh: Mesh of the room.
        view: Surface point of each pixel.

    Returns:
        Mask (row, column) that names all classes of the room in alphabetical order.
    """
    names = ("unlabeled", *sorted({appearance.coco for appearance in mesh.appearances}))
    index = np.array([names.index(appearance.coco) for appearance in mesh.appearances], np.uint8)
    return ClassMask(index=index[mesh.appearance[view.face]], names=names)


def _normals(mesh: Mesh) -> Float[Array, "face 3"]:
    """Unit normals of the faces."""
    corners = mesh.vertices_m[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-15)[:, None]


def _reflectance_and_emission(
    mesh: Mesh, view: CameraView, appearance: np.ndarray, light: Lighting
) -> tuple[np.ndarray, np.ndarray]:
    """Reflectance and emitted light of every pixel, (row, column, 3) each, linear RGB."""
    flat_index = appearance.ravel()
    points, normals = view.points_m.reshape(-1, 3), view.normals.reshape(-1, 3)
    colour, emission = np.zeros(points.shape, np.float32), np.zeros(points.shape, np.float32)
    for index in np.unique(flat_index):
        one, chosen = mesh.appearances[index], np.flatnonzero(flat_index == index)
        plane = _surface_coordinates(points[chosen], normals[chosen])
        colour[chosen] = albedo(one, plane.astype(np.float32))
        if one.emission:
            emission[chosen] = one.emission * colour[chosen] * _emission(one.pattern, light)
    return colour.reshape(*appearance.shape, 3), emission.reshape(*appearance.shape, 3)


def _emission(pattern: str, light: Lighting) -> np.ndarray:
    """Brightness of an emitting pane, ceiling panel, lamp shade or screen under a lighting, (3,)."""
    if pattern == "sky":
        return np.minimum(np.array(light.window) / 5, 1.5)
    if pattern == "panel":
        return np.minimum(np.array(light.ceiling) / 3.5, 1.2)
    return np.ones(3) if pattern == "screen" else np.minimum(np.array(light.lamp) / 4, 1.5)


def _surface_coordinates(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Two coordinates along the surface, (point, 2) metres: all but the normal's dominant axis, the height second."""
    drop = np.argmax(np.abs(normals), axis=1)
    kept = np.array([[1, 2], [0, 2], [0, 1]])[drop]
    return np.take_along_axis(points, kept, axis=1)


def _upsampled(light: np.ndarray, view: CameraView) -> np.ndarray:
    """Joint bilateral upsampling of light from every second pixel: from the four neighbours on the same surface."""
    rows, columns = view.depth_m.shape
    low_row, low_column = np.arange(rows) // 2, np.arange(columns) // 2
    points, normals = view.points_m.astype(np.float32), view.normals.astype(np.float32)
    total = np.zeros((rows, columns, 3), np.float32)
    weights = np.zeros((rows, columns), np.float32)
    last_row, last_column = light.shape[0] - 1, light.shape[1] - 1
    for row in (0, 1):
        for column in (0, 1):
            at_row = np.minimum(low_row + row * (np.arange(rows) % 2), last_row)
            at_column = np.minimum(low_column + column * (np.arange(columns) % 2), last_column)
            full = np.ix_(2 * at_row, 2 * at_column)
            off = np.abs(((points[full] - points) * normals).sum(axis=-1))
            weight = 1e-4 + (off < 0.02) * np.clip((normals[full] * normals).sum(axis=-1), 0, 1)
            total += weight[..., None] * light[np.ix_(at_row, at_column)]
            weights += weight
    return total / weights[..., None]
