import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "lost"),
    [
        ("walks to the left three times", "how often is not kept"),
        ("stirs the soup four times", "how often is not kept"),
        ("claps with the left hand", "which hand or foot it is is not shown"),
        ("dances with the left foot", "which hand or foot it is is not shown"),
    ],
)
def test_what_no_step_keeps_is_said(text: str, lost: str):
    (clause,) = parse(text).clauses
    assert clause.status == "approximated"
    assert lost in clause.how


def test_notes_of_what_is_repeated_say_what_the_records_say():
    plan = parse("a person sways back and forth, photosynthesises, and then does this again", in_part=True)
    assert plan.steps[0].count == 2
    assert {note for note in plan.notes if "is shown as" in note} <= {clause.sentence for clause in plan.clauses}
    assert plan.clauses[-1].status == "approximated"
