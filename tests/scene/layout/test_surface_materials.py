"""Material guesses: the names are those of the standard, and metal and glass are not guessed."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import ClassMask, RgbdPhoto, Scene
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.layout.surfaces import MATERIAL_NAMES, floor_material
from mmweaver.scene.reconstruction import reconstruct


@pytest.mark.parametrize(
    ("colour", "name"),
    [
        ((0.62, 0.42, 0.24), "floorboard"),
        ((0.45, 0.45, 0.46), "concrete"),
        ((0.2, 0.3, 0.6), "concrete"),
        ((0.72, 0.68, 0.62), "concrete"),
    ],
)
def test_floor_by_colour(colour: tuple[float, ...], name: str):
    assert floor_material(np.tile(colour, (50, 1))) == name


def classed(photo: RgbdPhoto, scene: Scene, name_of_wall: str, name_of_floor: str) -> RgbdPhoto:
    """The photo with a class mask of its back wall and floor, from their known positions."""
    from mmweaver.core.pinhole import unproject

    points_m = unproject(photo.depth_m, photo.intrinsics) @ scene.radar_from_camera.T
    is_floor = points_m[..., 2] < scene.floor_z_m + 0.1
    index = np.where(is_floor, NAMES.index(name_of_floor), NAMES.index(name_of_wall)).astype(np.uint8)
    return replace(photo, classes=ClassMask(index=index, names=NAMES))


def test_the_class_decides_where_it_implies_a_material(box_room: Callable):
    photo = box_room().photo()
    guessed = reconstruct(photo)
    told = reconstruct(classed(photo, guessed, "wall-brick", "floor-wood"))
    assert {plane.material for plane in guessed.planes if plane.kind == "wall"} == {"plasterboard"}
    assert {plane.material for plane in told.planes if plane.kind == "wall"} == {"brick"}
    assert (guessed.floor.material, told.floor.material) == ("concrete", "floorboard")
    brick = (told.face_material == MATERIAL_NAMES.index("brick")).mean()
    assert brick > 0.4
    assert any("class of each pixel" in sentence for sentence in told.assumptions)
