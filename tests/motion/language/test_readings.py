"""Sentences and how they are read: each row of readings.toml is a sentence of one person, and its steps in short."""

from pathlib import Path

import pytest

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.plan import DONE, Step
from mmweaver.motion.language.sentence import parse

READINGS = read_toml(Path(__file__).with_name("readings.toml"))


def short(step: Step) -> str:
    """A step as 'sidestep right x2': body, hands, direction, limbs, angles, style, target, speed, count, seconds."""
    doing = step.upper if step.lower == "stand" and step.upper else "+".join(filter(None, (step.lower, step.upper)))
    angles = (step.arc_deg and f"{step.arc_deg:g}deg", step.turn_deg and f"turn{step.turn_deg:g}")
    limbs = (step.hand and f"{step.hand}-hand", step.foot and f"{step.foot}-foot")
    goal = (step.target and f">{step.target}", step.facing and f"facing-{step.facing}", step.place and "@place")
    amount = (("", "fast", "slow")[step.speed], step.count and f"x{step.count}", step.seconds and f"{step.seconds:g}s")
    several = "several" if step.several else ""
    words: tuple[object, ...] = (doing, step.direction, *limbs, *angles, step.style, *goal, *amount, several)
    other = "" if step.other_hand is None else f" & {short(step.other_hand)}"
    return " ".join(str(word) for word in words if word) + other


@pytest.mark.parametrize("section", READINGS)
def test_sentences_are_read_as_these_steps(section: str):
    """A row ends in ~ where a clause is not shown as it is worded."""
    found = {}
    for text in READINGS[section]:
        plan = parse(text, in_part=True)
        is_done = all(clause.status == DONE for clause in plan.clauses)
        found[text] = ", ".join(map(short, plan.steps)) + " ~" * (not is_done)
    assert found == READINGS[section]
