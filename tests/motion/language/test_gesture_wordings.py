"""Exercises and gestures are understood as their instructions word them."""

import pytest

from mmweaver.motion.language.sentence import parse

INSTRUCTIONS = {
    "the right arm hangs straight, is lifted straight up and stays above the head": "raise_hold",
    "the right arm is straight up, falls straight down and stays down": "lower_arm",
    "a person holds the right hand before the chest, palm forward, and stretches it forward": "push_hand",
    "both arms hang, both are lifted straight up and stay above the head": "raise_hold",
    "a person draws one large clockwise circle before the body with the straight right arm": "draw_circle",
    "a person covers the mouth with the right hand and yawns": "yawn",
    "a person lifts the right arm straight up and keeps it above the head": "raise_hold",
    "a person lets the right arm fall straight down": "lower_arm",
    "the right arm falls straight down and stays down": "lower_arm",
    "a person pushes the right palm forward from the chest": "push_hand",
    "the right hand returns to the chest": "pull_hand",
    "the straight right arm draws a large Z before the body": "draw_z",
    "a person claps three times before the chest": "clap",
    "a person raises the right hand from the elbow and lowers it twice": "knock_elbow",
    "a person yawns": "yawn",
    "a person covers the mouth with the right hand": "yawn",
    "a person lifts both arms straight up and keeps them above the head": "raise_hold",
    "a person extends the left arm up at the side": "arm_extension",
    "left upper limb extension": "arm_extension",
    "she takes off her jacket": "jacket_off",
    "he mops the floor": "sweep",
    "a man vacuums the carpet": "vacuum",
    "a person coughs": "cough",
    "she takes deep breaths": "breathe",
    "he is shivering": "tremble",
    "a man shakes with fear": "tremble",
    "a mother rocks her baby to sleep": "cradle",
    "she holds a crying baby in her arms": "cradle",
}
EXERCISES = {
    "a person does side lunges with the left leg": ("side_lunge", "left"),
    "a person lunges to the left side": ("side_lunge", "left"),
    "right side lunge": ("side_lunge", "right"),
    "a person does a front lunge with the right leg": ("lunge", "right"),
    "left limb extension": ("limb_extension", "left"),
    "a person extends the right arm and leg to the side": ("limb_extension", "right"),
    "someone does ten push-ups": ("push_ups", ""),
    "a man does ten sit-ups": ("sit_ups", ""),
    "a person pedals": ("pedal", ""),
    "a baby crawls on hands and knees": ("crawl", ""),
    "someone is crawling forward on hands and knees": ("crawl", ""),
    "a man squats down slowly and stays there": ("crouch", ""),
}


@pytest.mark.parametrize(("text", "upper"), INSTRUCTIONS.items())
def test_a_gesture_is_known_by_its_instruction(text: str, upper: str):
    (step,) = parse(text).steps
    assert step.upper == upper
    if "right" in text:
        assert step.hand == "right"
    if "both" in text:
        assert step.hand == "both"


@pytest.mark.parametrize(("text", "known"), EXERCISES.items())
def test_an_exercise_is_known_with_its_side(text: str, known: tuple[str, str]):
    (step,) = parse(text).steps
    assert (step.lower, step.foot) == known


def test_a_bat_is_swung_as_a_golf_club_whatever_it_hits():
    (step,) = parse("she hits a baseball with a bat").steps
    assert step.upper == "golf"


def test_counts_and_hands_held_up_belong_to_the_exercise():
    (step,) = parse("a person does squats with the hands up").steps
    assert (step.lower, step.upper) == ("squat", "hands_up")
    (step,) = parse("a person raises the right hand from the elbow and lowers it twice").steps
    assert step.count == 2


def test_raising_and_lowering_is_still_a_raised_hand():
    (step,) = parse("a person raises the left hand").steps
    assert (step.upper, step.hand) == ("raise", "left")


def test_a_limb_that_was_named_goes_on():
    steps = parse("a person stretches the right arm straight forward, then the hand returns to the chest").steps
    assert [(step.upper, step.hand) for step in steps] == [("arms_out", "right"), ("pull_hand", "right")]
    (step,) = parse("a person raises the right hand from the elbow and down, twice without pause").steps
    assert (step.upper, step.count) == ("knock_elbow", 2)


@pytest.mark.parametrize(
    ("text", "known"),
    [
        ("swipe left", ("swipe", "left", "", "", 0)),
        ("a person swipes the right hand from right to left twice", ("swipe", "left", "right", "", 2)),
        ("a person swipes down with the left hand", ("swipe", None, "left", "down", 0)),
        ("a man counts to five on his fingers", ("count_fingers", None, "", "", 5)),
    ],
)
def test_what_hands_say_to_a_device_is_known_with_its_side(text: str, known: tuple[object, ...]):
    plan = parse(text)
    (step,) = plan.steps
    assert (step.upper, step.direction, step.hand, step.style, step.count) == known
    assert [clause.status for clause in plan.clauses] == ["done"]


def test_what_is_done_towards_the_radar_faces_it():
    for text in ("push your hand towards the sensor", "a person throws a ball at the camera"):
        assert parse(text).steps[0].facing == "towards"
    assert parse("standing with the back to the sensor").steps[0].facing == "away"


def test_one_push_up_is_one():
    assert [parse(text).steps[0].count for text in ("do a push-up", "does push-ups", "does a sit-up")] == [1, 0, 1]
