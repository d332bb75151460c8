"""Gravity and camera height, from rooms of boxes."""

from collections.abc import Callable

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import RgbdPhoto
from mmweaver.scene.layout.gravity import find_gravity
from mmweaver.scene.photo.depth_grid import make_grid

TABLE = ((-1.6, 1.6), (1.3, 2.3), (0.0, 0.75))


@pytest.mark.parametrize(
    ("pitch_deg", "roll_deg", "height_m", "noise"),
    [
        (15.0, 0.0, 1.4, 0.0),
        (15.0, 3.0, 1.4, 0.003),
        (30.0, -2.0, 1.9, 0.003),
        (2.0, 0.0, 0.5, 0.002),
        (45.0, 5.0, 1.6, 0.0),
    ],
)
def test_floor_and_tilt(box_room: Callable, pitch_deg: float, roll_deg: float, height_m: float, noise: float):
    room = box_room(pitch_deg=pitch_deg, roll_deg=roll_deg, camera_height_m=height_m)
    gravity = find_gravity(make_grid(room.photo(noise=noise, holes=0.1)))
    assert gravity.has_floor
    assert gravity.floor_z_m == pytest.approx(-height_m, abs=0.03)
    error = np.arccos(np.clip(gravity.up_camera @ room.radar_from_camera[2], -1, 1))
    assert np.rad2deg(error) < 1


def test_a_large_table_is_not_the_floor(box_room: Callable):
    room = box_room(boxes=[TABLE], pitch_deg=25.0)
    photo = room.photo(noise=0.002)
    assert find_gravity(make_grid(photo)).floor_z_m == pytest.approx(-1.4, abs=0.03)


def test_without_a_floor_the_assumption_is_reported(box_room: Callable):
    """A level camera far from a wall: nothing horizontal is visible."""
    room = box_room(pitch_deg=0.0, has_floor=False, ceiling_m=40.0, walls=(-1.0, 1.3, 2.5))
    photo = room.photo()
    gravity = find_gravity(make_grid(photo))
    assert not gravity.has_floor
    assert "No floor is visible" in gravity.assumptions[0]
    assert gravity.floor_z_m <= -1.2
    assert np.rad2deg(np.arccos(gravity.up_camera @ room.radar_from_camera[2])) < 3


def test_scattered_points_are_refused(box_room: Callable):
    photo = box_room().photo()
    noise = np.random.default_rng(0).uniform(0.5, 9, photo.depth_m.shape)
    with pytest.raises(InputError, match="scattered"):
        find_gravity(make_grid(RgbdPhoto(rgb=photo.rgb, depth_m=noise, intrinsics=photo.intrinsics)))
