"""Lengths, speeds and rates in any unit reach the fields of steps; other numbers do not become measures."""

import pytest

from mmweaver.motion.language.measures import measures_in_si
from mmweaver.motion.language.plan import APPROXIMATED, Shape, Side, Way
from mmweaver.motion.language.sentence import parse


@pytest.mark.parametrize(
    ("words", "fields"),
    [
        ("walks 2 m away from the radar", {"distance_m": 2.0, "direction": Way.AWAY}),
        ("walks six feet to the left", {"distance_m": 1.83, "direction": Side.LEFT}),
        ("walks 10 inches backwards", {"distance_m": 0.25, "direction": Way.BACKWARDS}),
        ("walks two yards forward", {"distance_m": 1.83, "direction": Way.FORWARDS}),
        ("walks one and a half metres", {"distance_m": 1.5}),
        ("crawls 80 cm forwards", {"distance_m": 0.8}),
        ("walks towards the radar at 1.2 m/s", {"speed_mps": 1.2, "seconds": 0.0, "direction": Way.TOWARDS}),
        ("walks at 3.6 km/h", {"speed_mps": 1.0}),
        ("walks at a speed of 2 mph", {"speed_mps": 0.89}),
        ("runs at two metres per second for 3 seconds", {"speed_mps": 2.0, "seconds": 3.0}),
        ("walks at 100 steps per minute", {"steps_hz": 100 / 60, "count": 0}),
        ("turns 90° to the right", {"direction": Side.RIGHT}),
        ("turns around 180°", {"direction": Shape.AROUND}),
    ],
)
def test_measures_become_fields(words: str, fields: dict[str, object]):
    step = parse(f"a person {words}").steps[0]
    assert {name: getattr(step, name) for name in fields} == pytest.approx(fields)


@pytest.mark.parametrize(
    "text",
    [
        "a person stands on two feet",
        "a person jumps with both feet",
        "a person claps three times",
        "a person stamps with the left foot",
        "a 5 feet 10 inches tall man waves",
        "a person waves for 3 seconds",
    ],
)
def test_what_is_no_measure_stays(text: str):
    assert measures_in_si(text) == text


@pytest.mark.parametrize("text", ["a person waves at 2 m/s", "a person jumps one metre forwards"])
def test_a_measure_that_no_step_keeps_is_reported(text: str):
    assert parse(text).clauses[0].status == APPROXIMATED
