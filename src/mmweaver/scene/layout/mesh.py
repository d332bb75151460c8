"""Triangle mesh of a room for ray casting: the depth grid where it is continuous, and the whole floor."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float, Int

from mmweaver.core.records import Plane
from mmweaver.core.shapes import Array, Faces, PerFace, Vertices
from mmweaver.scene.layout.height_map import bounding_slices, dilated, label_components
from mmweaver.scene.layout.surfaces import MATERIAL_NAMES, AlignedGrid, Surface
from mmweaver.scene.photo.depth_grid import GridBool, GridInt, GridVectors, depth_tolerance_m

_MAX_HOLE = 0.04  # share of the grid: larger holes stay open
_MIN_BORDER = 0.5  # share of a hole's border on one surface
SET_BACK_M = 0.03  # of the extended walls, so that the measured surface lies before them
_GRAZING = np.sin(np.deg2rad(4))


def make_mesh(
    grid: AlignedGrid, rays: GridVectors, surfaces: Sequence[Surface], is_floor: GridBool, cell_material: GridInt
) -> tuple[Vertices, Faces, PerFace]:
    """Triangulates the depth grid where it is continuous.

    Cells of a planar surface are projected onto it along their rays, and small holes within one are filled. Of the
    floor only the cells at the foot of objects remain: `rectangle_faces` makes the floor itself as one rectangle.

    Args:
        grid: Depth grid in the radar's frame.
        rays: Viewing direction of each cell in the radar's frame, (row, column, 3).
        surfaces: Planar surfaces of the grid.
        is_floor: Cells of the floor, (row, column).
        cell_material: Index into MATERIAL_NAMES of each cell, (row, column).

    Returns:
        Vertices in metres; faces, counter-clockwise seen from the radar; material index per face.
    """
    points, surface_of = _projected_onto_surfaces(grid, rays, surfaces, is_floor)
    points, surface_of, material = _fill_holes(points, rays, surfaces, surface_of, cell_material)
    faces = _continuous_faces(points, grid, surface_of)
    faces = faces[~(is_floor.ravel()[faces]).all(axis=1)]
    # A face at the edge of the floor takes the material of what is not floor.
    corner_is_floor = is_floor.ravel()[faces]
    corner = np.argmin(corner_is_floor, axis=1)
    face_material = material.ravel()[np.take_along_axis(faces, corner[:, None], axis=1)[:, 0]]
    used, compact = np.unique(faces, return_inverse=True)
    return points.reshape(-1, 3)[used], compact.reshape(-1, 3), face_material


def rectangle_faces(planes: Sequence[Plane]) -> tuple[Vertices, Faces, PerFace]:
    """Triangulates rectangles, two triangles each; all but the floor lie 3 cm behind their measured surfaces.

    Args:
        planes: Rectangles in the radar's frame.

    Returns:
        Vertices in metres, (vertex, 3); faces, (face, 3); index into MATERIAL_NAMES per face.
    """
    set_back = [(plane, 0.0 if plane.kind == "floor" else SET_BACK_M) for plane in planes]
    corners = [replace(plane, centre_m=plane.centre_m - by_m * plane.normal).corners_m for plane, by_m in set_back]
    faces = 4 * np.arange(len(planes))[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    material = np.repeat([MATERIAL_NAMES.index(plane.material) for plane in planes], 2)
    return np.concatenate(corners), faces.reshape(-1, 3), material


def joined_meshes(meshes: Sequence[tuple[np.ndarray, ...]]) -> tuple[Vertices, Faces, PerFace]:
    """Concatenates meshes; overlapping triangles are harmless, since a ray ends at the first hit.

    Args:
        meshes: Vertices in metres, faces and material index per face of each mesh.

    Returns:
        Vertices, faces and material indices of all meshes.
    """
    starts = np.cumsum([0, *(len(vertices_m) for vertices_m, *_ in meshes)])
    faces = [mesh[1] + start for mesh, start in zip(meshes, starts, strict=False)]
    return np.concatenate([mesh[0] for mesh in meshes]), np.concatenate(faces), np.concatenate([m[2] for m in meshes])


def _projected_onto_surfaces(
    grid: AlignedGrid, rays: GridVectors, surfaces: Sequence[Surface], is_floor: GridBool
) -> tuple[GridVectors, GridInt]:
    """Points projected onto their surfaces, and the index of each cell's surface (-1 none, -2 floor)."""
    points = grid.points_m.copy()
    surface_of = np.where(is_floor, -2, -1)
    points[is_floor] = _intersections(rays[is_floor], np.array([0.0, 0.0, 1.0]), grid.floor_z_m)
    for index, surface in enumerate(surfaces):
        normal = surface.plane.normal
        points[surface.cells] = _intersections(rays[surface.cells], normal, float(normal @ surface.plane.centre_m))
        surface_of[surface.cells] = index
    return points, surface_of


def _intersections(rays: Float[Array, "cell 3"], normal: Float[Array, "3"], offset: float) -> Float[Array, "cell 3"]:
    """Intersections of rays from the origin with the plane n . p = offset, metres."""
    return rays * (offset / (rays @ normal))[:, None]


def _fill_holes(
    points: GridVectors,
    rays: GridVectors,
    surfaces: Sequence[Surface],
    surface_of: GridInt,
    cell_material: GridInt,
) -> tuple[GridVectors, GridInt, GridInt]:
    """Closes small holes whose border lies on one planar surface."""
    points, surface_of, material = points.copy(), surface_of.copy(), cell_material.copy()
    labels, _ = label_components(~np.isfinite(points[..., 2]))
    for label, region in enumerate(bounding_slices(labels), start=1):
        rows, columns = (slice(max(part.start - 1, 0), part.stop + 1) for part in region)
        around = (rows, columns)
        hole = labels[around] == label
        if hole.sum() > _MAX_HOLE * points[..., 0].size:
            continue
        border = surface_of[around][dilated(hole) & ~hole]
        on_surfaces = border[border >= 0]
        if len(on_surfaces) == 0:
            continue
        index = int(np.bincount(on_surfaces).argmax())
        if (border == index).sum() < _MIN_BORDER * len(border):
            continue
        plane = surfaces[index].plane
        points[around][hole] = _intersections(rays[around][hole], plane.normal, float(plane.normal @ plane.centre_m))
        surface_of[around][hole] = index
        material[around][hole] = np.bincount(material[surfaces[index].cells]).argmax()
    return points, surface_of, material


def _continuous_faces(points: GridVectors, grid: AlignedGrid, surface_of: GridInt) -> Faces:
    """Two triangles per square of four cells, without those that bridge a depth discontinuity or are seen edge-on."""
    rows, columns = surface_of.shape
    index = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    joined = np.ones(len(faces), bool)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        joined &= _joined(points, grid, surface_of, faces[:, a], faces[:, b])
    faces = faces[joined]
    corners = points.reshape(-1, 3)[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    towards = -(normal * corners.mean(axis=1)).sum(axis=1)
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(corners.mean(axis=1), axis=1)
    return faces[towards > _GRAZING * np.maximum(size, 1e-12)]


def _joined(
    points: GridVectors, grid: AlignedGrid, surface_of: GridInt, a: Int[Array, " edge"], b: Int[Array, " edge"]
) -> Bool[Array, " edge"]:
    """Whether two neighbouring cells are on one surface: near, on one plane, or each in the other's tangent plane."""
    flat, normals, surface = points.reshape(-1, 3), grid.normals.reshape(-1, 3), surface_of.ravel()
    between = flat[b] - flat[a]
    distance = np.minimum(np.linalg.norm(flat[a], axis=1), np.linalg.norm(flat[b], axis=1))
    noise = depth_tolerance_m(distance)
    is_small = np.linalg.norm(between, axis=1) < 0.02 + 0.015 * distance + noise
    off_a = np.abs((between * normals[a]).sum(axis=1))
    off_b = np.abs((between * normals[b]).sum(axis=1))
    is_tangent = (off_a < noise) & (off_b < noise) & (np.linalg.norm(between, axis=1) < 0.15 * distance)
    same_plane = (surface[a] == surface[b]) & (surface[a] != -1)
    return (same_plane | is_small | is_tangent) & np.isfinite(between[:, 0])
