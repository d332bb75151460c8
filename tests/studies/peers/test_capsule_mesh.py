"""The capsule mesh: closed, around the joints, as large as the body."""

import numpy as np

from mmweaver.propagation.body_model import ScatteringBody
from studies.peers.capsule_mesh import capsule_mesh
from tests.rooms import standing_person


def test_the_mesh_is_closed_about_the_body():
    pose = standing_person((0.0, 2.0, -1.2), (0.0, -1.0, 0.0))
    mesh = capsule_mesh(ScatteringBody(0, pose.height_m), pose.joints_m[:2])
    assert mesh.vertices_m.shape[0] == 2
    edges = np.sort(np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]]), axis=1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert (count == 2).mean() > 0.9  # open at the poles of the caps alone, where triangles are points
    low, high = mesh.vertices_m[0].min(axis=0), mesh.vertices_m[0].max(axis=0)
    assert 1.6 < high[2] - low[2] < 1.9
    assert 0.4 < high[0] - low[0] < 0.75
    moved = mesh.vertices_m[1] - mesh.vertices_m[0]
    np.testing.assert_allclose(
        moved, np.broadcast_to(pose.joints_m[1, 0] - pose.joints_m[0, 0], moved.shape), atol=1e-4
    )
