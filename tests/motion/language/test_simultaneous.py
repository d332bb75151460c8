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


@pytest.mark.parametrize(
    ("text", "hands"),
    [
        ("waves with the right hand while drinking with the left", {"wave": "right", "drink": "left"}),
        ("writes with the right hand while talking on the phone", {"write": "right", "phone": "left"}),
        ("walks, waving while drinking", {"wave": "right", "drink": "left"}),
        ("puts the left hand on the hip and points ahead with the right hand", {"hips": "left", "point": "right"}),
    ],
)
def test_two_hands_do_two_things_at_once(text: str, hands: dict[str, str]) -> None:
    (step,) = parse(f"a person {text}", in_part=True).steps
    assert {part.upper: part.hand for part in step.each} == hands
    assert all(clause.status == "done" for clause in parse(f"a person {text}", in_part=True).clauses)


@pytest.mark.parametrize("text", ["claps while drinking", "waves with the left hand while drinking with the left hand"])
def test_what_needs_the_same_hand_follows_and_is_said_to(text: str) -> None:
    plan = parse(text, in_part=True)
    assert len(plan.steps) == 2
    assert any("one after the other" in clause.how for clause in plan.clauses)


def test_one_hand_after_the_other_stays_so() -> None:
    steps = parse("a man raises the left arm and then the right arm").steps
    assert [(step.hand, step.other_hand) for step in steps] == [("left", None), ("right", None)]


def test_what_is_carried_upstairs_is_carried_all_the_way():
    for text in ("a person carries a box up the stairs", "a woman hauls two bags downstairs"):
        plan = plan_motion(text)
        assert [(step.lower, step.upper) for step in plan.steps] == [("stairs", "carry")], text
        assert plan.duration_s > 4.0  # a whole step up and down
        assert "stairs" in " ".join(plan.notes)


@pytest.mark.parametrize(
    ("text", "acted"),
    [
        ("bends down and picks up a box", [("pick_up", "")]),
        ("crouches for five seconds, then picks up a ball", [("crouch", ""), ("pick_up", "")]),
        ("raises the right hand and waves it a few times", [("stand", ""), ("stand", "wave")]),
        ("claps, raises the right hand and waves it", [("stand", "clap"), ("stand", "wave")]),
        ("raises both arms, then waves with the right hand", [("stand", "raise"), ("stand", "wave")]),
    ],
)
def test_what_only_begins_a_movement_is_not_done_twice(text: str, acted: list[tuple[str, str]]) -> None:
    plan = parse(f"a person {text}")
    assert [(step.lower, step.upper) for step in plan.steps] == acted
    assert all(clause.status == "done" for clause in plan.clauses)


@pytest.mark.parametrize(
    ("text", "direction", "turn_deg"),
    [
        ("turns around and walks away", "forwards", 0.0),
        ("turns around and walks away from the sensor", "away", 0.0),
        ("opens the door and walks in", "forwards", 0.0),
        ("walks, turns left and walks on", "forwards", 0.0),
        ("walks, ducks under a bar and carries on walking", "forwards", 0.0),
        ("walks, stops, waves and walks on", "forwards", 0.0),
        ("walks, turns left and walks to the right", "right", 0.0),
        ("turns to the right, then turns back", "left", 0.0),
        ("turns a little to the right, then turns back to face the front", None, 45.0),
    ],
)
def test_the_way_follows_from_how_the_body_faces(text: str, direction: str | None, turn_deg: float) -> None:
    last = parse(f"a person {text}").steps[-1]
    assert (last.direction, last.turn_deg) == (direction, turn_deg)


@pytest.mark.parametrize(
    ("text", "lowers", "status"),
    [
        ("squats down and remains in that position", ["crouch"], "done"),
        ("slips and nearly falls, but regains balance", ["stumble"], "approximated"),
        ("rotates the hips", ["hula_hoop"], "done"),
        ("stands up from a sitting position on the floor", ["get_up"], "approximated"),
        ("bends down to touch the toes", ["bend"], "approximated"),
    ],
)
def test_what_is_not_shown_as_it_was_said_is_not_done(text: str, lowers: list[str], status: str) -> None:
    plan = parse(f"a person {text}")
    assert [step.lower for step in plan.steps] == lowers
    assert plan.clauses[0].status == status


def test_a_punch_with_each_fist_is_one_each() -> None:
    plan = parse("a person throws a punch with the right fist and then one with the left")
    assert [(step.upper, step.hand, step.count) for step in plan.steps] == [("punch", "right", 1), ("punch", "left", 1)]


def test_both_hands_put_down_what_both_picked_up() -> None:
    plan = parse("a person lifts a box with both hands and sets it down")
    assert [(step.lower, step.hand) for step in plan.steps] == [("pick_up", "both"), ("put_down", "both")]


def test_who_trips_goes_on_ahead() -> None:
    assert [step.direction for step in parse("a person trips slightly while walking forward").steps] == ["forwards"] * 3
    assert parse("a person trips backwards").steps[0].direction == "backwards"


def test_a_last_participle_on_the_spot_is_said_to_follow() -> None:
    plan = parse("a person is boxing, bouncing lightly on the feet")
    assert "one after the other" in plan.clauses[-1].how


@pytest.mark.parametrize(
    ("text", "lower", "upper"),
    [
        ("dances and claps to the rhythm", "dance", "clap"),
        ("plays air guitar and moves the hips", "dance", "guitar"),
        ("marches in place and waves", "march", "wave"),
        ("leans over and wipes the table", "bend", "wipe"),
        ("squats and raises both arms", "squat", "raise"),
    ],
)
def test_what_and_adds_to_a_movement_that_goes_on_happens_meanwhile(text: str, lower: str, upper: str) -> None:
    (step,) = parse(f"a person {text}", in_part=True).steps
    assert (step.lower, step.upper) == (lower, upper)


@pytest.mark.parametrize("text", ["bends down, then waves", "bows and waves", "walks forward and waves"])
def test_what_follows_stays_a_step_of_its_own(text: str) -> None:
    assert len(parse(f"a person {text}").steps) == 2


def test_who_works_bent_stays_bent() -> None:
    plan = plan_motion("a person leans over and wipes the table")
    assert plan.steps[0].style == "held"


@pytest.mark.parametrize("text", ["walks to the left, stops and waves", "walks to the left, pauses and waves"])
def test_a_pause_is_over_before_what_comes_next(text: str) -> None:
    steps = [(step.lower, step.upper) for step in parse(f"a person {text}").steps]
    assert steps == [("walk", ""), ("stand", ""), ("stand", "wave")]


def test_who_stands_and_waves_does_both_at_once() -> None:
    assert [(step.lower, step.upper) for step in parse("a person stands and waves").steps] == [("stand", "wave")]
