"""Postures last until a clause says otherwise: arms that are folded or held out, a body that stays down."""

import pytest

from mmweaver.motion.language.sentence import parse


def test_a_posture_that_is_held_for_a_time_lasts_that_long() -> None:
    (step,) = parse("a person crosses the arms and waits for five seconds").steps
    assert step.seconds > 5.0


def test_arms_that_come_down_for_the_head_are_said() -> None:
    clauses = parse("a person puts the hands on the hips and looks around").clauses
    assert clauses[-1].how.endswith("hands on the hips ends before it")


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
