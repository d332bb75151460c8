"""Durations in words: what they are in seconds, and which movement they belong to."""

import pytest

from mmweaver.motion.language.durations import durations_in_seconds
from mmweaver.motion.language.timing import plan_motion


@pytest.mark.parametrize(
    ("words", "seconds"),
    [
        ("one minute and a half", 90.0),
        ("a minute and a half", 90.0),
        ("two and a half minutes", 150.0),
        ("half a minute", 30.0),
        ("a quarter of a minute", 15.0),
        ("one minute and twenty-five seconds", 85.0),
        ("1 min 30 s", 90.0),
        ("a second and a half", 1.5),
        ("10.5 secs", 10.5),
        ("a couple seconds", 2.0),
        ("forty seconds", 40.0),
    ],
)
def test_a_sentence_lasts_as_long_as_its_words_say(words: str, seconds: float):
    plan = plan_motion(f"a person waves for {words}")
    assert plan.duration_s == pytest.approx(seconds)
    assert [clause.status for clause in plan.clauses] == ["done"], plan.clauses


def test_points_in_time_and_ordinal_numbers_are_no_durations():
    for text in ("bows a second time", "waves, two seconds later", "after ten seconds waves", "with one hand"):
        assert durations_in_seconds(text) == text


def test_each_movement_that_stands_for_another_takes_its_share():
    plan = plan_motion("a person does yoga for twenty seconds")
    assert plan.duration_s == pytest.approx(20.0)
    assert [step.seconds for step in plan.steps] == [10.0, 10.0]


@pytest.mark.parametrize(
    "text",
    [
        "a person lifts the left arm and holds it for five seconds",
        "a person stretches and holds the pose for 5 seconds",
    ],
)
def test_what_is_held_lasts_as_long_as_it_is_held(text: str):
    plan = plan_motion(text)
    assert len(plan.steps) == 1
    assert plan.duration_s == pytest.approx(5.0)
