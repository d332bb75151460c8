"""The way that keeps clear."""

from collections.abc import Sequence

import numpy as np
import pytest
from tests.motion.rooms import room
from tests.rooms import standing_person

from mmweaver.core.errors import InputError
from mmweaver.core.records import PoseSequence
from mmweaver.motion.clearest import MARGIN_M, clearest
from mmweaver.motion.obstacles import Obstacles
from mmweaver.motion.placement import Placement
from mmweaver.motion.root_path import RootPath

POSE = standing_person((0.0, 2.0, -1.1), seconds=0.2)


class _Known(Obstacles):
    """Says what a pose's height says."""

    def deepest_m(self, pose: PoseSequence, seats_m: Sequence[tuple[float, float]] = (), *, margin_m: float = 0.0):
        return max(pose.height_m - 1.0 + margin_m, 0.0)


def _chosen(first: list[float], again: list[float] | None):
    """`first` and `again`: how deep the placements of the two draws get in."""
    drawn: list[bool] = []

    def draw(second: bool) -> list[Placement]:
        drawn.append(second)
        if second and again is None:
            raise InputError("no other")
        return [_placement(deep) for deep in ((again or []) if second else first)]

    def moved(placement: Placement) -> PoseSequence:
        return PoseSequence(
            joints_m=POSE.joints_m, time_s=POSE.time_s, height_m=1.0 + placement.path.heading_rad, subject=0
        )

    return clearest(draw, moved, _Known(room())), drawn


def _placement(deep_m: float) -> Placement:
    path = RootPath(start_m=(0.0, 2.0), heading_rad=deep_m, moves=(), turns=())
    return Placement(path=path, moves=(), seat_height_m=(), seats_m=(), assumptions=())


def test_the_first_that_keeps_the_margin_is_taken():
    best, drawn = _chosen([0.01, -MARGIN_M - 0.001, -0.3], None)
    assert best.placement.path.heading_rad == -MARGIN_M - 0.001
    assert drawn == [False]
    assert best.notes == ()


def test_others_are_drawn_where_none_keeps_clear():
    best, drawn = _chosen([0.05, 0.02], [0.04, -0.2])
    assert drawn == [False, True]
    assert best.placement.path.heading_rad == -0.2


@pytest.mark.parametrize("again", [None, [0.08]])
def test_the_better_of_bad_ones_is_taken_and_said(again: list[float] | None):
    best, _ = _chosen([0.07, 0.05], again)
    assert best.deep_m == pytest.approx(0.05, abs=1e-6)
    assert "5 cm into furniture" in best.notes[0]


def test_numbers_are_numbers():
    assert np.isfinite(_chosen([0.0], None)[0].deep_m)
