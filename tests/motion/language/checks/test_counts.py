"""Repetitions, and ways that change."""

import pytest

from mmweaver.motion.language.checks.counts import repeats
from mmweaver.motion.language.plan import DONE, Step
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person walks in all directions", "'in all directions' are not shown"),
        ("a person takes four steps and kicks with each step", "'with each step' is not shown"),
        ("a person stretches their arms out one at a time", "'one at a time' is not shown"),
        ("the person is doing arm lifts with his right arm", "'arm lifts' is shown once"),
        ("a person takes a step to the left and then to the right", "that it is one step is not kept"),
        ("a person takes a step forward, then the step back", "that it is one step is not kept"),
        ("a person turns 90 degrees to the left, then 90 more", "'then 90 more' is not shown"),
        ("a person turns in place for two full turns", "'two full turns' is not shown"),
        ("a person steps left and right twice", "'twice' is shown for one side"),
        ("a person kicks with the left leg, then the right leg, then both", "'both' is not shown"),
        ("a person drinks with both hands", "one hand is shown, not both"),
        ("a person points to the left with both of his arms", "one hand is shown, not both"),
        ("a person swings the golf club with the right hand", "both hands are shown, not one"),
        ("a person runs to the right and then reverses", "is shown as running backwards"),
        ("a person sits down and stands up repeatedly", "'repeatedly' is not shown"),
    ],
)
def test_what_is_not_repeated_is_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person nods several times",
        "a person claps repeatedly",
        "a person does squats",
        "a person does side lunges with the left leg",
        "a person takes one step to the left and one step to the right",
        "a person spins three times to the left",
        "a person punches with both hands alternately",
        "a person raises one hand and then the other.",
        "a person kicks with one foot then the other",
        "a person waves with both hands",
        "a person picks up a box with both hands",
    ],
)
def test_what_is_repeated_is_done(sentence: str) -> None:
    assert {record.status for record in parse(sentence).clauses} == {DONE}


def test_once_or_more_than_once() -> None:
    """By the count, else by what is done in its natural time."""
    assert repeats(Step(upper="clap"))
    assert repeats(Step(lower="kick", count=2))
    assert repeats(Step(lower="walk", direction="left"))
    assert not repeats(Step(lower="kick"))
    assert not repeats(Step(upper="raise"))
    assert not repeats(Step(upper="clap", count=1))
