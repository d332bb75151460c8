"""One gravity for all photos of a room: that of the floors that are seen, whichever photo sees them."""

import numpy as np
import pytest

from mmweaver.core.records import CameraIntrinsics, RgbdPhoto
from mmweaver.scene.layout.gravity import Gravity
from mmweaver.scene.multiview.registration import common_gravity
from mmweaver.scene.photo.capture_photo import PosedPhoto

UP = np.array([0.0, -1.0, 0.0])
TILTED = np.array([0.0, -np.cos(0.4), np.sin(0.4)])
PHOTO = RgbdPhoto(
    rgb=np.zeros((2, 2, 3), np.uint8), depth_m=np.ones((2, 2)),
    intrinsics=CameraIntrinsics(fx=2.0, fy=2.0, cx=0.5, cy=0.5, width=2, height=2),
)  # fmt: skip


def _gravity(up_camera: np.ndarray, floor_z_m: float, has_floor: bool) -> Gravity:
    assumed = () if has_floor else ("the height was assumed",)
    return Gravity(up_camera=up_camera, floor_z_m=floor_z_m, has_floor=has_floor, assumptions=assumed)


def _beside(x_m: float, down_m: float = 0.0) -> PosedPhoto:
    pose = np.eye(4)
    pose[:3, 3] = x_m, down_m, 0.0
    return PosedPhoto(photo=PHOTO, pose=pose)


def test_the_floor_that_another_photo_sees_is_the_first_photos_too():
    own = [_gravity(TILTED, -1.0, has_floor=False), _gravity(UP, -1.4, has_floor=True)]
    (first, second), (pose,) = common_gravity(own, [_beside(0.5)])
    for one in (first, second):
        assert one.up_camera == pytest.approx(UP)
        assert one.floor_z_m == pytest.approx(-1.4)
        assert one.has_floor
        assert one.assumptions == ()
    assert pose.position_m == pytest.approx((0.5, 0.0, 0.0))


def test_the_floor_of_a_camera_that_stands_lower_is_nearer():
    own = [_gravity(UP, -1.5, has_floor=True), _gravity(TILTED, -0.3, has_floor=False)]
    first, second = common_gravity(own, [_beside(0.0, down_m=0.4)])[0]
    assert first.floor_z_m == pytest.approx(-1.5)
    assert second.floor_z_m == pytest.approx(-1.1)


def test_without_any_floor_the_first_photos_assumption_holds():
    own = [_gravity(TILTED, -1.0, has_floor=False), _gravity(UP, -1.4, has_floor=False)]
    first, _ = common_gravity(own, [_beside(0.5)])[0]
    assert first == own[0]


def test_of_floors_that_disagree_most_photos_count():
    own = [_gravity(TILTED, -1.4, True), _gravity(UP, -1.4, True), _gravity(UP, -1.4, True)]
    first = common_gravity(own, [_beside(0.5), _beside(1.0)])[0][0]
    assert first.up_camera == pytest.approx(UP)
