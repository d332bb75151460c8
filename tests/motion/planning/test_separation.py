"""Distances between bodies, against hand-made figures."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.motion.planning.separation import are_separate, is_clear_of, separations_m
from tests.rooms import standing_person


@pytest.mark.parametrize("apart_m", [0.8, 1.5])
def test_gaps_of_two_who_stand_side_by_side(apart_m: float):
    one, other = standing_person((0.0, 2.0, -1.2)), standing_person((apart_m, 2.0, -1.2))
    pelvis_m, body_m = separations_m(one, other)
    assert pelvis_m == pytest.approx(apart_m)
    assert body_m == pytest.approx(apart_m - 2 * 0.24 - 2 * 0.035, abs=0.04)  # from wrist to wrist
    assert separations_m(other, one) == pytest.approx((pelvis_m, body_m))


def test_bodies_that_overlap_are_not_apart():
    one, other = standing_person((0.0, 2.0, -1.2)), standing_person((0.5, 2.0, -1.2))
    assert separations_m(one, other)[1] < 0
    assert not are_separate(one, other)
    assert are_separate(one, standing_person((0.0, 2.6, -1.2)))
    assert not are_separate(one, standing_person((0.0, 2.45, -1.2)))  # the pelvises


def test_they_are_compared_at_the_same_times():
    """One walks where the other was before."""
    ahead = standing_person((0.0, 2.0, -1.2), (1.0, 0.0, 0.0))
    behind = standing_person((-0.9, 2.0, -1.2), (1.0, 0.0, 0.0))
    late = replace(behind, joints_m=behind.joints_m - np.array([0.5, 0, 0]))
    assert are_separate(ahead, behind)
    assert separations_m(ahead, late)[0] == pytest.approx(1.4)
    assert not are_separate(ahead, standing_person((1.0, 2.0, -1.2)))


def test_a_way_keeps_clear_of_hands_too():
    person = standing_person((0.0, 2.0, -1.2))
    reaching = person.joints_m.copy()
    reaching[:, 20] = reaching[:, 18] + [0.6, 0.0, 0.0]
    time_s = np.linspace(0, 2, 41)
    track = np.tile([1.0, 2.0], (41, 1))
    assert is_clear_of(track, time_s, person)
    assert not is_clear_of(track, time_s, replace(person, joints_m=reaching))
