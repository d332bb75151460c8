"""Ways that the movements of the library do not go."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person holds the left arm out and the right arm up", "both arms are shown alike"),
        ("a person hops down off of something", "not shown"),
        ("a person steps up, then steps down", "'steps up' is shown on level ground"),
        (
            "a person gets up from the chair, walks around it and sits down",
            "is shown as walking to and fro",
        ),
        ("a person jogs with arms held forward", "'arms held forward' is shown as arms to the sides"),
    ],
)
def test_ways_that_are_not_gone_are_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks through a circular path",
        "a person opens a door and walks through it",
        "a person walks around the room",
        "a person steps up to the table",
        "a person walks holding both arms out to the sides",
    ],
)
def test_ways_that_are_gone_need_no_word(sentence: str) -> None:
    hows = " ".join(record.how for record in parse(sentence).clauses)
    assert "level ground" not in hows
    assert "through" not in hows
    assert "around" not in hows
    assert "'to the sides'" not in hows
