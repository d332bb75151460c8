"""Things: each belongs to a step, says nothing about movement, or is named."""

import pytest

from mmweaver.motion.language.plan import DONE
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person stands on a box", "'box' is not shown"),
        ("a person walks with a cane", "'cane' is not shown"),
        ("someone is playing an air banjo", "'banjo' is not shown"),
        ("a person bends over the patient", "'patient' is not shown"),
        ("a person is in a stance and punches", "'stance' is not shown"),
    ],
)
def test_things_that_no_step_has_are_named(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a burglar walks in the kitchen",
        "a person drinks a cup of coffee",
        "a person carries a heavy box to the table",
        "a person plays a guitar",
        "a person walks in a curve to the left",
        "a person pushes a chair aside",
        "he stirs a pot on the stove",
        "the person walks at a medium pace",
        "a person walks and comes to a stop",
    ],
)
def test_things_of_a_step_need_no_word(sentence: str) -> None:
    assert {record.status for record in parse(sentence).clauses} == {DONE}
