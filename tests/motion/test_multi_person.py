"""Several people composed for one room."""

from itertools import combinations
from typing import Any

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.compose import compose
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.multi_person import compose_people
from mmweaver.motion.planning.separation import separations_m
from mmweaver.propagation.body_model import body_of
from tests.rooms import floor, scene_of

SCENE = scene_of((floor(),))
REST: dict[str, Any] = {"range_window_m": (0.7, 3.48)}
TEXTS = ["a person walks to the left", "a person walks to the right", "someone does jumping jacks", "a man claps"]
PLANS = [plan_motion(text, 2.0) for text in TEXTS]


@pytest.mark.parametrize("seed", range(2))
def test_nobody_comes_too_near(seed: int):
    people = compose_people(PLANS[:3], SCENE, seed=seed, **REST)
    for one, other in combinations(people, 2):
        pelvis_m, body_m = separations_m(one.pose, other.pose)
        assert pelvis_m >= 0.5
        assert body_m >= 0.02


@pytest.mark.parametrize("seed", range(1))
def test_the_radars_own_bodies_do_not_touch_either(seed: int):
    """No corner of one person's hull lies within the other's capsules, at any time."""
    people = compose_people(PLANS[:2], SCENE, seed=seed, **REST)
    for mover, other in ((0, 1), (1, 0)):
        one, two = people[mover].pose, people[other].pose
        corners, _ = body_of(one).hull(one.joints_m[::12])
        posed = body_of(two).posed(two.joints_m[::12])
        starts, axes = posed.start_m, posed.axis_m
        radii = body_of(two).radii_m.max(axis=1) * 1.25
        for at in range(len(corners)):
            gap = corners[at][:, None] - starts[at][None]
            share = np.clip((gap * axes[at]).sum(-1) / np.maximum((axes[at] ** 2).sum(-1), 1e-9), 0, 1)
            apart = np.linalg.norm(gap - share[..., None] * axes[at][None], axis=-1)
            assert (apart > radii - 0.03).all()


def test_the_first_is_what_it_would_be_alone_and_the_same_seed_the_same():
    people = compose_people(PLANS[:2], SCENE, seed=5, **REST)
    again = compose_people(PLANS[:2], SCENE, seed=5, **REST)
    alone = compose(PLANS[0], SCENE, seed=5, **REST)
    assert np.array_equal(people[0].pose.joints_m, alone.pose.joints_m)
    assert np.array_equal(people[1].pose.joints_m, again[1].pose.joints_m)
    assert people[0].pose.subject != people[1].pose.subject


def test_equal_texts_are_different_people():
    one, two = compose_people([PLANS[3]] * 2, SCENE, seed=0, **REST)
    assert one.pose.height_m != two.pose.height_m


def test_a_crowd_is_refused_and_so_are_places_too_near():
    small = (0.7, 1.6)
    with pytest.raises(InputError, match=r"6 people"):
        compose_people([PLANS[2]] * 6, SCENE, seed=0, range_window_m=small)
    with pytest.raises(InputError, match="next to"):
        compose_people([PLANS[3]] * 2, SCENE, seed=0, starts_m=[(0.0, 2.0), (0.1, 2.0)], **REST)


def test_heights_are_each_persons_own():
    one, two, three = compose_people(PLANS[:3], SCENE, seed=0, heights_m=[1.7, None, 1.9], **REST)
    assert (one.pose.height_m, three.pose.height_m) == (1.7, 1.9)
    assert 1.4 < two.pose.height_m < 2.0


def test_subjects_are_chosen_and_differ():
    one, two = compose_people(PLANS[:2], SCENE, seed=0, subjects=[7, None], **REST)
    assert one.pose.subject == 7 != two.pose.subject
    with pytest.raises(InputError, match="must differ"):
        compose_people(PLANS[:2], SCENE, seed=0, subjects=[7, 7], **REST)


def test_who_is_there_already_stays_and_the_others_keep_clear():
    recorded = compose(PLANS[0], SCENE, seed=9, **REST)
    people = compose_people([None, *PLANS[1:3]], SCENE, seed=0, first=recorded, **REST)
    assert people[0] is recorded
    assert len({person.pose.subject for person in people}) == 3
    for one, other in combinations(people, 2):
        assert separations_m(one.pose, other.pose)[0] >= 0.5
    assert compose_people([None], SCENE, seed=0, first=recorded, **REST) == (recorded,)
