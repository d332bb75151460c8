"""What happens at the same time: legs of one and arms of the other, or a hand each."""

from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.simultaneous import overlay
from mmweaver.motion.language.timing import plan_motion


def test_overlay_takes_legs_of_one_and_arms_of_the_other():
    walk, wave = parse("walks to the left slowly").steps[0], parse("waves with the left hand twice").steps[0]
    both = overlay(walk, wave)
    assert (both.lower, both.upper, both.hand, both.direction, both.count) == ("walk", "wave", "left", "left", 2)
    assert overlay(wave, walk).name == both.name


def test_what_is_carried_upstairs_is_carried_all_the_way():
    for text in ("a person carries a box up the stairs", "a woman hauls two bags downstairs"):
        plan = plan_motion(text)
        assert [(step.lower, step.upper) for step in plan.steps] == [("stairs", "carry")], text
        assert plan.duration_s > 4.0  # a whole step up and down
        assert "stairs" in " ".join(plan.notes)
