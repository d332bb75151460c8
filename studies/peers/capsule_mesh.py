"""A smooth triangle mesh of the capsule body, for ray tracers of others."""

from dataclasses import dataclass

import numpy as np

from mmweaver.propagation.body_model import ScatteringBody

AROUND = 20  # vertices on a circle
CAP_STEPS, SIDE_STEPS = 5, 3


@dataclass(frozen=True)
class BodyMesh:
    """Vertices (time, vertex, 3) in metres and faces (face, 3)."""

    vertices_m: np.ndarray
    faces: np.ndarray


def capsule_mesh(body: ScatteringBody, joints_m: np.ndarray) -> BodyMesh:
    """All capsules with round ends for joints (time, 22, 3)."""
    posed = body.posed(joints_m)
    along, ring, over = _profile()  # (circle,): place on the axis, and radius and height over the end, in radii
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    radius_m = body.radii_m[:, :1] + (body.radii_m[:, 1:] - body.radii_m[:, :1]) * along
    wide = radius_m[..., None] * ring[:, None] * np.cos(angle) * body.widths[:, None, None]
    deep = radius_m[..., None] * ring[:, None] * np.sin(angle)
    offset = np.stack([wide, deep, np.broadcast_to((radius_m * over)[..., None], wide.shape)], -1)
    axis = posed.start_m[:, :, None] + posed.axis_m[:, :, None] * along[None, None, :, None]
    vertices = axis[:, :, :, None] + np.einsum("tkij,kcaj->tkcai", posed.rotation, offset)
    times, capsules = vertices.shape[:2]
    faces = np.concatenate([_faces(len(along)) + index * len(along) * AROUND for index in range(capsules)])
    return BodyMesh(vertices.reshape(times, -1, 3).astype(np.float32), faces.astype(np.uint32))


def _profile() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    below = np.linspace(-np.pi / 2, 0, CAP_STEPS)
    side = np.linspace(0, 1, SIDE_STEPS + 2)[1:-1]
    along = np.concatenate([np.zeros(CAP_STEPS), side, np.ones(CAP_STEPS)])
    tilt = np.concatenate([below, np.zeros(SIDE_STEPS), -below[::-1]])
    return along, np.cos(tilt), np.sin(tilt)


def _faces(circles: int) -> np.ndarray:
    """Triangles between neighbouring circles of vertices."""
    circle, step = (index.ravel() for index in np.meshgrid(np.arange(circles - 1), np.arange(AROUND), indexing="ij"))
    here, beside = circle * AROUND + step, circle * AROUND + (step + 1) % AROUND
    return np.stack(
        [np.stack([here, beside, beside + AROUND], -1), np.stack([here, beside + AROUND, here + AROUND], -1)], 1
    ).reshape(-1, 3)
