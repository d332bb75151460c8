"""Punches, strokes, kicks and lunges that go somewhere are known by their names, in their order, with their sides."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize("text", ["a person crosses the room", "a person hangs a coat on a hook"])
def test_a_cross_or_hook_that_nobody_throws_is_no_punch(text: str):
    try:
        keys = {step.upper for step in parse(text, in_part=True).steps}
    except InputError:
        keys = set()
    assert not keys & {"cross", "hook", "jab", "punch"}


def test_tennis_is_shown_as_its_strokes_and_said():
    plan = parse("a person plays tennis")
    assert [step.upper for step in plan.steps] == ["forehand", "backhand"]
    assert "is shown as a forehand with one hand once, then a backhand with one hand once" in plan.notes[0]
