"""One movement where a noun in the singular names it, several where it is a plural."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("does a hook and a right punch", ["a hook with one hand once", "then punching with the right hand once"]),
        ("throws a left punch", ["punching with the left hand once"]),
        ("throws a straight punch", ["punching with one hand once"]),
        ("throws punches", ["punching with both hands in turn repeatedly"]),
        ("does a squat", ["squatting once"]),
        ("does a squat three times", ["squatting three times"]),
        ("does a squat, three times", ["squatting three times", "squatting three times"]),
        ("takes a big jump", ["jumping once"]),
        ("seems to jump", ["jumping once or more"]),
        ("does a jumping jack", ["doing jumping jacks once"]),
        ("does a sit up", ["doing sit-ups once"]),
        ("does side lunges", ["lunging to the side with one leg, the arms out to the sides twice or more"]),
        ("does front lunges", ["lunging ahead with each leg in turn twice"]),
    ],
)  # fmt: skip
def test_one_or_several(text: str, shown: list[str]) -> None:
    assert [clause.shown for clause in parse(f"a person {text}", in_part=True).clauses] == shown


@pytest.mark.parametrize(
    "text", ["a person is in a squat", "a person punches", "a person does side lunges with the left leg"]
)
def test_what_is_left_open_has_no_number(text: str) -> None:
    assert all(step.count == 0 for step in parse(text, in_part=True).steps)


@pytest.mark.parametrize(
    ("text", "lower", "count"),
    [
        ("steps to the right three steps", "sidestep", 3),
        ("steps to the right two steps", "sidestep", 2),
        ("two steps to the right", "sidestep", 2),
        ("walks three steps to the right", "walk", 3),
        ("steps forward three steps", "walk", 3),
    ],
)
def test_steps_to_a_side_are_sidesteps_however_many(text: str, lower: str, count: int) -> None:
    (step,) = parse(f"a person {text}").steps
    assert (step.lower, step.count) == (lower, count)


@pytest.mark.parametrize(
    ("text", "several", "count"),
    [
        ("jumps up and down", True, 0),
        ("is jumping up and down for 5 seconds", True, 0),
        ("jumps up and down three times", False, 3),
        ("jumps up", False, 0),
    ],
)
def test_jumping_up_and_down_is_jumping_more_than_once(text: str, several: bool, count: int) -> None:
    plan = parse(f"a person {text}")
    assert [(step.several, step.count) for step in plan.steps] == [(several, count)]
    assert plan.clauses[0].status == "done"
