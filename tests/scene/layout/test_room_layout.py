"""Walls extended beyond the picture, in rooms with known geometry."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.pinhole import unproject
from mmweaver.core.ray_caster import RayCaster
from mmweaver.core.records import ClassMask, Plane, Scene
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.layout.room_layout import BEHIND_M
from mmweaver.scene.reconstruction import reconstruct


def _walls(scene: Scene) -> dict[str, Plane]:
    names = {(0, -1): "front", (1, 0): "left", (-1, 0): "right"}
    found = [plane for plane in scene.planes if plane.kind == "wall"]
    return {names[(round(float(p.normal[0])), round(float(p.normal[1])))]: p for p in found}


def _along(wall: Plane) -> tuple[float, float]:
    """Ends of a wall along its length, in x for the front and y for the sides."""
    axis = 0 if abs(wall.normal[1]) > 0.5 else 1
    reach = wall.half_size_m[0] * abs(wall.axis_u[axis])
    return float(wall.centre_m[axis] - reach), float(wall.centre_m[axis] + reach)


def test_walls_meet_and_pass_the_radar(box_room: Callable):
    walls = _walls(reconstruct(box_room(pitch_deg=10.0).photo(noise=0.002)))
    assert _along(walls["front"]) == pytest.approx((-2.0, 2.2), abs=0.06)
    for name in ("left", "right"):
        assert _along(walls[name]) == pytest.approx((-BEHIND_M, 3.8), abs=0.06)
        assert walls[name].half_size_m[1] > 1.2


def test_rays_beyond_the_picture_meet_the_walls(box_room: Callable):
    scene = reconstruct(box_room(pitch_deg=10.0).photo(noise=0.002))
    angle = np.deg2rad([-60.0, 60.0])  # the camera sees 34 degrees to either side
    ways = np.stack([np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    distance = RayCaster(scene.vertices_m, scene.faces).distance_m(np.zeros((2, 3)), ways)
    assert distance == pytest.approx(np.array([2.0, 2.2]) / np.sin(np.deg2rad(60)), abs=0.08)


def test_a_wall_that_is_not_visible_is_not_invented(box_room: Callable):
    walls = _walls(reconstruct(box_room(pitch_deg=10.0, walls=(-1.5, 9.0, 3.6)).photo(noise=0.002)))
    assert "right" not in walls
    assert {"front", "left"} <= set(walls)


def test_a_mask_determines_the_walls(box_room: Callable):
    """Bookcases along all of the right wall: from depth alone, their fronts are the wall."""
    photo = box_room(pitch_deg=5.0, boxes=[((1.8, 2.2), (0.6, 3.8), (0.0, 2.5))]).photo(noise=0.002)
    seen = reconstruct(photo)
    assert _distance(seen, "right") == pytest.approx(1.8, abs=0.05)
    x = (unproject(photo.depth_m, photo.intrinsics) @ seen.radar_from_camera.T)[..., 0]
    index = np.where(x > 1.74, NAMES.index("shelf"), NAMES.index("wall-other")).astype(np.uint8)
    told = reconstruct(replace(photo, classes=ClassMask(index=index, names=NAMES)))
    assert "right" not in _walls(told)
    assert {"front", "left"} <= set(_walls(told))


def _distance(scene: Scene, name: str) -> float:
    wall = _walls(scene)[name]
    return float(-wall.centre_m @ wall.normal)
