"""Draws are spread over rooms, people, places and headings, and replaced where one label cannot be done."""

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.datasets.paired_sampling import (
    MAX_ATTEMPTS,
    MAX_OWN_ATTEMPTS,
    StartPlace,
    paired_draws,
    places_of,
    unpaired_reasons,
)
from mmweaver.weaver.front_door import Weaver


def place(x_m, y_m):
    return StartPlace(centre_m=(x_m, y_m), free_m=np.array([[x_m, y_m]]), cell_m=0.05)


PLACES = [[place(0.0, 2.0), place(0.5, 2.5)], [place(1.0, 2.0)]]


def serves_all(draw, label):
    return ""


def test_rooms_and_people_take_turns_and_labels_share_their_draw():
    draws = list(paired_draws(PLACES, 24, 4, 0, 3, serves_all))
    assert all(one is each[0] and one.is_shared for each in draws for one in each)
    draws = [each[0] for each in draws]
    assert [draw.room for draw in draws[:4]] == [0, 1, 0, 1]
    people = [draw.subject for draw in draws]
    assert {people.count(one) for one in set(people)} == {6}
    assert len({draw.seed for draw in draws}) == 24
    assert np.ptp([draw.heading_rad for draw in draws]) > 4


def test_what_cannot_be_done_is_drawn_anew_for_all_labels():
    draws = list(paired_draws(PLACES, 8, 2, 0, 2, lambda draw, label: "no" if draw.heading_rad < 0 < label else ""))
    assert all(draw.heading_rad >= 0 and draw.is_shared for each in draws for draw in each)


def test_a_label_that_needs_another_place_than_the_others_has_its_own_draw_of_the_same_person():
    def obstacle(draw, label):
        return "" if (draw.place == 1) == (label == 2) else "no"

    draws = list(paired_draws(PLACES[:1], 6, 2, 0, 3, obstacle))
    for waves, walks, falls in draws:
        assert waves is walks
        assert (waves.is_shared, waves.place) == (True, 0)
        assert (falls.is_shared, falls.place) == (False, 1)
        assert (falls.subject, falls.seed, falls.index) == (waves.subject, waves.seed, waves.index)
    flat = [draw for each in draws for draw in each]
    reasons = unpaired_reasons(flat, [0, 1, 2] * 6, ["waves", "walks", "falls"])
    assert all("'falls' starts elsewhere 6 times" in reasons[name] for name in ("start_place", "heading"))
    assert not unpaired_reasons([waves for waves, _, _ in draws], [0] * 6, ["waves"])


def test_a_room_that_never_serves_is_refused():
    tried = []
    with pytest.raises(InputError, match="too small"):
        list(paired_draws(PLACES, 1, 1, 0, 1, lambda draw, label: tried.append(draw) or "too small"))
    assert len(tried) == MAX_ATTEMPTS + MAX_OWN_ATTEMPTS


def test_draws_start_on_the_free_floor():
    free_m = np.array([[0.0, 2.0], [0.3, 2.1]])
    here = StartPlace(centre_m=(0.0, 2.0), free_m=free_m, cell_m=0.05)
    starts = np.array([each[0].start_m for each in paired_draws([[here]], 40, 1, 0, 1, serves_all)])
    off_m = np.abs(starts[:, None] - free_m).max(axis=-1)
    assert (off_m.min(axis=1) <= 0.0255).all()
    assert set(off_m.argmin(axis=1)) == {0, 1}


def test_places_are_far_apart_and_free():
    scene = Weaver().sample_room().scene
    places = np.array([one.centre_m for one in places_of(scene, (0.7, 3.4), 5, 0)])
    assert len(places) == 5
    gaps = np.linalg.norm(places[:, None] - places[None], axis=-1)[np.triu_indices(5, 1)]
    assert gaps.min() > 0.3
