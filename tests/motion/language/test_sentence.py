"""Sentences become the right steps, or the error says why not."""

from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.activities import BODY, HANDS
from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse


def said(plan: MotionPlan) -> str:
    """'walking left slow x2 | waving left-hand': a short form to compare with."""
    parts = []
    for step in plan.steps:
        words = [step.name, step.direction, {-1: "slow", 0: "", 1: "fast"}[step.speed]]
        if step.hand and step.upper != "raise":
            words.append(f"{step.hand}-hand" if step.hand != "both" else "both-hands")
        words += [f"x{step.count}" if step.count else "", f"{step.seconds:g}s" if step.seconds else ""]
        words.append(f"facing-{step.facing}" if step.facing else "")
        parts.append(" ".join(word for word in words if word))
    return " | ".join(parts)


def test_every_example_of_the_table_is_read_as_its_activity():
    for activity in (*BODY, *HANDS):
        steps = parse(activity.example).steps
        assert activity.key in {step.lower for step in steps} | {step.upper for step in steps}, activity.example


REFUSED = read_toml(Path(__file__).with_name("refused.toml"))


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text[:30])
def test_refused_with_the_reason(text: str):
    with pytest.raises(InputError, match=REFUSED[text]) as error:
        parse(text)
    assert "\n" not in str(error.value)


def test_an_unknown_activity_says_what_comes_nearest_and_where_all_are_listed():
    with pytest.raises(InputError, match=r"standing, walking .*'mmweaver motions'"):
        parse("the person teleports")
    with pytest.raises(InputError, match="'a person dances'"):
        parse("a person grooves along")
