"""Random open rooms: a floor, perhaps a wall, and upright panels of metal or wood."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.records import CameraIntrinsics, FreeSpace, Plane, RgbdPhoto, Scene

HALF_M, TALL_M = 5.0, 2.4
CELL_M = 0.1


@dataclass(frozen=True, kw_only=True)
class Panel:
    """A flat upright object that roughly faces the radar."""

    centre_m: tuple[float, float, float]
    half_size_m: tuple[float, float]
    turn_rad: float  # about the vertical; 0 = square to the radar's axis
    material: str


def open_room(*, floor_z_m: float, wall_y_m: float | None, panels: tuple[Panel, ...] = ()) -> Scene:
    """A concrete floor `floor_z_m` below the radar (negative), perhaps a wall ahead, and panels; all floor is free.

    Panels reflect and occlude, but motion planning ignores them: place them where nobody walks.
    """
    planes = [_plane("floor", (0.0, HALF_M, floor_z_m), (0, 0, 1), (1, 0, 0), "concrete", (HALF_M, HALF_M))]
    if wall_y_m is not None:
        middle = (0.0, wall_y_m, floor_z_m + TALL_M / 2)
        planes.append(_plane("wall", middle, (0, -1, 0), (1, 0, 0), "plasterboard", (HALF_M, TALL_M / 2)))
    flat = [*planes, *(_panel(panel) for panel in panels)]
    vertices, faces, kinds = [], [], []
    for index, plane in enumerate(flat):
        first = 4 * index
        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            across, along = a * plane.half_size_m[0], b * plane.half_size_m[1]
            vertices.append(plane.centre_m + across * plane.axis_u + along * plane.axis_v)
        faces += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
        kinds += [index, index]
    x_m, y_m = np.arange(-HALF_M, HALF_M, CELL_M), np.arange(0.0, 2 * HALF_M, CELL_M)
    free = np.ones((len(y_m), len(x_m)), bool)
    if wall_y_m is not None:
        free &= y_m[:, None] < wall_y_m
    return Scene(
        photo=_no_photo(),
        radar_from_camera=np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]]),
        vertices_m=np.array(vertices, np.float32),
        faces=np.array(faces, np.int32),
        face_material=np.array(kinds, np.int32),
        material_names=tuple(plane.material for plane in flat),
        planes=tuple(planes),
        floor_z_m=float(floor_z_m),
        free_space=FreeSpace(x_m=x_m, y_m=y_m, is_free=free, is_seen=free),
        seats=(),
        assumptions=("the room is sampled at random",),
    )


def _no_photo() -> RgbdPhoto:
    """A camera that sees everything ahead, for motion planning asks what is in the picture."""
    return RgbdPhoto(
        rgb=np.zeros((2, 2, 3), np.uint8),
        depth_m=np.full((2, 2), np.nan),
        intrinsics=CameraIntrinsics(fx=0.05, fy=0.05, cx=1.0, cy=1.0, width=2, height=2),
    )


def _panel(panel: Panel) -> Plane:
    across = (np.cos(panel.turn_rad), np.sin(panel.turn_rad), 0.0)
    normal = (np.sin(panel.turn_rad), -np.cos(panel.turn_rad), 0.0)
    return _plane("panel", panel.centre_m, normal, across, panel.material, panel.half_size_m)


def _plane(kind: str, centre: tuple, normal: tuple, u: tuple, material: str, half: tuple[float, float]) -> Plane:
    n, axis = np.asarray(normal, float), np.asarray(u, float)
    return Plane(
        kind=kind, centre_m=np.asarray(centre, float), normal=n, axis_u=axis, axis_v=np.cross(n, axis),
        half_size_m=half, material=material,
    )  # fmt: skip
