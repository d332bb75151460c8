"""The verbs of a clause: which words name a movement, and which a thing."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("picks up two boxes", [("pick_up", "")]),
        ("carries some boxes to the table", [("walk", "carry")]),
        ("boxes", [("stand", "punch")]),
        ("picks up a box and boxes", [("pick_up", ""), ("stand", "punch")]),
    ],
)
def test_boxes_after_a_number_are_things(text: str, steps: list[tuple[str, str]]) -> None:
    assert [(step.lower, step.upper) for step in parse(f"a person {text}", in_part=True).steps] == steps
