"""A room of boxes with known geometry, and its photo."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import pytest

from mmweaver.core.pinhole import unproject
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto

Box = tuple[tuple[float, float], tuple[float, float], tuple[float, float]]


@dataclass
class BoxRoom:
    """x right, y away, z up; the floor at z = 0, the camera over the origin. Seen from inside its walls."""

    boxes: list[Box] = field(default_factory=list)
    camera_height_m: float = 1.4
    pitch_deg: float = 15.0
    roll_deg: float = 0.0
    walls: tuple[float, float, float] = (-2.0, 2.2, 3.8)  # left, right, back
    ceiling_m: float = 2.6
    has_floor: bool = True

    @property
    def radar_from_camera(self) -> np.ndarray:
        pitch, roll = np.deg2rad([self.pitch_deg, self.roll_deg])
        level = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
        tilt = np.array([[1, 0, 0], [0, np.cos(pitch), np.sin(pitch)], [0, -np.sin(pitch), np.cos(pitch)]])
        turn = np.array([[np.cos(roll), -np.sin(roll), 0], [np.sin(roll), np.cos(roll), 0], [0, 0, 1.0]])
        return level @ tilt @ turn

    def photo(self, *, noise: float = 0.0, holes: float = 0.0, width: int = 320, height: int = 240) -> RgbdPhoto:
        focal = 0.75 * width
        camera = CameraIntrinsics(
            fx=focal, fy=focal, cx=(width - 1) / 2, cy=(height - 1) / 2, width=width, height=height
        )  # fmt: skip
        rays = unproject(np.ones((height, width)), camera).reshape(-1, 3) @ self.radar_from_camera.T
        length = np.linalg.norm(rays, axis=1)
        origin = np.tile([0.0, 0.0, self.camera_height_m], (len(rays), 1))
        depth = (self._caster().distance_m(origin, rays / length[:, None]) / length).reshape(height, width)
        generator = np.random.default_rng(0)
        depth += noise * np.square(depth) * generator.normal(size=depth.shape)
        if noise:
            depth = 1 / (np.round(1 / depth / 0.001) * 0.001)  # steps that grow with depth squared, as Kinect's
        depth[generator.random(depth.shape) < holes] = np.nan
        depth[depth > 30] = np.nan
        return RgbdPhoto(rgb=np.full((height, width, 3), 128, np.uint8), depth_m=depth, intrinsics=camera)

    def _caster(self) -> RayCaster:
        left, right, back = self.walls
        floor = 0.0 if self.has_floor else -50.0
        boxes = [((left, right), (-3.0, back), (floor, self.ceiling_m)), *self.boxes]
        quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
        faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        vertices = [[[a, b, c] for a in box[0] for b in box[1] for c in box[2]] for box in boxes]
        return RayCaster(
            np.array(vertices, float).reshape(-1, 3), np.concatenate([faces + 8 * index for index in range(len(boxes))])
        )


@pytest.fixture(scope="session")
def box_room() -> Callable[..., BoxRoom]:
    return BoxRoom
