"""Sentences that are worded otherwise give the same movements."""

import pytest

from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.rewrite_rules import rewritten
from mmweaver.motion.language.sentence import parse

SAME = [
    ("walks with a slight limp on the right leg", "limps with the right leg"),
    ("walks in a clockwise circle", "walks in a circle clockwise"),
    ("kneels down on one knee", "kneels down one_knee"),
    ("takes a couple of steps", "takes two steps"),
    ("does to side jumps", "does two side jumps"),
]


def movements(text: str) -> list[tuple[object, ...]]:
    def movement(step: Step) -> tuple[object, ...]:
        return step.lower, step.upper, step.direction, step.foot, step.arc_deg

    return [movement(step) for step in parse(f"a person {text}", in_part=True).steps]


@pytest.mark.parametrize("stage", ["first", "phrases", "last"])
def test_a_plain_sentence_is_left_alone(stage: str):
    assert rewritten("a person walks to the left", stage) == "a person walks to the left"


@pytest.mark.parametrize(("text", "other"), SAME)
def test_other_words_give_the_same_movements(text: str, other: str):
    assert movements(text) == movements(other)


def test_punches_of_a_list_follow_each_other_with_their_hands():
    tokens = rewritten("a boxer throws a jab, a left cross and two hooks", "phrases")
    assert tokens == "a boxer jabs , then cross_punchs with the left hand , then hook_punchs two times"
