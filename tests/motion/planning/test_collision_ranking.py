"""The way that keeps clear."""

import dataclasses
from collections.abc import Sequence

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.planning.body_samples import BodySamples
from mmweaver.motion.planning.collision import CollisionMap, Place
from mmweaver.motion.planning.collision_ranking import MARGIN_M, RankedPlacement, least_collision
from mmweaver.motion.planning.placement import Placement
from tests.motion.rooms import room
from tests.rooms import standing_person


class _Known(CollisionMap):
    """A wall's face at y = 2 m: a body is as deep in it as its pelvis is behind that."""

    def penetration_m(
        self, pose: PoseSequence | BodySamples, seats_m: Sequence[Place] = (), *, margin_m: float = 0.0, chair=None
    ):
        assert isinstance(pose, BodySamples)
        return max(float(pose.pelvis_m[1]) - 2.0 + margin_m, 0.0)

    def estimates_m(
        self, bodies: Sequence[BodySamples], seats_m: Sequence[Sequence[Place]], *, margin_m: float, chairs=()
    ):
        return np.array([self.penetration_m(body, margin_m=margin_m) for body in bodies])


def _chosen(*penetration_m: list[float]):
    """`depth_m`: how deep the placements of each draw get in; further draws find no way."""
    drawn: list[int] = []

    def draw(again: int) -> list[Placement]:
        drawn.append(again)
        if again >= len(penetration_m):
            raise InputError("no other")
        return [_placement(deep) for deep in penetration_m[again]]

    return least_collision(draw, _moved, _Known(room())), drawn


def _moved(placement: Placement) -> PoseSequence:
    return standing_person((*placement.path.start_m, -1.1), seconds=0.2)


def _depth_m(best: RankedPlacement) -> float:
    return round(best.placement.path.start_m[1] - 2.0, 3)


def _placement(penetration_m: float) -> Placement:
    path = RootPath(start_m=(0.0, 2.0 + penetration_m), heading_rad=-np.pi / 2, moves=(), turns=())
    return Placement(path=path, steps=(), seats_m=(), assumptions=())


def test_the_first_that_keeps_the_margin_is_taken():
    best, drawn = _chosen([0.01, -MARGIN_M - 0.001, -0.3])
    assert _depth_m(best) == round(-MARGIN_M - 0.001, 3)
    assert drawn == [0]
    assert best.notes == ()


def test_seats_are_left_only_where_one_gets_in_so_far_that_it_is_said():
    best, drawn = _chosen([0.02, 0.05], [0.015], [-0.2])
    assert (_depth_m(best), drawn) == (0.015, [0, 1])
    best, drawn = _chosen([0.05], [0.04], [-0.2])
    assert (_depth_m(best), drawn) == (-0.2, [0, 1, 2])


def test_nothing_but_what_the_camera_sees_of_the_trunk_decides_between_two_free_seats():
    """Alike but for that, and in either order; the legs of neither are seen, the trunk of the farther one is not."""
    scene = room()
    legs_low = scene.photo.depth_m.copy()
    legs_low[24:] = 1.0  # a table before both hides what is lower than the camera
    scene = dataclasses.replace(scene, photo=dataclasses.replace(scene.photo, depth_m=legs_low))
    seats = [dataclasses.replace(_placement(y - 2.0), seats_m=((0.0, y),)) for y in (3.8, 2.4)]
    for order in (seats, seats[::-1]):
        best = least_collision(lambda _again, order=order: order, _moved, _Open(scene))
        assert best.placement.seats_m == ((0.0, 2.4),)


class _Open(CollisionMap):
    """Nothing stands there."""

    def penetration_m(
        self, pose: PoseSequence | BodySamples, seats_m: Sequence[Place] = (), *, margin_m: float = 0.0, chair=None
    ):
        return 0.0


@pytest.mark.parametrize("others", [[], [[0.08]]])
def test_the_better_of_bad_ones_is_taken_and_said(others: list[list[float]]):
    best, _ = _chosen([0.07, 0.05], *others)
    assert best.penetration_m == pytest.approx(0.05, abs=1e-6)
    assert "5 cm into furniture" in best.notes[0]
