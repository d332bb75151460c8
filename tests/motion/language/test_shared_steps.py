"""A clause that says "again" or another side has a step of its own, or its record says that it has none."""

import pytest

from mmweaver.motion.language.clause_parser import ParsedClause
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.shared_steps import says_again, shown_only_once
from mmweaver.motion.language.words import words_of


def clause(number: int, text: str, *steps: Step) -> ParsedClause:
    return ParsedClause("then", text, steps=[*steps], number=number, words=words_of(text))


JUMP = Step(lower="jump")


@pytest.mark.parametrize(
    ("clauses", "how"),
    [
        ([clause(0, "jumps", JUMP), clause(1, "jumps again", JUMP)], ["the second time is not shown"]),
        ([clause(0, "jumps", JUMP), clause(1, "lands again")], []),
        ([clause(0, "rests", Step()), clause(1, "rests again", Step())], []),
        ([clause(0, "leans to the left"), clause(1, "to the right")], ["the other side is not shown"]),
        ([clause(0, "leans to the left"), clause(1, "to the left")], []),
        ([clause(0, "pushed from_left"), clause(1, "from_right")], ["the other side is not shown"]),
        ([clause(0, "pushed from_left"), clause(1, "stumbles to the right")], []),
        ([clause(0, "puts them up"), clause(1, "down"), clause(2, "up again")], ["the second time is not shown"]),
        ([clause(0, "kicks one leg", JUMP), clause(1, "then another")], ["the other one is not shown"]),
    ],
)
def test_what_shares_a_step_is_not_done_twice(clauses: list[ParsedClause], how: list[str]) -> None:
    numbers = tuple(range(len(clauses)))
    shared = [Step(lower="jump", clauses=numbers)]
    assert list(shown_only_once(clauses, shared)) == [(numbers[-1], one) for one in how]
    own = [Step(lower="jump", clauses=numbers[: k + 1]) for k in numbers]
    assert not list(shown_only_once(clauses, own))


def test_once_again_is_again() -> None:
    assert says_again(clause(0, "waves again"))
    assert not says_again(clause(0, "waves"))


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("goes right and then left and then left again", [("walk", "right"), ("walk", "left"), ("walk", "left")]),
        ("jogs to their left and then their right before stopping", [("jog", "right"), ("jog", "left"), ("stand", "")]),
        ("stumbles to the left and then stumbles to the right", [("stumble", "left"), ("stumble", "right")]),
        ("is pushed and stumbles forward, gets pushed again and stumbles", [("stumble", "forwards"), ("stumble", "")]),
        ("is pushed from the left and stumbles to the right", [("stumble", "right")]),
        ("jumps left and right", [("leap", "left"), ("leap", "right")]),
        ("crawls forward, then backward", [("crawl", "forwards"), ("crawl", "backwards")]),
        ("takes a step to the side and back", [("sidestep", "right"), ("sidestep", "left")]),
        ("takes a step to the left and two to the right", [("sidestep", "left"), ("sidestep", "right")]),
    ],
)
def test_the_second_one_has_its_own_step(text: str, steps: list[tuple[str, str]]) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert [(step.lower, step.direction) for step in plan.steps] == steps


@pytest.mark.parametrize("text", ["points to the left, then to the right", "points to the left and to the right"])
def test_each_side_is_pointed_to(text: str) -> None:
    assert [step.facing for step in parse(f"a person {text}").steps] == ["left", "right"]


@pytest.mark.parametrize("text", ["lifts both arms, then lowers the left one", "kicks a ball, then another one"])
def test_what_one_step_cannot_show_is_said(text: str) -> None:
    assert [clause.status for clause in parse(f"a person {text}").clauses] == ["done", "approximated"]


def test_another_step_is_one_more() -> None:
    for text in ("takes a step forward, then another", "takes a step forward and then another step forward"):
        assert [step.count for step in parse(f"a person {text}").steps] == [1, 1]


@pytest.mark.parametrize(
    ("text", "turns_deg"),
    [
        ("spins clockwise then counterclockwise", [-360.0, 360.0]),
        ("turns 180 degrees to the left and then to the right", [180.0, -180.0]),
    ],
)
def test_the_second_turn_goes_the_other_way_round(text: str, turns_deg: list[float]) -> None:
    assert [step.turn_deg for step in parse(f"a person {text}").steps] == turns_deg


def test_the_second_circle_goes_the_other_way_round() -> None:
    steps = parse("a person walks in a circle to the left and then to the right").steps
    assert [step.arc_deg for step in steps] == [360.0, -360.0]


def test_a_bow_back_is_no_bow_ahead() -> None:
    steps = parse("a person leans forward then backward").steps
    assert [(step.lower, step.direction) for step in steps] == [("bend", ""), ("lean", "backwards")]


def test_two_back_are_two() -> None:
    assert [step.count for step in parse("a person takes one step forward and two back").steps] == [1, 2]


def test_an_arm_out_and_the_other_ahead() -> None:
    (step,) = parse("a person holds the left arm out and the right arm forward").steps
    assert step.other_hand is not None
    assert {(step.hand, step.direction), (step.other_hand.hand, step.other_hand.direction)} == {
        ("left", ""),
        ("right", "forwards"),
    }


@pytest.mark.parametrize(
    ("text", "turns"),
    [
        ("pivots on his left foot and does a half turn", 1),
        ("pivots on his left foot, then turns to the left", 2),
        ("pivots on his left foot and turns around again", 2),
        ("turns around and turns to the left", 2),
    ],
)
def test_how_far_a_pivot_turns_is_no_second_turn(text: str, turns: int) -> None:
    assert [step.lower for step in parse(f"a person {text}").steps] == ["turn"] * turns
