"""A sphere is drawn as a disc of its size, lit from the left, and the nearer of two capsules is seen."""

import numpy as np
import pytest

from mmweaver.core.body_capsules import CAPSULES, TRUNK_WIDTH_PER_DEPTH
from mmweaver.core.records import PoseSequence
from mmweaver.viz.body_rasteriser import FACE_COUNT, CapsulesInPicture, bodies_of, rasterise, seen_width
from mmweaver.viz.figure_data import FigureData


def capsules(ends_px: list, depth_m: list, radius_px: float = 20.0, radius_m: float = 0.1) -> CapsulesInPicture:
    shape = (len(ends_px), 2)
    return CapsulesInPicture(
        ends_px=np.array(ends_px, float), depth_m=np.array(depth_m, float),
        radius_px=np.full(shape, radius_px), radius_m=np.full(shape, radius_m),
    )  # fmt: skip


def test_a_sphere_is_a_disc():
    seen = rasterise(capsules([[(50, 40), (50, 40)]], [(2.0, 2.0)]), (100, 100))
    assert seen is not None
    assert seen.cover.sum() == pytest.approx(np.pi * 20**2, rel=0.02)
    row, column = 40 - seen.rows.start, 50 - seen.columns.start
    assert seen.depth_m[row, column] == pytest.approx(1.9)
    assert seen.light[row, column - 12] > seen.light[row, column + 12], "the light comes from the left"
    assert seen.light[row - 12, column] > seen.light[row + 12, column], "and from above"


def test_the_nearer_capsule_is_seen_and_what_is_outside_is_cut():
    far_and_near = [[(10, 50), (90, 50)], [(50, 10), (50, 190)]]
    seen = rasterise(capsules(far_and_near, [(3.0, 3.0), (2.0, 2.0)]), (100, 100))
    assert seen is not None
    assert seen.rows.stop == 100
    row, column = 50 - seen.rows.start, 50 - seen.columns.start
    assert seen.capsule[row, column] == 1
    assert seen.capsule[row, column - 30] == 0
    assert np.isinf(seen.depth_m[row + 35, column - 35])
    assert rasterise(capsules([[(500, 50), (600, 50)]], [(2.0, 2.0)]), (100, 100)) is None


def test_the_trunk_is_wider_from_the_front_than_from_the_side():
    up, right, towards = np.array([[0.0, -100.0]]), np.array([[1.0, 0.0]]), np.array([[0.0, 0.0]])
    wider = np.array([TRUNK_WIDTH_PER_DEPTH])
    assert seen_width(up, right, wider) == pytest.approx(TRUNK_WIDTH_PER_DEPTH)
    assert seen_width(up, towards, wider) == pytest.approx(1.0)


def test_bodies_have_the_girth_of_the_person(view: FigureData):
    pose = view.poses[0]
    stout = PoseSequence(time_s=pose.time_s, joints_m=pose.joints_m, height_m=pose.height_m, girth=1.2)
    (body,), (wide_body,) = bodies_of(pose, np.array([0])), bodies_of(stout, np.array([0]))
    assert body.ends_m.shape == (len(CAPSULES) + FACE_COUNT, 2, 3)
    assert wide_body.radius_m[0] == pytest.approx(1.2 * body.radius_m[0])
