"""What is read roughly where nothing else reads it, and what is refused all the same."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    "text",
    [
        "a person does a handstand with both hands",
        "the person is acting scared",
        "a person never lifts the arms",
        "someone looks at their right foot",
        "a dog wiggles its legs",
    ],
)
def test_no_limb_stands_for_the_whole_body_a_negation_or_an_animal(text):
    with pytest.raises(InputError):
        parse(text, in_part=True)


def test_labelled_data_is_not_read_roughly():
    with pytest.raises(InputError):
        parse("a person is wiggling their arms")


@pytest.mark.parametrize(
    "text", ["a person walks without waving", "a person walks, but does not wave", "someone walks so nobody hears him"]
)
def test_what_is_not_done_is_left_out_beside_what_is(text):
    plan = parse(text, in_part=True)
    assert [step.lower for step in plan.steps] == ["walk"]
    assert any("what is not done is left out" in record.how for record in plan.clauses)
