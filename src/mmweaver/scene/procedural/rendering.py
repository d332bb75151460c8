"""Renders the photo of a procedural room by ray casting: colour under a lighting, depth and class of each pixel."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import CameraIntrinsics, ClassMask
from mmweaver.core.seeding import stream
from mmweaver.core.shapes import Array, DepthPixels, RgbPixels, Rotation, Vec3
from mmweaver.scene.procedural.lighting import LIGHTINGS, Lighting, area_lights, denoised, irradiance
from mmweaver.scene.procedural.meshing import Mesh
from mmweaver.scene.procedural.parts import PlacedPiece
from mmweaver.scene.procedural.textures import albedo

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
