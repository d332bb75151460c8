"""Edges of furniture: free edges of the room's mesh in front of a farther background."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import KDTree

from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import Scene
from mmweaver.core.rotations import unit

SEGMENT_M = 0.065  # about 1.1 sqrt(wavelength . distance / 2): the length of an edge that adds up in phase
NEIGHBOURHOOD_M = 0.15  # radius around a piece within which edges determine its direction
LINE_WIDTH, LINE_REACH_M = 0.1, 0.04  # edges on a line: maximum variance ratio across/along, minimum deviation along
STEP_OVER_M = 0.10  # minimum distance between an edge and the background behind it


@dataclass(frozen=True, kw_only=True)
class Edges:
    """Short straight pieces of edge, one row each."""

    place_m: np.ndarray  # (edge, 3)
    direction: np.ndarray  # (edge, 3) unit
    length_m: np.ndarray  # (edge,)
    material: np.ndarray  # (edge,) index into the scene's material_names


def find_edges(scene: Scene, caster: RayCaster, *, straight: bool = True) -> Edges:
    """Free edges of the mesh that the radar sees in front of a farther background, in pieces of SEGMENT_M.

    Args:
        scene: Room with its mesh.
        caster: Ray caster of that mesh.
        straight: Whether pieces are aligned with the edge's wider neighbourhood. The mesh of a photo ends in steps of
            its cells, whose own directions are meaningless.

    Returns:
        Pieces of edge, (edge,).
    """
    ends, opposite, face = _free_edges(scene.faces)
    vertices = scene.vertices_m.astype(float)
    middle = vertices[ends].mean(axis=1)
    outward = unit(middle - vertices[opposite])
    along = vertices[ends[:, 1]] - vertices[ends[:, 0]]
    length = np.linalg.norm(along, axis=1)
    behind = _reach(caster, middle + 0.04 * outward)
    seen = _reach(caster, middle - 0.01 * outward)
    distance = np.linalg.norm(middle, axis=1)
    step = np.isfinite(behind) & (behind > distance + STEP_OVER_M) & (np.abs(seen - distance) < 0.05)
    step &= length < 0.3  # longer ones are rims of completed planes, not furniture
    pieces = _merged_pieces(middle[step], along[step], length[step], scene.face_material[face[step]])
    return _straightened(pieces, middle[step], length[step]) if straight and len(pieces.length_m) else pieces


def _straightened(pieces: Edges, middle_m: np.ndarray, length_m: np.ndarray) -> Edges:
    """Pieces aligned with the line through all edges (edge, 3) near them, where these lie on a line."""
    near = KDTree(pieces.place_m).sparse_distance_matrix(KDTree(middle_m), NEIGHBOURHOOD_M, output_type="coo_matrix")
    piece, edge, count = near.row, near.col, len(pieces.length_m)
    weight = np.bincount(piece, length_m[edge], minlength=count)
    mean = np.stack([np.bincount(piece, length_m[edge] * middle_m[edge, i], minlength=count) for i in range(3)], 1)
    off = middle_m[edge] - (mean / np.maximum(weight, 1e-9)[:, None])[piece]
    moments = [
        [np.bincount(piece, length_m[edge] * off[:, i] * off[:, j], minlength=count) for j in range(3)]
        for i in range(3)
    ]
    values, vectors = np.linalg.eigh(np.array(moments).transpose(2, 0, 1))
    is_line = (values[:, 1] < LINE_WIDTH * values[:, 2]) & (values[:, 2] > weight * LINE_REACH_M**2)
    direction = np.where(is_line[:, None], vectors[:, :, 2], pieces.direction)
    length = np.where(is_line, SEGMENT_M / np.abs(direction).max(axis=1), pieces.length_m)
    return replace(pieces, direction=direction, length_m=np.minimum(length, SEGMENT_M))


def _free_edges(faces: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges of exactly one face: their vertices (edge, 2), the face's third vertex, and the face."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    third = np.concatenate([faces[:, 2], faces[:, 0], faces[:, 1]])
    face = np.tile(np.arange(len(faces)), 3)
    key = np.sort(ends, axis=1).astype(np.int64)
    _, first, count = np.unique(key[:, 0] << 32 | key[:, 1], return_index=True, return_counts=True)
    alone = first[count == 1]
    return ends[alone], third[alone], face[alone]


def _reach(caster: RayCaster, target_m: np.ndarray) -> np.ndarray:
    """Length of a ray from the radar towards each target until it meets the mesh."""
    direction = unit(target_m)
    return caster.distance_m(np.zeros_like(direction), direction)


def _merged_pieces(middle: np.ndarray, along: np.ndarray, length: np.ndarray, material: np.ndarray) -> Edges:
    """One piece per voxel, with mean place and main direction, no longer than the voxel."""
    if len(middle) == 0:
        return Edges(place_m=middle, direction=along, length_m=length, material=material)
    _, first, cell, count = np.unique(
        np.floor(middle / SEGMENT_M).astype(np.int64),
        axis=0,
        return_index=True,
        return_inverse=True,
        return_counts=True,
    )
    cell = cell.ravel()
    total = np.bincount(cell, length)
    place = np.stack([np.bincount(cell, middle[:, i]) for i in range(3)], 1) / count[:, None]
    spread = along[:, :, None] * along[:, None, :]
    tensor = np.zeros((len(count), 3, 3))
    np.add.at(tensor, cell, spread)
    direction = np.linalg.eigh(tensor)[1][:, :, -1]
    return Edges(
        place_m=place, direction=direction, length_m=np.minimum(total, SEGMENT_M), material=material[first].astype(int)
    )
