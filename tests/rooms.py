"""Rooms and people made in the test: exact geometry, no photo needed."""

import numpy as np

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, PoseSequence, RgbdPhoto, Scene, Seat
from mmweaver.core.skeleton import JOINT_NAMES

# A person of 1.75 m who stands at the origin and looks along -y; x to the radar's right, so the left side is at +x.
STANDING_M = {
    "pelvis": (0, 0, 0.95), "left_hip": (0.09, 0, 0.88), "right_hip": (-0.09, 0, 0.88), "spine1": (0, 0.02, 1.07),
    "left_knee": (0.10, 0, 0.49), "right_knee": (-0.10, 0, 0.49), "spine2": (0, 0.02, 1.20),
    "left_ankle": (0.10, 0.02, 0.09), "right_ankle": (-0.10, 0.02, 0.09), "spine3": (0, 0.02, 1.26),
    "left_foot": (0.12, -0.11, 0.03), "right_foot": (-0.12, -0.11, 0.03), "neck": (0, 0.02, 1.46),
    "left_collar": (0.07, 0.02, 1.39), "right_collar": (-0.07, 0.02, 1.39), "head": (0, -0.01, 1.58),
    "left_shoulder": (0.18, 0.02, 1.41), "right_shoulder": (-0.18, 0.02, 1.41), "left_elbow": (0.22, 0.02, 1.15),
    "right_elbow": (-0.22, 0.02, 1.15), "left_wrist": (0.24, -0.03, 0.91), "right_wrist": (-0.24, -0.03, 0.91),
}  # fmt: skip


def standing_person(
    at_m: tuple[float, float, float], velocity_mps: tuple[float, float, float] = (0.0, 0.0, 0.0), seconds: float = 2.1
) -> PoseSequence:
    """A stiff person whose feet start at `at_m` and who glides along."""
    time_s = np.arange(0, seconds, 1 / 120)
    rest = np.array([STANDING_M[name] for name in JOINT_NAMES], float)
    track = np.asarray(at_m) + time_s[:, None] * np.asarray(velocity_mps)
    return PoseSequence(time_s=time_s, joints_m=rest[None] + track[:, None], height_m=1.75)


def plane(kind: str, centre: tuple, normal: tuple, u: tuple, half: tuple[float, float], material: str) -> Plane:
    n, axis = np.asarray(normal, float), np.asarray(u, float)
    return Plane(
        kind=kind, centre_m=np.asarray(centre, float), normal=n, axis_u=axis, axis_v=np.cross(n, axis),
        half_size_m=half, material=material,
    )  # fmt: skip


def floor(z_m: float = -1.2, material: str = "concrete") -> Plane:
    return plane("floor", (0.0, 3.0, z_m), (0, 0, 1), (1, 0, 0), (3.0, 3.0), material)


def back_wall(y_m: float = 3.2, material: str = "plasterboard") -> Plane:
    return plane("wall", (0.0, y_m, 0.0), (0, -1, 0), (1, 0, 0), (3.0, 1.3), material)


def side_wall(x_m: float = 0.95, material: str = "plasterboard") -> Plane:
    return plane("wall", (x_m, 2.0, 0.0), (-1, 0, 0), (0, 1, 0), (2.0, 1.3), material)


def scene_of(planes: tuple[Plane, ...], seats: tuple[Seat, ...] = (), floor_z_m: float = -1.2) -> Scene:
    """A scene whose mesh is the rectangles themselves."""
    vertices, faces, kinds = [], [], []
    names = tuple(dict.fromkeys(p.material for p in planes)) or ("concrete",)
    for p in planes:
        u, v = p.axis_u * p.half_size_m[0], p.axis_v * p.half_size_m[1]
        first = len(vertices)
        vertices += [p.centre_m + a * u + b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        kinds += [names.index(p.material)] * 2
    grid_x, grid_y = np.arange(-3, 3.01, 0.05), np.arange(0, 5.01, 0.05)
    free = np.ones((len(grid_y), len(grid_x)), bool)
    free[grid_y < 0.5] = False
    photo = RgbdPhoto(
        rgb=np.zeros((48, 64, 3), np.uint8),
        depth_m=np.full((48, 64), 3.0),
        intrinsics=CameraIntrinsics(fx=34.0, fy=34.0, cx=31.5, cy=23.5, width=64, height=48),
    )
    return Scene(
        photo=photo,
        radar_from_camera=np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
        vertices_m=np.array(vertices, np.float32).reshape(-1, 3),
        faces=np.array(faces, np.int32).reshape(-1, 3),
        face_material=np.array(kinds, np.int32),
        material_names=names,
        planes=planes,
        floor_z_m=floor_z_m,
        free_space=FreeSpace(x_m=grid_x, y_m=grid_y, is_free=free, is_seen=free),
        seats=seats,
        assumptions=(),
    )
