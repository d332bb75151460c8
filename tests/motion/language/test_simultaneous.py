"""What happens at the same time: legs of one and arms of the other, or a hand each."""

import pytest

from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.simultaneous import overlay
from mmweaver.motion.language.timing import plan_motion


def test_overlay_takes_legs_of_one_and_arms_of_the_other():
    walk, wave = parse("walks to the left slowly").steps[0], parse("waves with the left hand twice").steps[0]
    both = overlay(walk, wave)
    assert (both.lower, both.upper, both.hand, both.direction, both.count) == ("walk", "wave", "left", "left", 2)
    assert overlay(wave, walk).name == both.name


@pytest.mark.parametrize("text", ["claps while drinking", "waves with the left hand while drinking with the left hand"])
def test_what_needs_the_same_hand_follows_and_is_said_to(text: str) -> None:
    plan = parse(text, in_part=True)
    assert len(plan.steps) == 2
    assert any("one after the other" in clause.how for clause in plan.clauses)


def test_what_is_carried_upstairs_is_carried_all_the_way():
    for text in ("a person carries a box up the stairs", "a woman hauls two bags downstairs"):
        plan = plan_motion(text)
        assert [(step.lower, step.upper) for step in plan.steps] == [("stairs", "carry")], text
        assert plan.duration_s > 4.0  # a whole step up and down
        assert "stairs" in " ".join(plan.notes)


def test_a_last_participle_on_the_spot_is_said_to_follow() -> None:
    plan = parse("a person is boxing, bouncing lightly on the feet")
    assert "one after the other" in plan.clauses[-1].how


def test_who_works_bent_stays_bent() -> None:
    plan = plan_motion("a person leans over and wipes the table")
    assert plan.steps[0].style == "held"
