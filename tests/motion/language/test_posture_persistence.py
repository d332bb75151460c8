"""Postures last until a clause says otherwise: arms that are folded or held out, a body that stays down."""

import pytest

from mmweaver.motion.language.sentence import parse


def doing(text: str) -> list[tuple[str, str]]:
    return [(step.lower, step.upper) for step in parse(f"a person {text}", in_part=True).steps]


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("folds the arms and waits", [("stand", "cross_arms")]),
        ("sits down, folds his arms and waits", [("sit_down", ""), ("sit", "cross_arms")]),
        ("stretches the arms out and stands on one leg", [("stand", "arms_out"), ("one_leg", "arms_out")]),
        ("puts the hands on the hips and squats twice", [("stand", "hips"), ("squat", "hips")]),
        ("raises both arms and waits", [("stand", "raise_hold")]),
        ("raises both arms, holds them for 3 seconds", [("stand", "raise_hold")]),
        ("raises the right arm, keeps it up and walks forward", [("stand", "raise_hold"), ("walk", "raise_hold")]),
    ],
)
def test_arms_stay_where_they_are(text: str, steps: list[tuple[str, str]]) -> None:
    assert doing(text) == steps


@pytest.mark.parametrize(
    ("text", "last"),
    [
        ("stretches the arms out, lowers them and waits", ("stand", "")),
        ("folds the arms and kneels down and crawls", ("crawl", "")),
        ("folds the arms and waves", ("stand", "wave")),
        ("raises the right arm, holds it, puts it down", ("stand", "")),
        ("raises both arms, holds them for 3 seconds, and brings them down", ("stand", "")),
        ("raises the right arm and puts it down", ("stand", "raise")),
        ("crosses their arms, then uncrosses them", ("stand", "")),
        ("sits with crossed arms and then uncrosses them", ("sit", "")),
        ("sits with his arms stretched out, he puts his hands in his lap", ("sit", "")),
    ],
)
def test_arms_do_not_stay_where_they_are_needed_or_brought_back(text: str, last: tuple[str, str]) -> None:
    assert doing(text)[-1] == last


@pytest.mark.parametrize(
    ("text", "lower", "style"),
    [
        ("squats and holds the position", "crouch", ""),
        ("crouches down and stays low", "crouch", ""),
        ("bends down and remains bent over", "bend", "held"),
        ("leans to the left and stays there", "lean", "held"),
        ("leans back and stays there for a moment", "lean", "held"),
    ],
)
def test_who_stays_down_is_not_up_again(text: str, lower: str, style: str) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert [(step.lower, step.style) for step in plan.steps] == [(lower, style)]
    assert all(clause.status == "done" for clause in plan.clauses)


def test_an_arm_that_is_put_down_after_it_was_held_is_held_before() -> None:
    assert doing("raises the right arm, holds it, puts it down") == [("stand", "raise_hold"), ("stand", "")]
    assert doing("raises the right arm and puts it down") == [("stand", "raise")]


def test_a_posture_that_is_held_for_a_time_lasts_that_long() -> None:
    (step,) = parse("a person crosses the arms and waits for five seconds").steps
    assert step.seconds > 5.0


def test_arms_that_come_down_for_the_head_are_said() -> None:
    clauses = parse("a person puts the hands on the hips and looks around").clauses
    assert clauses[-1].how.endswith("hands on the hips ends before it")


def test_a_raised_arm_stays_up_for_what_and_adds_not_for_what_follows() -> None:
    assert doing("raises the left arm and walks forward")[-1] == ("walk", "raise_hold")
    assert doing("raises the left arm, then walks forward")[-1] == ("walk", "")


def test_the_hand_that_was_raised_does_what_comes_next() -> None:
    for text in ("raises the left hand and scratches the head", "stretches the left arm out and points"):
        assert parse(f"a person {text}", in_part=True).steps[-1].hand == "left"


def test_who_stands_on_one_leg_moves_the_arms_there() -> None:
    assert doing("stands on the left leg and stretches the arms out") == [("one_leg", "arms_out")]


def test_the_hand_that_was_raised_throws() -> None:
    assert parse("a person raises the left hand and throws a ball").steps[-1].hand == "left"


@pytest.mark.parametrize(
    ("text", "hand"),
    [
        ("picks up a ball with the left hand and throws it", "left"),
        ("picks up a cup with the left hand and drinks", "left"),
        ("raises the left arm and punches", "left"),
        ("picks up a cup with the left hand, then waves", ""),
    ],
)
def test_the_hand_that_was_raised_or_took_something_does_what_comes_next(text: str, hand: str) -> None:
    assert parse(f"a person {text}").steps[-1].hand == hand


@pytest.mark.parametrize(
    ("text", "ahead"),
    [
        ("stretches both arms forward and walks", True),
        ("walks forward with the arms held out in front of him", True),
        ("holds both arms out to the sides and walks forward", False),
    ],
)
def test_a_walk_has_its_own_direction(text: str, ahead: bool) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert plan.steps[-1].moves
    assert plan.steps[-1].arms_ahead == ahead
    assert all(clause.status == "done" for clause in plan.clauses)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("bends down and stays there", "bending down and staying down"),
        ("bends down, pauses, then stands up", "bending down, staying down and coming up"),
        ("leans to the left, stays there and straightens up", "leaning to the person's left, staying so and coming up"),
    ],
)
def test_who_stays_down_comes_up_only_where_it_is_said(text: str, shown: str) -> None:
    assert parse(f"a person {text}", in_part=True).clauses[0].shown == shown


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("squats down, holds it for a moment, then stands up", ["crouch", "stand"]),
        ("crouches, holds still, then stands", ["crouch", "stand"]),
        ("squats, holds it, stands up and walks away", ["crouch", "walk"]),
        ("squats and stands up", ["squat"]),
        ("squats and stays down", ["crouch"]),
    ],
)
def test_who_was_held_low_stands_at_the_end_where_it_is_said(text: str, steps: list[str]) -> None:
    assert [step.lower for step in parse(f"a person {text}", in_part=True).steps] == steps


def test_a_leg_that_is_held_up_is_held() -> None:
    plan = parse("a person lifts the left leg and holds it up", in_part=True)
    assert [(step.lower, step.foot) for step in plan.steps] == [("one_leg", "right")]
    assert {clause.status for clause in plan.clauses} == {"done"}


def test_arms_that_were_up_during_a_walk_come_down_after_it() -> None:
    plan = parse("a person walks forward with the arms raised and then lowers them")
    assert [(step.lower, step.upper) for step in plan.steps] == [("walk", "raise_hold"), ("stand", "")]


@pytest.mark.parametrize(
    ("text", "upper"),
    [
        ("a person raises the right hand and keeps it up while walking", "raise_hold"),
        ("a person raises both arms and holds them there while he jogs", "raise_hold"),
        ("a person raises the right hand while he keeps walking", "raise"),
    ],
)
def test_an_arm_that_is_kept_up_during_a_walk_is_kept_up(text: str, upper: str) -> None:
    assert [step.upper for step in parse(text).steps] == [upper]


@pytest.mark.parametrize(
    ("text", "uppers"),
    [
        ("punches the air, then lowers his arms down", ["punch", ""]),
        ("raises both arms and then lowers his arms down", ["raise_hold", "lower_arm"]),
        ("raises his arms, walks slowly, stops, and then lowers his arms", ["raise_hold"] * 3 + [""]),
        ("raises his arms, walks, stops, lowers his arms and walks back", ["raise_hold"] * 3 + [""]),
        ("crosses the arms, waits, then lowers his arms", ["cross_arms", ""]),
        ("lowers the right arm straight down", ["lower_arm"]),
    ],
)
def test_arms_are_lowered_from_where_they_are(text: str, uppers: list[str]) -> None:
    assert [step.upper for step in parse(f"a person {text}", in_part=True).steps] == uppers
