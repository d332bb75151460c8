"""Windows and mirrors get the depth of their plane."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.records import CameraIntrinsics, ClassMask, RgbdPhoto
from mmweaver.scene.coco_stuff import NAMES
from mmweaver.scene.layout.transparent_surfaces import with_transparent_surfaces

SHAPE = (120, 160)
LENS = CameraIntrinsics(fx=120.0, fy=120.0, cx=79.5, cy=59.5, width=160, height=120)


def wall_with_pane(behind_m: float, name: str = "window-other") -> tuple[RgbdPhoto, np.ndarray, np.ndarray]:
    """An oblique wall from 2.5 to 4 m with a pane that shows `behind_m`: its depth, and the mask of the pane."""
    wall_m = 1 / np.linspace(1 / 2.5, 1 / 4.0, 160)[None, :] + np.zeros((120, 1))
    pane = np.zeros(SHAPE, bool)
    pane[30:80, 60:110] = True
    index = np.where(pane, NAMES.index(name), 0).astype(np.uint8)
    photo = RgbdPhoto(
        rgb=np.zeros((*SHAPE, 3), np.uint8), depth_m=np.where(pane, behind_m, wall_m), intrinsics=LENS,
        classes=ClassMask(index=index, names=NAMES),
    )  # fmt: skip
    return photo, wall_m, pane


@pytest.mark.parametrize("name", ["window-other", "mirror-stuff"])
@pytest.mark.parametrize("behind_m", [float("nan"), 9.0])
def test_holes_and_points_behind_are_put_on_the_walls_plane(behind_m: float, name: str):
    photo, wall_m, _ = wall_with_pane(behind_m, name)
    closed, sentences = with_transparent_surfaces(photo)
    assert closed.depth_m == pytest.approx(wall_m, rel=0.01)
    assert sentences[0].startswith("1 windows or mirrors")


def test_a_vase_before_the_window_stays():
    photo, wall_m, _ = wall_with_pane(9.0)
    vase = photo.depth_m.copy()
    vase[60:80, 70:80] = 1.9
    closed, _ = with_transparent_surfaces(replace(photo, depth_m=vase))
    assert (closed.depth_m[60:80, 70:80] == 1.9).all()
    assert closed.depth_m[35:55, 65:105] == pytest.approx(wall_m[35:55, 65:105], rel=0.01)


def test_other_classes_and_borders_that_are_not_planar_are_left():
    photo, _, _ = wall_with_pane(9.0, "couch")
    assert with_transparent_surfaces(photo) == (photo, ())
    assert with_transparent_surfaces(replace(photo, classes=None))[1] == ()
    ragged, _, pane = wall_with_pane(9.0)
    noise = np.random.default_rng(0).uniform(0.8, 6.0, SHAPE)
    lost = replace(ragged, depth_m=np.where(pane, 9.0, noise))
    assert with_transparent_surfaces(lost)[1] == ()
    empty = replace(ragged, depth_m=np.where(pane, 9.0, np.nan))
    assert with_transparent_surfaces(empty)[1] == ()


def test_a_curtain_next_to_a_pane_does_not_shift_its_plane():
    photo, wall_m, pane = wall_with_pane(9.0)
    assert photo.classes is not None
    index, depth = np.full(SHAPE, NAMES.index("wall-other"), np.uint8), photo.depth_m.copy()
    index[pane] = NAMES.index("window-other")
    curtain = np.zeros(SHAPE, bool)
    curtain[20:90, 50:60] = curtain[20:90, 110:120] = True
    index[curtain], depth[curtain] = NAMES.index("curtain"), wall_m[curtain] - 0.15
    closed, _ = with_transparent_surfaces(replace(photo, depth_m=depth, classes=ClassMask(index=index, names=NAMES)))
    assert closed.depth_m[pane] == pytest.approx(wall_m[pane], rel=0.01)


def test_a_screen_gets_its_own_plane_and_not_the_walls():
    photo, _, screen = wall_with_pane(float("nan"), "tv")
    depth = photo.depth_m.copy()
    depth[30:80:4, 60:110:3] = 2.2
    closed, sentences = with_transparent_surfaces(replace(photo, depth_m=depth))
    assert closed.depth_m[screen] == pytest.approx(np.full(screen.sum(), 2.2), rel=0.01)
    assert sentences == ("1 screens: their missing depth was filled by the plane of their measured pixels.",)
