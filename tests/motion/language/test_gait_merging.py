"""A gait, a way and a speed that are said of a whole walk hold for all of its parts."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "speeds"),
    [
        ("person walked forwards and backwards very slowly", [-1, -1]),
        ("a person jogs forwards and backwards fast", [1, 1]),
        ("a person steps left and right quickly", [1, 1]),
        ("walks slowly in an s shaped pattern", [-1, -1]),
        ("a person quickly runs in a zigzag", [1, 1]),
        ("a man walks in a figure eight slowly", [-1, -1]),
        ("slowly, a person walks forward and turns around", [-1, -1]),
        ("a person walks forward, turns around and walks back, slowly", [-1, -1, -1]),
        ("a person raises the left arm, then the right arm slowly", [0, -1]),
        ("a person bends left and right slowly", [-1, -1]),
        ("a person walks forward and slowly backward", [0, -1]),
        ("a person walks forward slowly and then quickly walks backward", [-1, 1]),
        ("a person walks forward, then sits down slowly", [0, -1]),
        ("a person slowly walks forward, turns around and walks back", [-1, 0, 0]),
    ],
)
def test_a_speed_holds_for_all_that_it_is_said_of(text: str, speeds: list[int]) -> None:
    assert [step.speed for step in parse(text, in_part=True).steps] == speeds


def test_both_curves_of_a_run_are_run() -> None:
    assert {step.lower for step in parse("a person runs in a zigzag", in_part=True).steps} == {"jog"}


def test_both_circles_of_a_jog_are_jogged() -> None:
    steps = parse("a person jogs slowly in a figure 8", in_part=True).steps
    assert [(step.lower, step.style) for step in steps] == [("jog", "jog"), ("jog", "jog")]


def test_all_of_a_walk_is_sideways_where_its_first_clause_says_so() -> None:
    plan = parse("a person walks sideways, four steps to the left, four steps back", in_part=True)
    assert [(step.lower, step.direction) for step in plan.steps] == [("sidestep", "left"), ("sidestep", "right")]
