"""What steps show is said wholly: as long as the body does it with the limb, the way and the count that are said."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.motion.animation.library.activity_registry import perform
from mmweaver.motion.animation.root_path import RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.animation.step_context import StepContext
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import Shape, Side, Step, Way
from mmweaver.motion.language.postures import doing, in_turn, steps_of_each

WALK, WAVE = Step(lower="walk"), Step(upper="wave")


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (Step(lower="walk", direction=Way.BACKWARDS, count=3, speed=-1), "walking three steps backwards slowly"),
        (Step(lower="walk", direction=Side.LEFT), "walking to the left in the photo"),
        (Step(lower="walk", direction=Way.BACK), "walking back the way it came"),
        (Step(lower="walk", direction=Shape.CIRCLE, arc_deg=-720.0), "walking in a circle clockwise, twice round"),
        (Step(lower="walk", arc_deg=90.0, either_side=True), "walking in an arc of 90 degrees"),
        (Step(lower="walk", target="door", distance_m=2.0), "walking 2 m to the door"),
        (Step(lower="walk", foot="left", count=1), "walking one step"),  # no foot begins it
        (Step(lower="walk", upper="wave", count=2), "walking while waving with one hand twice"),
        (Step(lower="jog", style="jog", direction=Shape.SPOT), "jogging on the spot"),
        (Step(lower="jog"), "running"),
        (Step(lower="turn", direction=Side.LEFT), "turning 90 degrees to the person's left"),
        (Step(lower="turn", turn_deg=-45.0), "turning 45 degrees to the person's right"),
        (Step(lower="turn", facing="window"), "turning to face the window"),
        (Step(lower="fall", style="left"), "falling on the person's left side"),
        (Step(lower="lie", style="front"), "lying on the belly"),
        (Step(lower="kneel_down", style="knee", foot="left"), "kneeling down on the left knee"),
        (Step(lower="sit", seat="sofa", upper="clap"), "sitting on the sofa while clapping repeatedly"),
        (Step(lower="lunge"), "lunging ahead with one leg once"),
        (Step(lower="lunge", count=2), "lunging ahead with each leg in turn twice"),
        (Step(lower="squat", several=True), "squatting twice or more"),
        (Step(lower="jump"), "jumping once or more"),
        (Step(lower="bend", style="held", seconds=3.0), "bending down and staying down for 3 s"),
        (Step(upper="raise", hand="left", count=12), "raising the left hand overhead and lowering it 12 times"),
        (Step(upper="raise_hold", hand="both"), "lifting both arms overhead and keeping them up"),
        (Step(lower="lean", direction=Side.LEFT, upper="raise_hold", hand="both"),
         "leaning to the person's left once while holding both arms up overhead"),
        (Step(lower="kneel_up", style="knee", foot="left"), "standing up from the left knee"),
        (Step(upper="arms_out", hand="right", direction=Way.FORWARDS), "holding the right arm out ahead"),
        (Step(upper="point", facing="left"), "pointing to the left in the photo with one hand once"),
        (Step(upper="wave", facing="towards"), "waving with one hand repeatedly, facing the radar"),
        (Step(upper="clap", place=Place("near", "window")), "clapping repeatedly, near the window"),
        (
            Step(upper="drink", hand="left", other_hand=Step(upper="wave", hand="right", count=1)),
            "drinking with the left hand once or more while waving with the right hand once",
        ),
    ],
)  # fmt: skip
def test_all_that_a_step_shows_is_said(step: Step, words: str) -> None:
    assert doing(step) == words


def test_order_and_repetitions_of_several_steps() -> None:
    assert in_turn([WALK, WAVE]) == "walking, then waving with one hand repeatedly"
    assert in_turn([WALK, WAVE] * 2) == "walking, then waving with one hand repeatedly, all of this twice"
    assert in_turn([WALK] * 2) == "walking, twice in a row"
    assert in_turn([WALK, WALK, WAVE]) == "walking, and again, then waving with one hand repeatedly"


def _acted(step: Step) -> np.ndarray:
    """Angles of both arms (n, 2, 4) in radians of a step of three seconds on the spot."""
    time_s = np.arange(0.0, 3.0, 1 / 30)
    context = StepContext(
        time_s=time_s, step=replace(step, end_s=3.0), body=SkeletonProportions(1.75),
        path=RootPath(start_m=(0.0, 3.0), heading_rad=-0.5 * np.pi), rng=np.random.default_rng(0),
    )  # fmt: skip
    return perform(context).arm_rad


@pytest.mark.parametrize("hand", ["left", "right", "both"])
def test_the_hands_that_are_said_are_those_that_move(hand: str) -> None:
    for key in ("wave", "raise", "reach", "point", "comb", "wipe", "swipe", "draw_circle", "arms_out", "hips", "push"):
        step = Step(upper=key, hand=hand)
        still = _acted(replace(step, upper=""))
        moved = np.abs(_acted(step) - still).max(axis=(0, 2)) > 0.25
        words = doing(step)
        both = any(part in words for part in (" both ", "the arms ", "the hands "))
        said = [both or f"the {side} " in words for side in ("left", "right")]
        assert list(moved) == said, words


def test_every_activity_has_words() -> None:
    for key, activity in BY_KEY.items():
        words = doing(Step(upper=key) if activity.hands else Step(lower=key))
        assert words
        assert "{" not in words
        assert "  " not in words


def test_a_step_of_several_clauses_counts_with_those_that_have_no_other() -> None:
    there, on, back = (replace(WALK, direction=way) for way in (*Side, Way.BACK))
    steps = [replace(there, clauses=(0,)), replace(on, clauses=(0, 1)), replace(back, clauses=(0, 1, 2))]
    assert steps_of_each(3, steps) == [[steps[0]], [steps[1]], [steps[2]]]
    waves = [Step(seconds=0.5, clauses=(0,)), replace(WAVE, clauses=(0, 1))]
    assert steps_of_each(2, waves) == [waves, waves[1:]]
    stops = Step(clauses=(1,))
    again = [replace(WALK, clauses=(0,)), stops, replace(WALK, clauses=(0, 2)), replace(stops, clauses=(1, 2))]
    assert steps_of_each(3, again) == [again[:1], again[1:2], again[2:]]
    twice = [replace(WALK, clauses=numbers) for numbers in ((0,), (0, 1), (0, 2), (0, 1, 2), (0, 2), (0, 1, 2))]
    assert steps_of_each(3, twice) == [twice[:1], twice[1:2], twice[2:]]
