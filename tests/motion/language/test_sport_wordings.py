"""Punches, strokes, kicks and lunges that go somewhere are known by their names, in their order, with their sides."""

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import DONE
from mmweaver.motion.language.sentence import parse

COMBINATIONS = {
    "a boxer throws a jab, a cross and a hook": [("jab", "", 0), ("cross", "", 0), ("hook", "", 0)],
    "jab, cross, hook": [("jab", "", 0), ("cross", "", 0), ("hook", "", 0)],
    "a man does a left jab, right cross, left hook": [("jab", "left", 0), ("cross", "right", 0), ("hook", "left", 0)],
    "a person throws three jabs and two hooks": [("jab", "", 3), ("hook", "", 2)],
    "a person throws a one-two": [("jab", "", 0), ("cross", "", 0)],
    "a guy shadow boxes: jab, jab, cross": [("jab", "", 0), ("jab", "", 0), ("cross", "", 0)],
    "a person throws an uppercut with the right": [("uppercut", "right", 0)],
    "a person swings a tennis racket, forehand first and then backhand": [("forehand", "", 0), ("backhand", "", 0)],
    "a person hits a two-handed backhand": [("backhand", "both", 0)],
    "someone serves a tennis ball with the right hand": [("tennis_serve", "right", 0)],
}
MOVEMENTS = {
    "a person does a turning kick with the right leg": ("roundhouse", "right", 0),
    "a human performs a left roundhouse kick": ("roundhouse", "left", 0),
    "a person kicks sideways with the left leg": ("side_kick", "left", 0),
    "a person does five walking lunges": ("walking_lunge", "", 5),
    "a person spins a hula hoop": ("hula_hoop", "", 0),
    "a person is moving the hips in a circle as if using a hula hoop": ("hula_hoop", "", 0),
}


@pytest.mark.parametrize(("text", "known"), COMBINATIONS.items())
def test_strokes_and_punches_follow_each_other_as_they_are_named(text: str, known: list[tuple[str, str, int]]):
    plan = parse(text)
    assert [(step.upper, step.hand, step.count) for step in plan.steps] == known
    assert {clause.status for clause in plan.clauses} == {DONE}, plan.notes


@pytest.mark.parametrize(("text", "known"), MOVEMENTS.items())
def test_kicks_lunges_and_hips_are_known_by_their_names(text: str, known: tuple[str, str, int]):
    (step,) = parse(text).steps
    assert (step.lower, step.foot, step.count) == known


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
