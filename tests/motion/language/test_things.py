"""Who acts on a thing faces it and stands there; who sits at a table faces it; pairs are repeated as counted."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "facing", "place"),
    [
        ("a person wipes the table", "table", "table"),
        ("a person stands next to the table, wipes it", "table", "table"),
        ("a person opens the door on the left", "door", "door"),
        ("a person opens the fridge", "fridge", "fridge"),
        ("a person knocks on the door", "door", "door"),
        ("a person sits at the desk and types", "desk", "desk"),
        ("a person looks out of the window", "window", ""),
        ("a person stands sideways to the radar", "sideways", ""),
        ("a person turns sideways to the camera", "sideways", ""),
        ("a person stirs a pot", "", ""),
        ("a person claps", "", ""),
    ],
)
def test_what_is_acted_on_is_faced(text: str, facing: str, place: str):
    step = parse(text).steps[-1]
    assert step.facing == facing
    assert (step.place.landmark if step.place else "") == place


def test_a_thing_that_is_walked_to_is_no_place_of_its_own():
    walk, wipe = parse("a person walks to the table and wipes it").steps
    assert (walk.target, wipe.facing, wipe.place) == ("table", "table", None)


def test_sitting_down_and_standing_up_are_repeated_together():
    steps = [step.lower for step in parse("a person sits down and stands up five times").steps]
    assert steps == ["sit_down", "stand_up"] * 5
    assert all(clause.status == "done" for clause in parse("a person sits down and stands up five times").clauses)
