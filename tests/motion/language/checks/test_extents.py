"""Sizes, heights and ways about that the steps do not have."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person leans slightly forward", "'slightly' is not shown"),
        ("a person raises the left arm a bit", "'a bit' is not shown"),
        ("a person waves while stepping side to side", "'side to side' is not shown"),
        ("a person twists and stretches side to side", "'side to side' is not shown"),
        ("a person reaches to the ground", "'to the ground' is not shown"),
        ("a person reaches to the ground and then into the air", "'into the air' is not shown"),
        ("a person stumbles around", "'around' is not shown"),
        ("a person waves the arms and then the whole body", "'whole body' is not shown"),
        ("a person walks forward with arm outstretched", "both arms are shown, not one"),
        ("a person lifts the right arm across the body", "'across the body' is not shown"),
        ("a person waves at someone behind him", "'behind him' is not shown"),
    ],
)
def test_extents_that_no_step_has_are_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person turns slightly to the left",
        "a person waits for a bit",
        "a person hops slightly",
        "a person leans from side to side",
        "a person bends down and reaches to the floor",
        "a person reaches up into the air",
        "a person reaches into the air",
        "a person runs around",
        "a person dances around",
        "a person holds the left arm out",
        "a person walks with the arms out",
        "a person sits on the chair behind him",
    ],
)
def test_extents_that_steps_have_need_no_word(sentence: str) -> None:
    plan = parse(sentence)
    assert all(record.status == "done" for record in plan.clauses), plan.notes
