import pytest

from mmweaver.motion.language.sentence import parse

ALL_OF_IT = {
    "a person bows, then claps and repeats this twice": ["bow", "clap"] * 3,
    "multiple times, a human bows and sits down": [*["bow", "sit_down", "stand_up"] * 2, "bow", "sit_down"],
    "a person kneels down, gets up. Repeat.": ["kneel_down", "kneel_up"] * 2,
}


@pytest.mark.parametrize(("text", "doing"), ALL_OF_IT.items())
def test_a_whole_sentence_is_done_several_times(text: str, doing: list[str]):
    plan = parse(text)
    assert [step.upper if step.lower == "stand" else step.lower for step in plan.steps] == doing
    assert plan.clauses[-1].status == "done"
    assert all(len(plan.clauses) - 1 in step.clauses for step in plan.steps[-2:] if step.clauses)


def test_one_movement_is_counted():
    (squats,) = parse("three times, a person squats").steps
    assert (squats.lower, squats.count) == ("squat", 3)


@pytest.mark.parametrize(
    ("text", "rounds"),
    [("walks in two circles", 2), ("walks in a circle to the right twice", -2), ("walks clockwise", -1)],
)
def test_rounds_of_a_circle(text: str, rounds: int):
    (step,) = parse(text).steps
    assert (step.direction, step.arc_deg, step.count) == ("circle", 360.0 * rounds, 0)


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


def test_sitting_down_and_standing_up_is_counted_as_the_exercise_it_is():
    assert [step.lower for step in parse("a person does three sit-to-stands").steps] == ["sit_down", "stand_up"] * 3
    steps = parse("sit to stand, five reps, arms folded across the chest").steps
    assert len(steps) == 10
    assert {step.upper for step in steps if step.lower == "stand_up"} == {"cross_arms"}


def test_notes_of_what_is_repeated_say_what_the_records_say():
    plan = parse("a person sways back and forth, photosynthesises, and then does this again", in_part=True)
    assert plan.steps[0].count == 2
    assert {note for note in plan.notes if "is shown as" in note} <= {clause.sentence for clause in plan.clauses}
    assert plan.clauses[-1].status == "approximated"
