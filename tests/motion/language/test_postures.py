"""Postures last until the person gets up; a pause in one has its time."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("sits down, pauses, stands up", ["sit_down", "sit", "stand_up"]),
        ("kneels down, waits, and gets up", ["kneel_down", "kneel", "kneel_up"]),
        ("falls down, lies there for a bit and gets up", ["fall", "lie", "get_up"]),
        ("sits down, takes a short break, then gets up", ["sit_down", "sit", "stand_up"]),
        ("sits down and after a moment stands up", ["sit_down", "sit", "stand_up"]),
        ("stands still and then stands up", ["stand"]),
        ("sits down and stays there", ["sit_down"]),
        ("walks, makes a pause, and walks on", ["walk", "stand", "walk"]),
    ],
)
def test_a_pause_before_the_next_movement_is_a_step(text: str, steps: list[str]) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert [step.lower for step in plan.steps] == steps
    assert all(clause.status == "done" for clause in plan.clauses)


def test_a_pause_at_the_beginning_comes_before_the_movement() -> None:
    plan = parse("after a short pause a person walks forward", in_part=True)
    assert [step.lower for step in plan.steps] == ["stand", "walk"]


@pytest.mark.parametrize(
    ("text", "way", "style"),
    [
        ("trips and falls", "forwards", "front"),
        ("stumbles and falls", "forwards", "front"),
        ("is pushed and falls", "backwards", "back"),
        ("is pushed forward and falls", "forwards", "front"),
        ("is pushed and falls forward", "forwards", "front"),
    ],
)
def test_who_stumbles_falls_the_way_of_the_stumble(text: str, way: str, style: str):
    stumble, fall = parse(text).steps
    assert (stumble.direction, fall.style) == (way, style)


def test_who_falls_another_way_than_the_stumble_comes_upright_first():
    stumble, fall = parse("trips, then falls backwards").steps
    assert (stumble.direction, stumble.style, fall.style) == ("forwards", "", "back")


def test_a_stumble_that_lasts_as_long_as_is_said_is_no_short_one():
    stumble, fall = parse("stumbles for three seconds, then falls").steps
    assert (stumble.direction, stumble.style, stumble.seconds, fall.style) == ("forwards", "", 3.0, "front")
