"""Rewordings of what means one thing only together, and what becomes of them."""

import pytest

from mmweaver.motion.language.reworded_phrases import reworded
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.verbs import words_in


@pytest.mark.parametrize(
    ("text", "other"),
    [
        ("walks with a slight limp on the right leg", "limps with the right leg"),
        ("is walking forward with a limp", "is limping forward"),
        ("is speed walking ahead", "is walking quickly ahead"),
        ("rolls forward at pace", "rolls forward quickly"),
        ("runs, picking up in speed", "runs, picking up speed"),
        ("is still, then does a step", "stands still, then does a step"),
        ("does to side jumps", "does two side jumps"),
        ("makes a u turn on his left side and goes back", "turns around to the left and goes back"),
        ("limping with left leg and going around in a circle", "limping with left leg in a circle"),
        ("limps and then walks in a circle", "limps and then walks in a circle"),
        (
            "starts walking with their left foot first and takes eleven steps",
            "takes eleven steps starting with the left foot",
        ),
        ("walks until they reach a table", "walks to a table"),
        ("turns left to turn around", "turns around to the left"),
        ("walks right across a street", "walks across a street"),
        ("turns right across from the door", "turns right across from the door"),
        ("makes two full turns to the right", "turns 720 degrees to the right"),
        ("types standing up", "types while standing"),
        ("is standing up", "is standing up"),
        ("plays the violin the goes back", "plays the violin then goes back"),
        ("kicks with the left and right leg", "kicks with the left leg, then kicks with the right leg"),
        ("spins and then steps one back", "spins and then takes one step back"),
        ("takes step then turns", "takes a step then turns"),
        ("makes a long stride sideways", "makes a long step sideways"),
        ("walks in an arch towards his left", "walks in an arc towards his left"),
        ("falls and steps back where he was", "falls and steps back to where he was"),
        ("walked forward and after return backwards", "walked forward and then return backwards"),
        ("sits and after, stands up", "sits and then stands up"),
        ("is weaving left and right", "is walks in a zigzag"),
        ("walks and after turn, he sits", "walks and after turn, he sits"),
        ("is spinning arms in a circle", "is spinning the arms in a circle"),
        ("stretches their arms and waves them", "stretches their arms and waves both arms"),
        ("throws his left hand in the air", "raises his left hand"),
        (
            "touches the head one hand after another",
            "touches the head with the left hand, then touches the head with the right hand",
        ),
        ("raises one leg after the other", "raises the left leg, then raises the right leg"),
        ("does circles with his hands in front of his body", "does circles with his hands in front of his body"),
        ("walks with arms held out in front of him", "walks with arms held forward"),
        ("turns head left then right", "turns the head left then right"),
        ("does two kicks, one with each leg", "does one kick with the left leg, then one kick with the right leg"),
        ("leans quickly backward", "leans backward quickly"),
        ("throws a couple balls", "throws two balls"),
        ("picks up a couple of boxes", "picks up two boxes"),
        ("waves to a couple of friends", "waves to a couple of friends"),
        ("a couple dances", "a couple dances"),
        ("waits while a couple dances", "waits while a couple dances"),
        ("uses their right hand and arm to throw", "uses their right arm to throw"),
        ("throws right arm and hand in the air", "throws right arm and hand in the air"),
        ("hops from point to point", "hops from place to place"),
        ("lifts each knee twice", "lifts the left knee twice, then lifts the right knee twice"),
    ],
)
def test_rewordings(text: str, other: str) -> None:
    assert " ".join(reworded(f"a person {text}").split()) == f"a person {other}"


@pytest.mark.parametrize(
    ("text", "foot"),
    [
        ("kneels down on one knee", ""), ("drops to one knee and stays", ""), ("goes down on the left knee", "left"),
        ("is kneeling on one knee", ""), ("lowers himself onto his right knee", "right"),
    ],
)  # fmt: skip
def test_one_knee_is_one_knee_in_any_words(text: str, foot: str) -> None:
    step = parse(f"a person {text}", in_part=True).steps[0]
    assert step.lower in ("kneel", "kneel_down")
    assert (step.style, step.foot) == ("knee", foot)


@pytest.mark.parametrize(
    ("text", "lowers"),
    [
        ("walks with a limp", "limp"),
        ("walks, limping with the left leg", "limp"),
        ("has a limp and walks to the door", "limp"),
        ("leans forward and touches the toes", "bend"),
        ("bends at the waist and touches his toes", "bend"),
        ("bends forward as if to bow", "bend"),
        ("is walking and seems to be drunk", "stagger"),
        ("jumps and turns 180 degrees in the air", "jump turn"),
        ("jumps, spinning 180 degrees", "jump turn"),
        ("stays in a squat for five seconds", "crouch"),
        ("gets up from a crouching position", "crouch stand"),
        ("does a motion of throwing a skipping rock", "stand"),
        ("walks forward; right, left, right, left, moving three paces", "walk"),
        ("types standing up", "stand"),
        ("plays the piano standing up", "stand"),
    ],
)
def test_each_movement_comes_once(text: str, lowers: str) -> None:
    steps = parse(f"a person {text}", in_part=True).steps
    assert [step.lower for step in steps if step.clause or step.lower != "stand"] == lowers.split()


@pytest.mark.parametrize(
    ("text", "how"),
    [
        ("jumps and spins in mid air", "after the jump"),
        ("jumps, spinning 180 degrees", "after the jump"),
        ("jogs and then speeds up", "a change of speed"),
        ("walks faster and faster", "a change of speed"),
        ("lunges with both legs", "'both'"),
        ("ducks and side steps to the left", "upright"),
    ],
)
def test_what_is_shown_otherwise_is_said(text: str, how: str) -> None:
    assert how in "; ".join(clause.how for clause in parse(f"a person {text}", in_part=True).clauses)


def test_counts_and_ways() -> None:
    jumps, turn, bend = (
        parse(f"a person {text}").steps[0]
        for text in (
            "jumps forward repeatedly",
            "turns a full circle and a half",
            "walks forward, slightly to the left",
        )
    )
    assert (jumps.count, abs(turn.turn_deg), bend.arc_deg > 0) == (3, 540.0, True)
    assert parse("a person walks straight back").steps[0].direction in words_in("back backwards")


@pytest.mark.parametrize("text", ["walks in an s curve", "walks in the shape of an s", "walks in an s shaped pattern"])
def test_an_s_bends_to_both_sides(text: str) -> None:
    plan = parse(f"a person {text}")
    assert [step.arc_deg > 0 for step in plan.steps] == [True, False]
    assert all(record.status == "done" for record in plan.clauses), plan.notes


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("is walking and turning to the left", [("walk", 60.0)]),
        ("walks on all four", [("crawl", 0.0)]),
        ("gets down on his knees and hands and walks around", [("kneel_down", 0.0), ("crawl", 0.0)]),
        ("appears to be jumping", [("jump", 0.0)]),
        ("walks side ways", [("sidestep", 0.0)]),
        ("spins around and walks back", [("turn", 0.0), ("walk", 0.0)]),
    ],
)
def test_movements_in_other_words(text: str, steps: list[tuple[str, float]]) -> None:
    plan = parse(f"a person {text}")
    assert [(step.lower, step.arc_deg) for step in plan.steps] == steps
    assert [step.turn_deg for step in plan.steps] == [0.0] * len(steps)
    assert all(record.status == "done" for record in plan.clauses), plan.notes


def test_a_reach_into_the_air_is_high() -> None:
    assert parse("a person reaches with the right hand into the air").steps[0].style == "high"


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("squats and returns to the starting position", [("squat", ""), ("stand", "")]),
        ("turns left, then returns to the original position", [("turn", "left"), ("turn", "right")]),
        ("walks forward and returns to the starting position", [("walk", "forwards"), ("walk", "back")]),
    ],
)
def test_who_has_left_no_place_does_not_walk_back(text: str, steps: list[tuple[str, str]]) -> None:
    assert [(step.lower, step.direction) for step in parse(f"a person {text}", in_part=True).steps] == steps


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        ("raises one arm, then the other", "left right"),
        ("kicks with one leg and then with the other", "left right"),
        ("waves with the right hand, then the left, then both", "right left both"),
        ("kicks alternately with the left and the right leg", "left right"),
    ],
)
def test_one_and_then_the_other(text: str, sides: str) -> None:
    steps = parse(f"a person {text}", in_part=True).steps
    assert " ".join(step.hand or step.foot for step in steps if step.hand or step.foot) == sides


def test_a_run_that_is_shown_as_two_curves_is_run_to_the_end() -> None:
    for way in ("in a zigzag", "in a figure eight"):
        assert {step.lower for step in parse(f"a person runs {way}", in_part=True).steps} == {"jog"}


def test_what_is_put_on_the_floor_goes_there() -> None:
    text = "a person takes something off a shelf with the right hand and puts it on the floor"
    assert [step.lower for step in parse(text).steps][-1] == "put_down"


def test_another_speed_or_way_round_is_another_step() -> None:
    assert [step.speed for step in parse("a person waves slowly, then quickly").steps] == [-1, 1]
    circles = parse("a person walks in a circle to the left and then in a circle to the right").steps
    assert [step.arc_deg for step in circles] == [360.0, -360.0]
    assert [step.facing for step in parse("a person faces left, then right").steps] == ["left", "right"]


def test_a_speed_that_no_step_has_is_said() -> None:
    plan = parse("a person squats slowly and stands up fast")
    assert plan.clauses[-1].how == "is shown as squatting slowly once or more; 'fast' is not shown"


def test_arms_held_out_are_shown_on_one_leg_and_in_a_walk() -> None:
    for text in ("balances on one foot with the arms out", "walks forward with his arms out for balance"):
        assert parse(f"a person {text}", in_part=True).steps[-1].upper == "arms_out"


def test_what_is_stepped_on_and_off_is_said() -> None:
    clauses = parse("a person steps up onto a box and jumps off", in_part=True).clauses
    assert ["stepped on" in clauses[0].how, "jumped off" in clauses[1].how] == [True, True]


def test_other_verbs_are_no_misspellings_of_movements() -> None:
    assert [step.name for step in parse("this person waves off as if joking", in_part=True).steps] == ["waving"]


def test_a_turn_of_who_crawls_is_said_to_be_shown_standing() -> None:
    clauses = parse("someone crawls forward and turns around").clauses
    assert "standing, after getting up" in clauses[-1].how


def test_a_way_back_does_not_use_up_the_side_after_it() -> None:
    steps = parse("a person steps to the left, back to the center, and then to the right").steps
    assert [step.direction for step in steps] == ["left", "right", "right"]


def test_right_after_is_a_side_of_a_turn() -> None:
    plan = parse("a person walks three steps forward and turns right after each step")
    assert [(step.lower, step.direction) for step in plan.steps] == [("walk", "forwards"), ("turn", "right")]
    assert "each" in plan.clauses[-1].how


@pytest.mark.parametrize("text", ["is spinning arms in a circular pattern", "twirls his arms"])
def test_limbs_that_turn_do_not_turn_the_body(text: str) -> None:
    assert [step.upper for step in parse(f"a person {text}", in_part=True).steps] == ["arm_circles"]


@pytest.mark.parametrize("text", ["walks in all directions", "is walking a tight rope", "walks as if on a tight rope"])
def test_ways_that_are_not_walked_are_named(text: str) -> None:
    (clause,) = parse(f"a person {text}", in_part=True).clauses
    assert clause.status == "approximated"
    assert clause.how


def test_the_way_back_to_a_place_ends_with_its_clause() -> None:
    plan = parse("a person spins and comes back to the original position and then takes a step back")
    assert [(step.lower, step.count) for step in plan.steps] == [("turn", 0), ("stand", 0), ("walk", 1)]


def test_who_has_not_gone_does_not_walk_back() -> None:
    assert parse("a person falls to the left and then steps back where he was").clauses[1].status == "approximated"


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("a person slowly walks along a line and holds their arms out", [("walk", "arms_out")]),
        ("a person walks forward and keeps his hands on his hips", [("walk", "hips")]),
        ("a man walks forward and has his arms crossed", [("walk", "cross_arms")]),
        ("a person walks and holds his arms up", [("walk", "raise_hold")]),
        ("a person walks with their arms raised above their head", [("walk", "raise_hold")]),
        ("a person walks with his arms raised to the sides", [("walk", "arms_out")]),
        ("a person walks to the door and holds the arms out", [("walk", ""), ("stand", "arms_out")]),
        ("a person walks five steps and holds the arms out", [("walk", ""), ("stand", "arms_out")]),
        ("a person from a t pose walking and sitting", [("stand", "arms_out"), ("walk", ""), ("sit_down", "")]),
        ("a person starts in a t-pose and walks forward", [("stand", "arms_out"), ("walk", "")]),
        ("a person is standing in a t-pose, then walks", [("stand", "arms_out"), ("walk", "")]),
        ("a person walks in a t-pose", [("walk", "arms_out")]),
        ("a person bounces a ball and runs forward", [("jog", "knock")]),
        ("a person bounces a ball and then walks", [("stand", "knock"), ("walk", "")]),
    ],
)  # fmt: skip
def test_arms_are_held_during_a_walk_and_leave_a_t_pose_before_it(text: str, steps: list[tuple[str, str]]) -> None:
    assert [(step.lower, step.upper) for step in parse(text, in_part=True).steps] == steps


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("gets on their hands and knees, crawls, then stands up", ["kneel_down", "crawl", "kneel_up"]),
        ("gets down on all fours and crawls forward", ["kneel_down", "crawl"]),
        ("gets on the floor and crawls", ["kneel_down", "crawl"]),
        ("falls on the floor and walks away", ["fall", "get_up", "walk"]),
        ("is leaning to the left, turns and twists at waist", ["lean", "twist"]),
        ("rotates at the waist", ["twist"]),
        ("climbs a step while walking", ["stairs", "walk"]),
    ],
)
def test_what_is_gone_through_first_and_what_is_turned(text: str, steps: list[str]) -> None:
    assert [step.lower for step in parse(f"a person {text}", in_part=True).steps] == steps


@pytest.mark.parametrize(
    ("text", "sides"),
    [
        ("lifts both legs in turn", [("left", 0), ("right", 0)]),
        ("lifts the legs in turn", [("left", 0), ("right", 0)]),
        ("raises both arms in turn", [("left", 0), ("right", 0)]),
        ("stamps their feet", [("left", 0), ("right", 0)]),
        ("lifts the left arm and the right arm two times each", [("left", 2), ("right", 2)]),
        ("raises the left and right leg twice each", [("left", 2), ("right", 2)]),
        ("kicks with the left leg and the right leg three times each", [("left", 3), ("right", 3)]),
    ],
)
def test_each_limb_has_its_turn_and_its_count(text: str, sides: list[tuple[str, int]]) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert [(step.hand or step.foot, step.count) for step in plan.steps] == sides
    assert len({(step.lower, step.upper) for step in plan.steps}) == 1
    assert all(clause.status == "done" for clause in plan.clauses)


@pytest.mark.parametrize(
    "text",
    [
        "turns to face forward",
        "walks to the left and faces forward",
        "turns to the left and then faces forward again",
        "walks away, then turns around to face the front",
    ],
)
def test_who_faces_forward_turns_to_the_radar(text: str) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert (plan.steps[-1].lower, plan.steps[-1].facing) == ("turn", "towards")
    assert all(clause.status == "done" for clause in plan.clauses)


def test_who_sits_and_faces_forward_does_not_get_up_for_it() -> None:
    assert [step.lower for step in parse("sits down and faces forward", in_part=True).steps] == ["sit_down"]
