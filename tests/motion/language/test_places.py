"""Places of a sentence: what the words mean, and where the planner puts them."""

from pathlib import Path

import numpy as np
import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.records import Landmark
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.places import Place, mark_places, place_of, room_of
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.named_places import cells_of, settled
from rooms import room

PLACES = read_toml(Path(__file__).with_name("places.toml"))
TABLE = Landmark(kind="table", position_m=np.array([0.0, 2.0, -0.5]), approach_m=(0.0, 1.4), facing_rad=np.pi / 2)


@pytest.mark.parametrize(("text", "words"), PLACES.items())
def test_places_are_read(text: str, words: str):
    found = [step.place for step in parse(text).steps if step.place is not None]
    assert [place.words for place in found] == [words]


def test_somebody_else_is_faced_where_they_are():
    step = parse("a man waves to the woman on the right").steps[0]
    assert (step.place, step.facing) == (None, "right")
    plan = parse("a man on the left waves to a woman on the right")
    assert plan.steps[0].facing == "right"
    assert plan.clauses[0].status == "done"


def test_places_that_are_obeyed_are_done_or_say_what_is_not_shown():
    for text in ("a person waves in the far right corner", "a person claps between the table and the wall",
                 "a person walks to the wall", "a person goes to the middle of the room"):  # fmt: skip
        plan = parse(text)
        assert len(plan.clauses) == 1
        assert plan.clauses[0].status == "done"
    for text, how in (("stands against the wall", "is not touched"), ("waves in the doorway", "just before the door")):
        record = parse(f"a person {text}").clauses[0]
        assert record.status == "approximated"
        assert how in record.how


def test_what_only_hands_or_eyes_do_there_leaves_the_person_where_he_is():
    for text in ("puts a bag under the table", "kicks a ball outside", "picks up a ball from under the table",
                 "points to the corner", "walks around the corner"):  # fmt: skip
        assert "place_" not in mark_places(f"a person {text}")


def test_sides_of_the_body_are_no_places():
    for text in ("is pushed on the left side of the body", "kicks with the left foot", "walks to the left"):
        assert "place_" not in mark_places(text)
    assert place_of("place_range_150") == Place("range", distance_m=1.5)
    assert room_of("stands in the kitchen") == "kitchen"


def test_a_walk_goes_to_the_place_of_what_follows():
    steps = settled(parse("a person walks, then waves near the table")).steps
    assert steps[0].place == Place("near", "table")
    with pytest.raises(InputError, match="goes elsewhere"):
        settled(parse("a person walks to the left, then waves near the table"))


def test_cells_are_where_the_words_say():
    from dataclasses import replace

    floor = FloorMap(replace(room(), landmarks=(TABLE,)), (0.7, 3.5), 1.75)
    every = floor.cell_centres_m[floor.walkable]
    assert (
        cells_of(Place("behind", "table"), floor)[:, 1].min()
        > 2.0
        > cells_of(Place("front", "table"), floor)[:, 1].max()
    )
    assert (
        cells_of(Place("leftof", "table"), floor)[:, 0].max()
        < 0
        < cells_of(Place("rightof", "table"), floor)[:, 0].min()
    )
    assert cells_of(Place("left"), floor)[:, 0].max() < np.median(every[:, 0])
    away = np.hypot(*cells_of(Place("range", distance_m=2.0), floor).T)
    assert np.abs(away - 2.0).max() < 0.21
    with pytest.raises(InputError, match="no window"):
        cells_of(Place("near", "window"), floor)
    with pytest.raises(InputError, match=r"9 m from the radar"):
        cells_of(Place("range", distance_m=9.0), floor)


def test_two_places_are_both_obeyed_or_refused():
    floor = FloorMap(room(), (0.7, 3.5), 1.75)
    cells = cells_of(Place("range", distance_m=2.0).together_with(Place("left")), floor)
    assert len(cells)
    assert np.all(np.abs(np.hypot(*cells.T) - 2.0) < 0.21)
    assert np.all(cells[:, 0] < 0.1)
    with pytest.raises(InputError, match=r"0\.2 m from .* left"):
        cells_of(Place("range", distance_m=0.2).together_with(Place("left")), floor)
