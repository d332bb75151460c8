"""An empty room: a floor, perhaps a wall, for recordings whose room is not known."""

import numpy as np

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto, Scene

HALF_M = 4.0


def empty_room(*, floor_z_m: float, wall_y_m: float | None = None) -> Scene:
    """A concrete floor at `floor_z_m` (below the radar, so negative) and a plasterboard wall `wall_y_m` ahead."""
    planes = [_plane("floor", (0.0, HALF_M, floor_z_m), (0, 0, 1), (1, 0, 0), "concrete")]
    if wall_y_m is not None:
        planes.append(_plane("wall", (0.0, wall_y_m, 0.0), (0, -1, 0), (1, 0, 0), "plasterboard"))
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    vertices, faces, kinds = [], [], []
    for index, plane in enumerate(planes):
        first = 4 * index
        vertices += [plane.centre_m + HALF_M * (a * plane.axis_u + b * plane.axis_v) for a, b in corners]
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        kinds += [index, index]
    everywhere = np.ones((2, 2), bool)
    return Scene(
        photo=RgbdPhoto(
            rgb=np.zeros((2, 2, 3), np.uint8),
            depth_m=np.full((2, 2), np.nan),
            intrinsics=CameraIntrinsics(fx=1.0, fy=1.0, cx=0.5, cy=0.5, width=2, height=2),
        ),
        radar_from_camera=np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
        vertices_m=np.array(vertices, np.float32),
        faces=np.array(faces, np.int32),
        face_material=np.array(kinds, np.int32),
        material_names=tuple(plane.material for plane in planes),
        planes=tuple(planes),
        floor_z_m=floor_z_m,
        free_space=FreeSpace(
            x_m=np.array([-1.0, 1.0]), y_m=np.array([1.0, 3.0]), is_free=everywhere, is_seen=everywhere
        ),
        seats=(),
        assumptions=("the room is a floor and nothing else",)
        if wall_y_m is None
        else ("the room is a floor and a wall",),
    )


def _plane(kind: str, centre: tuple, normal: tuple, u: tuple, material: str) -> Plane:
    n, axis = np.asarray(normal, float), np.asarray(u, float)
    return Plane(
        kind=kind, centre_m=np.asarray(centre, float), normal=n, axis_u=axis, axis_v=np.cross(n, axis),
        half_size_m=(HALF_M, HALF_M), material=material,
    )  # fmt: skip
