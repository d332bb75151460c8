"""What is read roughly where nothing else reads it, and what is refused all the same."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import APPROXIMATED
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "activity", "said"),
    [
        ("a person is wiggling their arms", "wave", "is shown as waving with both hands"),
        ("a person puts both hands to his face", "hands_up", "is shown as holding the hands up before the face"),
        (
            "a person holds their arms straight up",
            "raise",
            "is shown as raising both hands overhead",
        ),
        ("the person is throwing a basketball", "throw", "'basketball' is not shown"),
        ("he kicks high in the air", "kick", "'mid-air' is not shown"),
        ("a person moves objects around", "reach", "is shown as reaching with one hand"),
    ],
)
def test_a_limb_or_the_known_words_stand_for_a_clause_which_is_said(text, activity, said):
    plan = parse(text, in_part=True)
    assert [step.upper or step.lower for step in plan.steps] == [activity]
    assert plan.clauses[0].status == APPROXIMATED
    assert said in plan.clauses[0].how


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


def test_every_clause_of_a_rough_reading_says_what_it_is_shown_as():
    plan = parse("a person bends the left arm up at the elbow, turns left then steps up", in_part=True)
    shown = [record.how for record in plan.clauses if record.status == APPROXIMATED]
    assert shown
    assert all("shown as" in how for how in shown)
    assert [record.clause for record in plan.clauses if record.status == "done"] == ["turns left"]  # says just that
    assert {record.status for record in parse("a person walks forward, then turns left", in_part=True).clauses} == {
        "done"
    }
