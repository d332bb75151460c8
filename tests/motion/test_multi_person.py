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


def test_the_first_is_what_it_would_be_alone_and_the_same_seed_the_same():
    people = compose_people(PLANS[:2], SCENE, seed=5, **REST)
    again = compose_people(PLANS[:2], SCENE, seed=5, **REST)
    alone = compose(PLANS[0], SCENE, seed=5, **REST)
    assert np.array_equal(people[0].pose.joints_m, alone.pose.joints_m)
    assert np.array_equal(people[1].pose.joints_m, again[1].pose.joints_m)
    assert people[0].pose.subject != people[1].pose.subject


def test_a_crowd_is_refused_and_so_are_places_too_near():
    small = (0.7, 1.6)
    with pytest.raises(InputError, match=r"6 people"):
        compose_people([PLANS[2]] * 6, SCENE, seed=0, range_window_m=small)
    with pytest.raises(InputError, match="next to"):
        compose_people([PLANS[3]] * 2, SCENE, seed=0, starts_m=[(0.0, 2.0), (0.1, 2.0)], **REST)


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
