"""Movements in order and as often as they are named."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("sentence", "how"),
    [
        ("a person walks and does a U-turn on the spot", "'turn' is not shown"),
        ("the person waves and after doing a round kick kicks with the left leg", "the order shown is"),
        (
            "a person sits down after waving and clapping",
            "the order shown is waving with one hand repeatedly, then sit",
        ),
        ("a person is doing the running man dance", "'running' is shown as a movement of its own"),
        ("he takes three steps to the right and two steps back in a side step motion", "'side step' is shown as a mov"),
    ],
)
def test_what_has_no_step_or_another_order_is_said(sentence: str, how: str) -> None:
    plan = parse(sentence, in_part=True)
    assert any(how in record.how for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    "sentence",
    [
        "a person walks a quarter circle to the left, taking five steps",
        "a man practices some dance steps",
        "a person raises the right hand and waves",
        "the person is pushed and stumbles to the left",
        "having jumped twice, the person sits down",
        "someone stopped and started running",
    ],
)
def test_words_that_say_more_of_a_movement_need_no_other(sentence: str) -> None:
    plan = parse(sentence, in_part=True)
    hows = " ".join(record.how for record in plan.clauses)
    assert "of its own" not in hows
    assert "is shown once" not in hows
    assert "the order" not in hows
