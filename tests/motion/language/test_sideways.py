"""Steps to a side that a sentence names once for several walks."""

import pytest

from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    "text", ["sidesteps left four steps, and then right four steps", "sidesteps left, then 4 steps right"]
)
def test_steps_without_a_verb_go_on_sideways(text: str) -> None:
    there, back = parse(f"a person {text}").steps
    assert (there.lower, there.direction) == ("sidestep", "left")
    assert (back.lower, back.direction, back.count) == ("sidestep", "right", 4)


def test_a_walk_after_sidesteps_is_a_walk() -> None:
    there, back = parse("a person sidesteps left, then walks four steps right").steps
    assert (there.lower, back.lower) == ("sidestep", "walk")


@pytest.mark.parametrize(
    ("text", "ways"),
    [
        ("sidesteps to the left, then back to the starting position", ["left", "right"]),
        ("sidesteps to the left, then to the right, then back to the left", ["left", "right", "left"]),
    ],
)
def test_who_has_come_back_is_at_the_starting_position(text: str, ways: list[str]) -> None:
    assert [step.direction for step in parse(f"a person {text}").steps] == ways
