"""The verbs of a clause: which words name a movement, and which a thing."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("text", "ways"),
    [
        ("takes 2 steps to the right walks to the left then back to the right", ["right", "left", "right"]),
        ("takes three steps forward walks back", ["forwards", "back"]),
        ("walks to the left walks to the right", ["left", "right"]),
        ("jumps to the left jumps to the right", ["left", "right"]),
        ("walks forward steps back", ["forwards", "backwards"]),
        ("walks forward three steps", ["forwards"]),
        ("walks four straight steps forward", ["forwards"]),
    ],
)
def test_a_gait_with_a_way_of_its_own_is_a_movement(text: str, ways: list[str]) -> None:
    assert [step.direction for step in parse(f"a person {text}", in_part=True).steps] == ways


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
