"""Material guesses: the names are those of the standard, and metal and glass are not guessed."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import ClassMask, RgbdPhoto, Scene
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.layout.surface_materials import MATERIAL_NAMES, floor_material
from mmweaver.scene.layout.transparent_surfaces import with_transparent_surfaces
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


def test_names():
    assert MATERIAL_NAMES == (
        "concrete", "brick", "plasterboard", "wood", "glass", "ceiling_board", "chipboard", "plywood", "marble",
        "floorboard", "metal", "fabric",
    )  # fmt: skip


def classed(photo: RgbdPhoto, scene: Scene, name_of_wall: str, name_of_floor: str) -> RgbdPhoto:
    """The photo with a class mask of its back wall and floor, from their known positions."""
    from mmweaver.geometry.pinhole import unproject

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


def test_geometry_decides_where_the_class_implies_none(box_room: Callable):
    photo = box_room().photo()
    guessed = reconstruct(photo)
    told = reconstruct(classed(photo, guessed, "wall-other", "rug"))
    assert np.array_equal(told.face_material, guessed.face_material)
    assert [plane.material for plane in told.planes] == [plane.material for plane in guessed.planes]


@pytest.mark.parametrize(("name", "material"), [("window-other", "glass"), ("mirror-stuff", "metal")])
@pytest.mark.parametrize("behind_m", [float("nan"), 12.0])
def test_a_pane_in_the_wall_is_on_its_plane_and_of_its_material(
    box_room: Callable, name: str, material: str, behind_m: float
):
    """The camera sees through the window (or another room in the mirror); the radar meets the pane."""
    photo = box_room(pitch_deg=0.0).photo()
    pane = np.zeros(photo.depth_m.shape, bool)
    pane[50:100, 120:200] = True
    index = np.where(pane, NAMES.index(name), NAMES.index("wall-other")).astype(np.uint8)
    spoilt = replace(
        photo, depth_m=np.where(pane, behind_m, photo.depth_m), classes=ClassMask(index=index, names=NAMES)
    )
    closed, _ = with_transparent_surfaces(spoilt)
    assert closed.depth_m[pane] == pytest.approx(photo.depth_m[pane], rel=0.02)
    scene = reconstruct(closed)
    corners = scene.vertices_m[scene.faces[scene.face_material == MATERIAL_NAMES.index(material)]].reshape(-1, 3)
    assert len(corners) > 50
    assert np.median(corners[:, 1]) == pytest.approx(3.8, abs=0.05)
