"""Sentences become the right steps, or the error says why not."""

import pytest

from mmweaver.core.errors import InputError
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


UNDERSTOOD = {
    # the twelve
    "a person walks": "walking",
    "jogging": "jogging",
    "the man is waving": "waving",
    "clapping": "clapping",
    "she does jumping jacks": "jumping jacks",
    "someone jumps up and down": "jumping",
    "left-hand raise": "left-hand raise",
    "he raises his right arm": "right-hand raise",
    "sitting": "sitting",
    "user seated on couch drinking water": "sitting and drinking",
    "squats": "squatting",
    "the user is punching": "punching",
    # synonyms and inflections
    "a woman strolled across the room": "walking slow",
    "paces back and forth": "walking pacing",
    "the kid hops": "hopping",
    "everybody's friend applauds": "clapping",
    "he boxes": "punching",
    "shadow boxing": "punching",
    "runs to the right": "jogging right",
    "does a few squats": "squatting x3",
    "star jumps": "jumping jacks",
    "takes a seat": "sitting down",
    "gets up from the chair": "standing up",
    "puts both hands up": "raising both hands",
    "holds his left hand up": "left-hand raise",
    "greets the camera with his right hand": "waving right-hand",
    "sips coffee from a cup": "drinking",
    "throws punches": "punching",
    "a man in a red shirt walks": "walking",
    "stands still": "standing",
    "stands without moving": "standing",
    # directions, speeds, numbers, hands
    "walks to the left": "walking left",
    "walks from left to right": "walking right",
    "walks towards the radar": "walking towards",
    "walks toward me slowly": "walking towards slow",
    "approaches the sensor": "walking towards",
    "moves away from the camera quickly": "walking away fast",
    "goes to the right": "walking right",
    "walks backwards": "walking backwards",
    "takes three steps forward": "walking forwards x3",
    "walks to his left": "walking right",
    "walks in a circle": "walking circle",
    "jogs in place": "jogging spot",
    "waves with the left hand": "waving left-hand",
    "waves his left and right hands": "waving both-hands",
    "waves twice": "waving x2",
    "claps three times": "clapping x3",
    "does 10 jumping jacks": "jumping jacks x10",
    "punches with the right fist": "punching right-hand",
    "turns left": "turning left",
    "turns around": "turning around",
    "turns to face the radar": "turning facing-towards",
    "stands facing the camera and waves": "waving facing-towards",
    "sits for 3 seconds": "sitting 3s",
    # in time
    "walks to the left, then sits down": "walking left | sitting down",
    "walks towards the radar, then waves with the left hand": "walking towards | waving left-hand",
    "waves and then claps": "waving | clapping",
    "walks. After that he jumps.": "walking | jumping",
    "walks, waves, claps, and jumps": "walking | waving | clapping | jumping",
    "before sitting down, she waves": "waving | sitting down",
    "waves before jumping": "waving | jumping",
    "after walking to the left, he claps": "walking left | clapping",
    "waves after clapping": "clapping | waving",
    "a squat followed by a jump": "squatting x1 | jumping x1",
    "walks to the sofa to sit down": "walking seat | sitting down",
    "starts to walk and then stops": "walking | standing",
    "stops walking": "standing",
    "takes a step to the left": "sidestepping left x1",
    "a man lifts his hands": "raising both hands",
    "turns 90 degrees to the right": "turning right",
    "raises the left arm, then waves": "standing 0.5s | waving left-hand",
    "walks left, then walks back": "walking left | walking back",
    # at once
    "drinks while sitting": "sitting and drinking",
    "sits on the sofa and drinks": "sitting and drinking",
    "sits on the sofa, drinking tea": "sitting and drinking",
    "walks while waving": "walking and waving",
    "as she walks, she waves": "walking and waving",
    "walking and waving": "walking and waving",
    "walks with his left hand raised": "walking and lifting an arm and keeping it up left-hand",
    "is waving with both hands while standing": "waving both-hands",
    # postures last
    "sits down and drinks, then stands up": "sitting down | sitting and drinking | standing up",
    "sits, then walks away": "sitting | standing up | walking away",
    "walks and then sits and waves": "walking | sitting down | sitting and waving",
    "squats and stands up again": "squatting",
    "raises the left hand, then lowers it": "left-hand raise",
}  # fmt: skip

# upper | lower | direction | hand | foot | arc | turn | style | target of every step, what is not said left out
MORE = {
    "a person is pushed from behind": "stumble forwards",
    "gets shoved to the left and recovers": "stumble left",
    "walks forward, is pushed from the right and walks on": "walk forwards | stumble left | walk forwards",
    "gets pushed while walking": "walk | stumble | walk",
    "walks a quarter circle to the left": "walk 90",
    "walks in a half circle": "walk 180",
    "turns 180 degrees to the left": "turn t180",
    "turns around clockwise": "turn t-180",
    "picks something up from the floor with the left hand": "pick_up left",
    "walks two steps forwards, then one to the right": "walk forwards | sidestep right",
    "is pushed and stumbles backwards": "stumble backwards",
    "walks in a 90 degree right curve": "walk -90",
    "walks 90 degrees to the right": "walk -90",
    "walks in a circle to the left": "walk circle 360",
    "walks forward while turning right": "walk -90",
    "walks 3/4 of a circle to the right": "walk -270",
    "turns 270 degrees to the left": "turn t270",
    "walks forward and backward": "walk forwards | walk backwards",
    "walks sideways": "sidestep",
    "jumps to the left": "leap left",
    "hops on his left leg": "hop_one_leg Lleft",
    "stands on one leg": "one_leg",
    "raises his right leg": "raise_leg Lright",
    "lifts the right foot and puts it down again": "raise_leg Lright",
    "kicks a ball with the left foot": "kick Lleft",
    "dances": "dance",
    "takes a deep bow": "bow",
    "bends over": "bend",
    "picks something up from the floor": "pick_up",
    "picks the book up off the floor": "pick_up",
    "gets something up off the floor": "pick_up",
    "gets up off the ground using both hands": "get_up back",
    "puts a box down on the floor": "put_down",
    "drinks, then puts it down on the table": "drink | reach",
    "goes down on her knees, then stands up": "kneel_down | kneel_up",
    "a kneeling person waves": "kneel | kneel+wave",
    "lies down and then gets up": "lie_down back | get_up back",
    "falls forward": "fall front",
    "walks and falls, then waves": "walk | fall back | lie+wave back",
    "a person lying on his belly gets up": "lie front | get_up front",
    "sits at the desk and types": "sit+type",
    "sits down and eats": "sit_down | sit+eat",
    "reads a book on the sofa": "sit+read",
    "a drunk person walks": "stagger",
    "brushes his teeth": "brush_teeth",
    "talks on the phone while walking": "walk+phone",
    "cleans the window with his left hand": "wipe left",
    "plays air guitar": "guitar",
    "throws punches": "punch",
    "throws a ball": "throw",
    "walks carrying a box": "walk+carry",
    "opens the door": "open_door",
    "walks to the door": "walk >door",
    "goes over to the kitchen table and picks up a cup": "walk >table | reach",
    "user seated on couch drinking water": "sit+drink",
    "sits on the couch and drinks": "sit+drink",
    "nods": "nod",
    "crosses her arms": "cross_arms",
    "walsk forwads": "walk forwards",
    "wolks forwads": "refused",
    "walks forwads": "walk forwards",
}  # fmt: skip


def short(plan: MotionPlan) -> str:
    parts = []
    for step in plan.steps:
        doing = step.upper if step.lower == "stand" and step.upper else "+".join(filter(None, (step.lower, step.upper)))
        words = [doing, step.direction, step.hand, f"L{step.foot}" if step.foot else ""]
        words += [f"{step.arc_deg:g}" if step.arc_deg else "", f"t{step.turn_deg:g}" if step.turn_deg else ""]
        words += [step.style, f">{step.target}" if step.target else ""]
        parts.append(" ".join(word for word in words if word))
    return " | ".join(parts)


@pytest.mark.parametrize("text", MORE)
def test_activities_of_home_life(text: str):
    if MORE[text] == "refused":
        with pytest.raises(InputError):
            parse(text)
    else:
        assert short(parse(text)) == MORE[text]


def test_every_example_of_the_table_is_read_as_its_activity():
    for activity in (*BODY, *HANDS):
        steps = parse(activity.example).steps
        assert activity.key in {step.lower for step in steps} | {step.upper for step in steps}, activity.example


REFUSED = {
    "": "empty",
    "   ": "empty",
    "walks " * 200: "characters",
    "a person": "no activity",
    "asdf qwer": "asdf",
    "flies": "flies",
    "walks and then flies": "'flies'",
    "walks and teleports": "'teleports'",
    "falls on the bed": "off a seat",
    "does not walk": "not",
    "doesn't wave": "not",
    "never sits": "never",
    "walks without waving": "without",
    "walks instead of jogging": "instead",
    "two people walk": "several people",
    "the men are clapping": "several people",
    "a dog walks": "alone",
    "jumps over the chair": "over",
    "waves with a cartwheel": "cartwheel",
    "does a handstand on the floor": "handstand",
    "raises an eyebrow": "hand, an arm or a leg",
    "sits while walking": "same time",
    "claps 1000 times": "times",
    "moves objects around": "move",
}


@pytest.mark.parametrize("text", UNDERSTOOD)
def test_understood(text: str):
    assert said(parse(text)) == UNDERSTOOD[text]


@pytest.mark.parametrize("text", REFUSED, ids=lambda text: text[:30])
def test_refused_with_the_reason(text: str):
    with pytest.raises(InputError, match=REFUSED[text]) as error:
        parse(text)
    assert "\n" not in str(error.value)


def test_an_unknown_activity_says_what_comes_nearest_and_where_all_are_listed():
    with pytest.raises(InputError, match=r"known are standing, walking and .*'mmweaver motions'"):
        parse("the person teleports")
    with pytest.raises(InputError, match="did you mean 'a person dances'"):
        parse("a person grooves along")


def test_what_is_left_aside_is_told():
    assert any("'zealously'" in note for note in parse("walks zealously").notes)
    assert any("distance" in note for note in parse("jumps 2 meters forward").notes)
    assert parse("walks 2 meters").steps[0].distance_m == 2.0
    assert any("right in the photo" in note for note in parse("walks to her left").notes)
    assert parse("a person walks to the left, then sits down").notes == ()


def test_case_punctuation_and_fillers_change_nothing():
    assert said(parse("The MAN, walks!  To the LEFT...")) != ""
    assert said(parse("Please: a person WAVES.")) == "waving"


def test_each_part_of_a_walk_has_its_own_speed_and_time() -> None:
    first, second = parse("a person walks backwards slowly for four seconds then quickly forwards").steps
    assert (first.speed, first.seconds, second.speed, second.seconds) == (-1, 4.0, 1, 0.0)
    first, second = parse("walks three metres towards the radar, then two metres back").steps
    assert (first.distance_m, second.distance_m, second.direction) == (3.0, 2.0, "back")
    first, second = parse("a person walks to the left for 3 s and to the right for 5 s").steps
    assert [(step.direction, step.seconds) for step in (first, second)] == [("left", 3.0), ("right", 5.0)]


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("waves for a minute", 60.0), ("waves for two minutes", 120.0), ("half a minute of walking", 30.0)],
)
def test_minutes_are_kept(text: str, seconds: float) -> None:
    assert [step.seconds for step in parse(text).steps] == [seconds]


@pytest.mark.parametrize(
    ("text", "feet"),
    [("a person does three lunges with each leg", ["left", "right"]), ("both front lunges", ["left", "right"])],
)
def test_each_leg_has_its_turn(text: str, feet: list[str]) -> None:
    assert [step.foot for step in parse(text).steps] == feet


def test_who_does_not_move_keeps_the_posture() -> None:
    assert [step.lower for step in parse("a person does not move").steps] == ["stand"]
    assert [step.lower for step in parse("a person sits on the sofa and does not move").steps][-1] == "sit"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("picks up a heavy box", [("pick_up", "")]),
        ("walks up three steps and down again", [("stairs", "")]),
        ("falls sideways off the chair", [("sit", ""), ("fall_off", "")]),
        ("is snoring on the couch", [("lie_on_seat", "")]),
        ("meditates on the sofa for five seconds", [("sit", "")]),
        ("sneezes twice", [("stand", "cough")]),
        ("carries a sleeping child to the bed", [("walk", "carry")]),
        ("falls asleep in the armchair", [("sit", "")]),
        ("lifts a chair and puts it next to the table", [("pick_up", ""), ("stand", "reach")]),
        ("pulls a suitcase towards the door", [("walk", "carry")]),
        ("stands on the table", [("stand", "")]),
        ("does the cobra pose", [("lie", "")]),
    ],
)
def test_everyday_clauses_and_what_they_are_shown_as(text: str, shown: list[tuple[str, str]]) -> None:
    plan = parse(f"a person {text}", in_part=True)
    assert [(step.lower, step.upper) for step in plan.steps] == shown
    assert plan.clauses[0].status == "approximated"


def test_exercises_on_the_belly_are_reached_and_left_on_the_belly():
    steps = parse(
        "a person waves, does push-ups, rests for ten seconds, does five more push-ups, then walks away"
    ).steps
    assert [step.lower for step in steps] == [
        "stand", "lie_down", "push_ups", "lie", "push_ups", "get_up", "walk",
    ]  # fmt: skip
    assert {step.style for step in steps[1:6]} == {"front"}
    assert [step.lower for step in parse("a person waves, then crawls to the left").steps] == [
        "stand", "kneel_down", "crawl",
    ]  # fmt: skip


def test_somebody_who_is_spoken_to_does_it():
    assert parse("shake your head").steps[0].upper == "shake_head"
    assert parse("raise your left hand").steps[0].hand == "left"


def test_the_other_hand_has_its_own_count() -> None:
    steps = parse("a person punches twice with the right fist and once with the left").steps
    assert [(step.upper, step.hand, step.count) for step in steps] == [("punch", "right", 2), ("punch", "left", 1)]


@pytest.mark.parametrize(
    ("text", "gait"),
    [
        ("walks, stops, then carries on walking", "walk"),
        ("walks, leans to the left and then carries on straight", "walk"),
        ("jogs, turns left and continues straight", "jog"),
        ("claps and then marches off", "walk"),
    ],
)
def test_who_carries_on_carries_nothing(text: str, gait: str) -> None:
    last = parse(f"a person {text}").steps[-1]
    assert (last.lower, last.upper) == (gait, "")


def test_how_a_bow_ends_is_no_step() -> None:
    assert len(parse("a person bows, then straightens up").steps) == 1


def test_an_arm_that_is_held_out_comes_down() -> None:
    held = parse("a person raises their left arm to shoulder height, holds it, and lets it drop")
    assert [(step.lower, step.upper) for step in held.steps] == [("stand", "arms_out"), ("stand", "")]


@pytest.mark.parametrize(
    ("sentence", "shown"),
    [
        ("a person is bowing down as if greeting someone", [("bow", "")]),
        ("a man raises both his arms to do a t-pose", [("stand", "arms_out")]),
        ("a person greets someone and bows", [("stand", "wave"), ("bow", "")]),
    ],
)
def test_a_greeting_bow_is_a_bow_and_a_t_pose_one_movement(sentence: str, shown: list[tuple[str, str]]) -> None:
    assert [(step.lower, step.upper) for step in parse(sentence).steps] == shown


@pytest.mark.parametrize(
    "text",
    ["walks forward with the left arm raised", "stands with the left hand raised", "walks with his left arm lifted"],
)
def test_an_arm_that_is_raised_meanwhile_stays_up(text: str) -> None:
    (step,) = parse(f"a person {text}").steps
    assert (step.upper, step.hand) == ("raise_hold", "left")


def test_who_faces_backwards_turns_around() -> None:
    step = parse("a person spins, then lands facing backwards").steps[-1]
    assert (step.lower, step.direction, step.facing) == ("turn", None, "")


@pytest.mark.parametrize("text", ["skips", "skips in a circle", "is skipping and clapping"])
def test_skipping_is_not_recorded_as_done(text: str) -> None:
    plan = parse(f"a person {text}")
    assert plan.steps[0].lower == "hop"
    assert plan.clauses[0].status == "approximated"


def test_a_leg_that_kicks_high_kicks_high() -> None:
    (step,) = parse("a person kicks high with the left leg twice").steps
    assert (step.lower, step.style, step.foot, step.count) == ("kick", "high", "left", 2)
