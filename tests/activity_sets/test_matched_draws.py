"""Draws are spread over rooms, people, places and headings, and replaced where one label cannot be done."""

import numpy as np
import pytest

from mmweaver.activity_sets.matched_draws import MOST_ATTEMPTS, PlannedSequence, matched_draws, places_of, shuffled
from mmweaver.core.errors import InputError
from mmweaver.generate import Weaver

PLACES = [[(0.0, 2.0), (0.5, 2.5)], [(1.0, 2.0)]]


def test_rooms_and_people_take_turns():
    draws = list(matched_draws(PLACES, 24, 4, 0, lambda draw: ""))
    assert [draw.room for draw in draws[:4]] == [0, 1, 0, 1]
    people = [draw.subject for draw in draws]
    assert {people.count(one) for one in set(people)} == {6}
    assert len({draw.seed for draw in draws}) == 24
    assert np.ptp([draw.heading_rad for draw in draws]) > 4


def test_what_cannot_be_done_is_drawn_anew():
    draws = list(matched_draws(PLACES, 8, 2, 0, lambda draw: "no" if draw.heading_rad < 0 else ""))
    assert all(draw.heading_rad >= 0 for draw in draws)


def test_a_room_that_never_serves_is_refused():
    tried = []
    with pytest.raises(InputError, match="too small"):
        list(matched_draws(PLACES, 1, 1, 0, lambda draw: tried.append(draw) or "too small"))
    assert len(tried) == MOST_ATTEMPTS


def test_places_are_far_apart_and_free():
    scene = Weaver().sample_room().scene
    places = np.array(places_of(scene, (0.7, 3.4), 5, 0))
    assert len(places) == 5
    gaps = np.linalg.norm(places[:, None] - places[None], axis=-1)[np.triu_indices(5, 1)]
    assert gaps.min() > 0.3


def test_the_order_is_shuffled():
    draw = next(matched_draws(PLACES, 1, 1, 0, lambda draw: ""))
    sequences = [PlannedSequence(draw=draw, label=n % 3, sentence=0, text="") for n in range(60)]
    order = [one.label for one in shuffled(sequences, 0)]
    assert order != [one.label for one in sequences]
    assert sorted(order) == sorted(one.label for one in sequences)
