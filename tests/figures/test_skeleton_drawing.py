"""The skeleton is drawn at the projected joints, and occluded behind objects."""

import numpy as np
import pytest

from mmweaver.core.skeleton import joint
from mmweaver.figures.figure_data import FigureData
from mmweaver.figures.skeleton_drawing import SkeletonInPhoto, bone_pieces, is_occluded, project


def test_projection_follows_the_pinhole(view: FigureData):
    points_m = np.array([[0.0, 2.0, 0.0], [0.5, 2.0, 0.0], [0.0, 2.0, 0.5], [0.0, -1.0, 0.0]])
    pixels = project(points_m, view.aligned)
    lens = view.aligned.photo.intrinsics
    assert pixels[0] == pytest.approx([lens.cx, lens.cy, 2.0])
    assert pixels[1] == pytest.approx([lens.cx + lens.fx * 0.25, lens.cy, 2.0])  # right is right
    assert pixels[2] == pytest.approx([lens.cx, lens.cy - lens.fy * 0.25, 2.0])  # up is up
    assert np.isnan(pixels[3]).all()  # behind the camera


def test_points_behind_the_block_are_occluded(view: FigureData):
    behind, before, aside, unknown = [130.0, 100.0, 3.0], [130.0, 100.0, 0.9], [20.0, 20.0, 3.0], [500.0, 20.0, 3.0]
    nothing = [np.nan, np.nan, np.nan]
    pixels = np.array([behind, before, aside, unknown, nothing])
    assert is_occluded(pixels, view.aligned.photo).tolist() == [True, False, False, False, False]


def test_bones_begin_and_end_at_the_joints(view: FigureData):
    joints_m = view.poses[0].joints_m[0]
    pieces, occluded = bone_pieces(joints_m, view.aligned)
    assert len(pieces) == len(occluded) > 21
    ends = pieces.reshape(-1, 2)
    for pixel in project(joints_m, view.aligned)[:, :2]:
        assert np.linalg.norm(ends - pixel, axis=1).min() < 1e-6


def test_the_skeleton_is_drawn_at_its_projection(view: FigureData):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = view.aligned.photo.rgb.shape[:2]
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
    axes.set_axis_off()
    SkeletonInPhoto(axes, view.aligned).show(view.poses[0].joints_m[0], (1.0, 0.0, 0.0))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())
    red = np.argwhere((picture[:, :, 0] > 150) & (picture[:, :, 1] < 110))
    for name in ("pelvis", "left_wrist", "right_knee", "neck"):
        column, row, _ = project(view.poses[0].joints_m[0][[joint(name)]], view.aligned)[0]
        assert np.abs(red - [row, column]).max(axis=1).min() <= 2, name
    assert np.ptp(red[:, 1]) < 0.4 * width  # and nowhere else
