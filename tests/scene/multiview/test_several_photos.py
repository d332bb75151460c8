"""Two photos of a box-shaped room, from either end: together they show all walls, the ceiling and all floor."""

import numpy as np
import pytest

from mmweaver.core.pinhole import viewing_rays
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.scene.photo.capture_photo import PosedPhoto
from mmweaver.scene.reconstruction import reconstruct

LEFT, RIGHT, BACK, FRONT, HEIGHT = -1.8, 2.4, -0.6, 4.4, 2.5
EYE_M = 1.2  # of the first camera, above the floor
CAMERA = CameraIntrinsics(fx=220.0, fy=220.0, cx=159.5, cy=119.5, width=320, height=240)
SECOND = RadarPose(x_m=1.2, y_m=3.9, z_m=0.3, yaw_deg=195.0, pitch_deg=-12.0)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([[(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]] for i in (0, 1) for j in (0, 1)
                        for k in (0, 1)], float)  # fmt: skip
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def room() -> RayCaster:
    """The room with a table in its middle, in the level frame of the first camera."""
    parts = [box((LEFT, BACK, -EYE_M), (RIGHT, FRONT, HEIGHT - EYE_M)), box((-0.6, 1.6, -EYE_M), (0.5, 2.4, -0.5))]
    return RayCaster(np.concatenate([part[0] for part in parts]), np.concatenate([parts[0][1], parts[1][1] + 8]))


def axes(stand: RadarPose) -> np.ndarray:
    """From a camera (x right, y down, z forward) to the first's level frame."""
    right, ahead, up = stand.from_level
    return np.stack([right, -up, ahead], axis=1)


def photo(stand: RadarPose) -> RgbdPhoto:
    rays = viewing_rays(CAMERA).reshape(-1, 3) @ axes(stand).T
    length = np.linalg.norm(rays, axis=1)
    distance_m = room().distance_m(np.broadcast_to(stand.position_m, rays.shape), rays / length[:, None])
    depth_m = (distance_m / length).reshape(CAMERA.height, CAMERA.width)
    return RgbdPhoto(rgb=np.full((*depth_m.shape, 3), 150, np.uint8), depth_m=depth_m, intrinsics=CAMERA)


FIRST = RadarPose(pitch_deg=-6.0)


def pose_of(stand: RadarPose, *, wrong_deg: float = 0.0) -> np.ndarray:
    """(4, 4) from a camera into the first, turned wrongly about the vertical."""
    wrong = RadarPose(x_m=stand.x_m, y_m=stand.y_m, z_m=stand.z_m, yaw_deg=stand.yaw_deg + wrong_deg,
                      pitch_deg=stand.pitch_deg)  # fmt: skip
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = axes(FIRST).T @ axes(wrong), axes(FIRST).T @ stand.position_m
    return pose


@pytest.mark.parametrize(
    ("pose", "off_m"),
    [(pose_of(SECOND, wrong_deg=2.0), 0.03), (RadarPose(x_m=1.2, y_m=3.9, yaw_deg=188.0), 0.07)],
    ids=["tracked", "rough"],
)
def test_walls_behind_the_radar_are_those_of_the_room(pose: np.ndarray | RadarPose, off_m: float):
    scene = reconstruct(photo(FIRST), [PosedPhoto(photo=photo(SECOND), pose=pose)])
    walls = {tuple(np.rint(plane.normal).astype(int)): plane for plane in scene.planes if plane.kind == "wall"}
    for normal, distance_m in {(1, 0, 0): -LEFT, (-1, 0, 0): RIGHT, (0, 1, 0): -BACK, (0, -1, 0): FRONT}.items():
        wall = walls[normal]
        assert -wall.centre_m @ wall.normal == pytest.approx(distance_m, abs=off_m)
        assert wall.normal @ np.array(normal) > np.cos(np.deg2rad(0.7))
    ceiling = next(plane for plane in scene.planes if plane.kind == "ceiling")
    assert ceiling.centre_m[2] == pytest.approx(HEIGHT - EYE_M, abs=0.03)
    assert 4 * np.prod(ceiling.half_size_m) == pytest.approx((RIGHT - LEFT) * (FRONT - BACK), rel=0.03)
    assert scene.floor_z_m == pytest.approx(-EYE_M, abs=0.02)


def test_floor_that_the_first_photo_cannot_see_is_free():
    alone = reconstruct(photo(FIRST)).free_space
    free = reconstruct(photo(FIRST), [PosedPhoto(photo=photo(SECOND), pose=pose_of(SECOND))]).free_space
    x_m, y_m = alone.x_m[None], alone.y_m[:, None]
    aside = (np.abs(x_m + 1.3) < 0.2) & (np.abs(y_m - 0.4) < 0.2)  # outside the first picture
    on_table = (np.abs(x_m - 0.1) < 0.25) & (np.abs(y_m - 2.0) < 0.2)
    assert not alone.is_free[aside].any()
    assert free.is_free[aside].all()
    assert not free.is_free[on_table | (np.hypot(x_m, y_m) < 0.5)].any()
