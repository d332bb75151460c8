"""The outcome of a clause follows from what the joints show, not from what the plan says."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.motion.compose import compose
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.verification.verify import NotDoneError, check_done, verified_clauses, verified_steps
from tests.motion.rooms import furnished, room, seat, sofa_room

WINDOW_M = (0.7, 5.5)


def statuses(text: str, scene=None, seed: int = 0) -> list[str]:
    motion = compose(plan_motion(text), scene or room(width_m=6, depth_m=6), range_window_m=WINDOW_M, seed=seed)
    return [clause.status for clause in motion.clauses]


@pytest.mark.parametrize(
    "text",
    [
        "a person walks 2 m away from the radar",
        "a person walks two metres backwards, then waves with the left hand",
        "a person walks towards the radar at 0.8 m/s",
        "a person turns 90 degrees to the left",
        "a person stands sideways to the radar",
        "a person squats three times",
        "a person falls backwards, lies for three seconds and gets up",
    ],
)
def test_what_the_joints_show_is_done(text: str):
    for seed in range(3):
        assert set(statuses(text, seed=seed)) == {DONE}


@pytest.mark.parametrize(
    ("text", "otherwise"),
    [
        ("a person walks two metres away from the radar", "a person walks towards the radar for two metres"),
        ("a person waves with the left hand", "a person waves with the right hand"),
        ("a person claps five times", "a person claps twice"),
        ("a person turns to the left", "a person turns to the right"),
        ("a person falls forwards", "a person stands"),
        ("a person walks at 0.7 m/s", "a person runs"),
        ("a person stands facing the radar", "a person stands facing left"),
    ],
)
def test_joints_of_another_sentence_are_not_what_this_one_says(text: str, otherwise: str):
    """The plan of one sentence is verified against the motion of another."""
    scene = room(width_m=6, depth_m=6)
    asked, other = plan_motion(text), plan_motion(otherwise)
    motion = compose(other, scene, range_window_m=WINDOW_M, seed=1)
    step = replace(asked.steps[0], start_s=0.0, end_s=other.duration_s)
    found = verified_clauses(asked.clauses, verified_steps([step], [step], motion.pose, scene))
    assert found[0].status in (APPROXIMATED, NOT_DONE)
    assert "asked" in found[0].how


def test_a_room_too_short_is_reported_with_the_value_shown():
    motion = compose(
        plan_motion("a person walks 3 m to the left"),
        room(width_m=2.6, depth_m=4),
        range_window_m=WINDOW_M,
        seed=0,
    )
    (clause,) = motion.clauses
    shown_m = -float(np.diff(motion.pose.joints_m[[2, -3], 0, 0])[0])
    assert clause.status != DONE
    assert f"3 m to the left asked, {shown_m:.1f}" in clause.how.replace(f"{shown_m:.2f}", f"{shown_m:.1f}")
    with pytest.raises(NotDoneError, match="3 m to the left asked"):
        check_done(motion.plan.text, motion.clauses)


@pytest.mark.parametrize("text", ["a person sits on the bed", "a person washes the hands at the sink"])
def test_a_thing_that_is_not_there_is_never_replaced_silently(text: str):
    for scene in (sofa_room(), furnished(), room(seats=(seat(),))):
        motion = compose(plan_motion(text), scene, range_window_m=WINDOW_M, seed=1)
        assert motion.clauses[0].status != DONE
        assert "is in the picture" in motion.clauses[0].how


def test_who_acts_on_a_thing_stands_before_it_and_faces_it():
    from mmweaver.scene.affordances.landmarks import add_landmarks

    scene = add_landmarks(room(width_m=6, depth_m=6), [("table", (0.8, 3.0))])
    for seed in range(3):
        motion = compose(plan_motion("a person wipes the table"), scene, range_window_m=WINDOW_M, seed=seed)
        facts = motion.verified[0].facts
        assert abs(facts.angle_to_deg((0.8, 3.0))) < 15
        assert 0.4 < facts.distance_m((0.8, 3.0)) < 1.0
        assert motion.clauses[0].facts[0]["posture"] == "feet"
