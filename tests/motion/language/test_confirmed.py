"""A clause is done only where its steps, as sequences, show all of its words."""

import pytest

from mmweaver.motion.language.plan import APPROXIMATED, DONE
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks forward, turns around, walks back and sits down on a chair",
        "a man raises the left arm, then the right arm, then the left arm",
        "she walks forward three steps, back two steps and forward one step",
        "the person jogs to the left then to the right",
        "a person walks and comes to a stop",
        "the person was pushed to the right but did not fall",
        "a person nods then shakes the head then nods again",
        "a person picks up a ball with the right hand and throws it with the left",
        "a person does two jumping jacks and a squat",
        "a man sits down, drinks a cup of coffee and stands up again",
        "a person walks to the door and comes back",
        "a person twists left and right with the hands on the hips",
        "a nurse walks in a curve to the right",
    ],
)
def test_sentences_that_are_shown_whole_are_done(sentence: str) -> None:
    """The checks find nothing where nothing is missing."""
    plan = parse(sentence)
    assert {record.status for record in plan.clauses} == {DONE}, plan.notes


def test_somebody_who_gets_up_after_an_unknown_posture_gets_up_from_a_seat() -> None:
    """What is not known may not have been a seat."""
    plan = parse("a person gets into a sprinter's stance and then stands up", in_part=True)
    assert plan.clauses[-1].status == APPROXIMATED
    assert "standing up is shown from a seat" in plan.clauses[-1].how
