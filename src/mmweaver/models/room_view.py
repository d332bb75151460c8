"""What the networks see of a room: a small picture, the surface point of every second cell, and the flat faces."""

import math
from dataclasses import dataclass, fields, replace

import numpy as np
import torch
from torch import Tensor

from mmweaver.core.records import ClassMask, Plane, Scene
from mmweaver.geometry.pinhole import unproject
from mmweaver.scene.depth_grid import DepthGrid, make_grid

IMAGE_ROWS, IMAGE_COLUMNS = 120, 160
IMAGE_CHANNELS = 5  # red, green, blue, depth, class (paper: RGB + depth + mask)
POINT_ROWS, POINT_COLUMNS = 60, 80
POINT_FEATURES = 12
NUM_PLANES, PLANE_FEATURES = 8, 13
FARTHEST_M = 8.0
NUM_CLASSES = 182.0  # of COCO-Stuff
PLANE_KINDS = ("floor", "ceiling", "wall", "top", "panel")


@dataclass(frozen=True, kw_only=True)
class RoomView:
    """Tensors of one room, or of several with a leading axis; frame of reference is the radar's."""

    image: Tensor  # (channel, row, column), 0 where nothing is known
    depth_m: Tensor  # (row, column) along the optical axis; 0 = no measurement
    point_m: Tensor  # (point, 3)
    point_normal: Tensor  # (point, 3) towards the radar; 0 = unknown
    point_area_m2: Tensor  # (point,) seen from the radar: distance^2 times solid angle; 0 = nothing measured
    point_features: Tensor  # (point, POINT_FEATURES)
    camera_from_radar: Tensor  # (3, 3)
    camera: Tensor  # (4,) fx, fy, cx, cy in cells of the picture
    plane_centre_m: Tensor  # (plane, 3)
    plane_axes: Tensor  # (plane, 3, 3): u, v, normal
    plane_half_m: Tensor  # (plane, 2); 0 = no plane
    plane_features: Tensor  # (plane, PLANE_FEATURES)

    @classmethod
    def of(cls, scene: Scene) -> "RoomView":
        """The view of a scene's photo, with the scene's faces."""
        grid = make_grid(scene.photo)
        rows = _nearest(IMAGE_ROWS, grid.depth_m.shape[0])
        columns = _nearest(IMAGE_COLUMNS, grid.depth_m.shape[1])
        camera = grid.intrinsics
        scale_x, scale_y = IMAGE_COLUMNS / camera.width, IMAGE_ROWS / camera.height
        view = np.ix_(rows, columns)
        points = _points(grid, scene, rows[1::2], columns[1::2])
        planes = _planes(scene)
        return cls(
            image=_tensor(_image(grid, scene, view)),
            depth_m=_tensor(np.nan_to_num(grid.depth_m[view])),
            **points,
            camera_from_radar=_tensor(scene.radar_from_camera.T),
            camera=_tensor(
                np.array(
                    [
                        camera.fx * scale_x, camera.fy * scale_y,
                        (camera.cx + 0.5) * scale_x - 0.5, (camera.cy + 0.5) * scale_y - 0.5,
                    ]
                )
            ),
            **planes,
        )  # fmt: skip

    @classmethod
    def stacked(cls, views: list["RoomView"]) -> "RoomView":
        """Several rooms as one batch."""
        return cls(**{f.name: torch.stack([getattr(view, f.name) for view in views]) for f in fields(cls)})

    def without(self, *parts: str) -> "RoomView":
        """The same room with some channels of its picture blank: "rgb", "depth", "mask" (ablations)."""
        image = self.image.clone()
        for part in parts:
            image[..., {"rgb": slice(0, 3), "depth": slice(3, 4), "mask": slice(4, 5)}[part], :, :] = 0.0
        return replace(self, image=image)

    def to(self, device: str | torch.device) -> "RoomView":
        return RoomView(**{f.name: getattr(self, f.name).to(device) for f in fields(self)})


def _nearest(wanted: int, given: int) -> np.ndarray:
    return np.minimum(((np.arange(wanted) + 0.5) * given / wanted).astype(int), given - 1)


def _image(grid: DepthGrid, scene: Scene, view: tuple[np.ndarray, ...]) -> np.ndarray:
    depth = np.nan_to_num(grid.depth_m[view]) / FARTHEST_M
    colour = grid.rgb[view].transpose(2, 0, 1)
    return np.concatenate([colour, depth[None], _mask(scene.photo.classes, view, grid)[None]])


def _mask(classes: ClassMask | None, view: tuple[np.ndarray, ...], grid: DepthGrid) -> np.ndarray:
    """Class of the middle pixel of every cell, as a number from 0 to 1."""
    if classes is None:
        return np.zeros((IMAGE_ROWS, IMAGE_COLUMNS))
    rows, columns = classes.index.shape
    row = ((view[0] + 0.5) * rows / grid.depth_m.shape[0]).astype(int)
    column = ((view[1] + 0.5) * columns / grid.depth_m.shape[1]).astype(int)
    return classes.index[row, column] / NUM_CLASSES


def _points(grid: DepthGrid, scene: Scene, rows: np.ndarray, columns: np.ndarray) -> dict[str, Tensor]:
    view = np.ix_(rows, columns)
    depth = grid.depth_m[view]
    point = (unproject(grid.depth_m, grid.intrinsics)[view] @ scene.radar_from_camera.T).reshape(-1, 3)
    normal = (grid.normals[view] @ scene.radar_from_camera.T).reshape(-1, 3)
    colour = grid.rgb[view].reshape(-1, 3)
    distance = np.linalg.norm(point, axis=1)
    ray = np.stack([columns[None, :] - grid.intrinsics.cx + 0 * rows[:, None],
                    rows[:, None] - grid.intrinsics.cy + 0 * columns[None, :]], -1)  # fmt: skip
    slope = ray / np.array([grid.intrinsics.fx, grid.intrinsics.fy])
    cell = (grid.intrinsics.height / POINT_ROWS) * (grid.intrinsics.width / POINT_COLUMNS)
    solid_angle = cell / (grid.intrinsics.fx * grid.intrinsics.fy) / (1 + (slope**2).sum(-1)) ** 1.5
    known = np.asarray(np.isfinite(depth.ravel()))
    has_normal = np.asarray(np.isfinite(normal).all(axis=1))
    point, normal = np.where(known[:, None], point, 0.0), np.where(has_normal[:, None], normal, 0.0)
    distance = np.where(known, distance, 0.0)
    towards = -point / np.maximum(distance, 1e-3)[:, None]
    cos = np.abs((normal * towards).sum(axis=1))
    height = np.asarray(point[:, 2])
    features = np.column_stack(
        [
            distance / 4, point / 4, (height - scene.floor_z_m) / 2, cos, (1 - cos) ** 8, cos**8,
            np.abs(normal[:, 2]), has_normal, known, colour.mean(axis=1),
        ]
    )  # fmt: skip
    return {
        "point_m": _tensor(point),
        "point_normal": _tensor(normal),
        "point_area_m2": _tensor(np.where(known, distance**2 * solid_angle.ravel(), 0.0)),
        "point_features": _tensor(features),
    }


def _planes(scene: Scene) -> dict[str, Tensor]:
    """The floor and the largest faces, the largest first; rows of zeros where there are fewer."""
    faces = sorted(scene.planes, key=lambda plane: (plane.kind != "floor", -math.prod(plane.half_size_m)))[:NUM_PLANES]
    centre, axes = np.zeros((NUM_PLANES, 3)), np.tile(np.eye(3), (NUM_PLANES, 1, 1))
    half, features = np.zeros((NUM_PLANES, 2)), np.zeros((NUM_PLANES, PLANE_FEATURES))
    for index, plane in enumerate(faces):
        centre[index], half[index] = plane.centre_m, plane.half_size_m
        axes[index] = np.stack([plane.axis_u, plane.axis_v, plane.normal])
        features[index] = _plane_features(plane)
    return {
        "plane_centre_m": _tensor(centre),
        "plane_axes": _tensor(axes),
        "plane_half_m": _tensor(half),
        "plane_features": _tensor(features),
    }


def _plane_features(plane: Plane) -> np.ndarray:
    """Which kind, how far, which way, and how far the foot of the radar's perpendicular lies inside."""
    distance = float(plane.normal @ -plane.centre_m)
    foot = -distance * plane.normal - plane.centre_m
    inside = [
        plane.half_size_m[0] - abs(float(foot @ plane.axis_u)), plane.half_size_m[1] - abs(float(foot @ plane.axis_v)),
    ]  # fmt: skip
    kind = [float(plane.kind == name) for name in PLANE_KINDS]
    return np.array([*kind, distance / 4, *plane.normal, *np.tanh(inside), *(np.array(plane.half_size_m) / 3)])


def _tensor(values: np.ndarray) -> Tensor:
    return torch.from_numpy(np.ascontiguousarray(values, dtype=np.float32))
