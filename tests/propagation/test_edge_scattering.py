"""Edges of a photo's mesh: a rim that crosses the picture's cells obliquely runs as the rim does, not as the cells."""

from dataclasses import replace

import numpy as np

from mmweaver.core.ray_caster import RayCaster
from mmweaver.propagation.edge_scattering import find_edges
from mmweaver.scene.photo_files import sample_photo
from mmweaver.scene.reconstruction import reconstruct

CELL_M = 0.035
SLOPE = np.tan(np.deg2rad(12.0))  # of the rim to the rows of cells


def test_a_stepped_rim_is_straight():
    """Cells of a panel 2 m ahead below an oblique rim, before a wall at 4 m."""
    scene = reconstruct(sample_photo()[0])
    x, z = (part.ravel() for part in np.meshgrid(np.arange(-20, 20), np.arange(-20, 20)))
    below = CELL_M * (z + 1) < SLOPE * CELL_M * (x + 0.5)
    corners = [(x + i, z + j) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    key = np.stack([(u + 100) * 1000 + v + 100 for u, v in corners], axis=1)[below]
    used, quads = np.unique(key, return_inverse=True)
    quads = quads.reshape(-1, 4)
    vertices = np.stack([CELL_M * (used // 1000 - 100), np.full(len(used), 2.0), CELL_M * (used % 1000 - 100)], axis=1)
    wall = np.array([[-9.0, 4, -9], [9, 4, -9], [9, 4, 9], [-9, 4, 9]])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], np.array([[0, 1, 2], [0, 2, 3]]) + len(used)])
    scene = replace(scene, vertices_m=np.concatenate([vertices, wall]), faces=faces,
                    face_material=np.zeros(len(faces), int))  # fmt: skip
    caster = RayCaster(scene.vertices_m, scene.faces)
    rim = np.array([np.cos(np.arctan(SLOPE)), 0.0, np.sin(np.arctan(SLOPE))])

    def off_deg(*, straight: bool) -> np.ndarray:
        edges = find_edges(scene, caster, straight=straight)
        at_rim = (np.abs(edges.place_m[:, 0]) < 0.4) & (np.abs(edges.place_m[:, 2]) < 0.2)
        assert at_rim.sum() > 8
        return np.degrees(np.arccos(np.clip(np.abs(edges.direction[at_rim] @ rim), 0, 1)))

    assert np.median(off_deg(straight=True)) < 4.0 < 8.0 < np.median(off_deg(straight=False))
