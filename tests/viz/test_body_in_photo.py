"""The body appears at its projection, is hidden behind what is nearer, and darkens what it touches."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.viz.body_in_photo import BodyPainter
from mmweaver.viz.body_rasteriser import bodies_of
from mmweaver.viz.figure_data import FigureData

RED = (1.0, 0.0, 0.0)


def painted(view: FigureData, depth_m: np.ndarray | None = None, scale: int = 1) -> np.ndarray:
    aligned = view.aligned
    assert aligned is not None
    photo = aligned.photo if depth_m is None else replace(aligned.photo, depth_m=depth_m)
    size = (120 * scale, 160 * scale)
    picture = np.full((*size, 3), 200, np.uint8)
    body = bodies_of(view.poses[0], np.array([0]))[0]
    BodyPainter(replace(aligned, photo=photo), size).paint(picture, [(body, RED)])
    return picture


def red(picture: np.ndarray) -> np.ndarray:
    return (picture[:, :, 0] > 60) & (picture[:, :, 1] < 20)


@pytest.mark.parametrize("scale", [1, 2])
def test_the_body_is_at_its_projection(view: FigureData, scale: int):
    assert view.aligned is not None
    is_red = red(painted(view, scale=scale))
    for name in ("pelvis", "left_wrist", "right_knee", "head"):
        column, row = view.aligned.project(view.poses[0].joints_m[0][[joint(name)]])[0][0]
        assert is_red[round((row + 0.5) * scale - 0.5), round((column + 0.5) * scale - 0.5)], name
    assert is_red.any(axis=0).sum() < 0.4 * 160 * scale  # and nowhere else


def test_the_body_is_hidden_behind_what_is_nearer(view: FigureData):
    free = red(painted(view))
    lower_half_hidden = np.full((120, 160), 4.0)
    lower_half_hidden[60:] = 1.0
    half = red(painted(view, lower_half_hidden))
    assert (half[:58] == free[:58]).all()
    assert free[62:].sum() > 100
    assert not half[62:].any()
    nothing_measured = np.full((120, 160), np.nan)
    assert (red(painted(view, nothing_measured)) == free).all()


def test_surfaces_near_the_body_are_darkened(view: FigureData):
    far = painted(view)
    wall_behind = painted(view, np.full((120, 160), 3.2))
    background = ~red(far) & ~red(wall_behind) & (far[:, :, 1] == 200)
    assert (wall_behind[background] < 190).all(axis=1).sum() > 50
    assert (wall_behind[:, 140:] == 200).all()
