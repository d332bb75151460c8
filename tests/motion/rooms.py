"""Scenes made for tests: an empty floor, one with boxes, one with a seat."""

import numpy as np

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto, Scene, Seat

FLOOR_Z_M = -1.1
WINDOW_M = (0.7, 3.48)
CELL_M = 0.05
# Camera x right, y down, z forward -> radar x right, y away, z up; level.
LEVEL = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def room(
    boxes: tuple[tuple[float, float, float, float], ...] = (),
    seats: tuple[Seat, ...] = (),
    *,
    width_m: float = 5.0,
    depth_m: float = 5.0,
    floor_z_m: float = FLOOR_Z_M,
) -> Scene:
    """A floor in front of the radar; boxes (x low, x high, y low, y high) stand on it."""
    x = np.arange(-width_m / 2, width_m / 2 + 1e-9, CELL_M)
    y = np.arange(0.0, depth_m + 1e-9, CELL_M)
    free = np.ones((len(y), len(x)), dtype=bool)
    for low_x, high_x, low_y, high_y in boxes:
        free[np.ix_((y >= low_y) & (y <= high_y), (x >= low_x) & (x <= high_x))] = False
    photo = RgbdPhoto(
        rgb=np.zeros((48, 64, 3), np.uint8),
        depth_m=np.full((48, 64), 3.0),
        intrinsics=CameraIntrinsics(fx=40.0, fy=40.0, cx=31.5, cy=23.5, width=64, height=48),
    )
    floor = Plane(
        kind="floor", centre_m=np.array([0.0, depth_m / 2, floor_z_m]), normal=np.array([0.0, 0.0, 1.0]),
        axis_u=np.array([1.0, 0.0, 0.0]), axis_v=np.array([0.0, 1.0, 0.0]), half_size_m=(width_m / 2, depth_m / 2),
        material="concrete",
    )  # fmt: skip
    return Scene(
        photo=photo, radar_from_camera=LEVEL, vertices_m=np.zeros((3, 3)), faces=np.array([[0, 1, 2]]),
        face_material=np.array([0]), material_names=("concrete",), planes=(floor,), floor_z_m=floor_z_m,
        free_space=FreeSpace(x_m=x, y_m=y, is_free=free, is_seen=np.ones_like(free)), seats=seats, assumptions=(),
    )  # fmt: skip


def seat(x_m: float = 0.0, y_m: float = 2.6, facing_deg: float = -90.0, height_m: float = 0.45) -> Seat:
    return Seat(
        position_m=np.array([x_m, y_m, FLOOR_Z_M + height_m]),
        facing_rad=float(np.radians(facing_deg)),
        size_m=(0.6, 0.5),
    )


def sofa_room() -> Scene:
    """A sofa against the far side, facing the radar; it is an obstacle of its own."""
    return room(boxes=((-0.9, 0.9, 2.3, 3.2),), seats=(seat(),))


def furnished() -> Scene:
    return room(boxes=((-1.6, -0.7, 1.2, 1.8), (0.8, 1.8, 1.5, 2.2), (-0.4, 0.3, 2.7, 3.3)))
