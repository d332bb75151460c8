"""Other words and similar movements: what is said of them, and that known sentences stay as they are."""

import re

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.approximations import APPROXIMATIONS, apply_approximations
from mmweaver.motion.language.plan import DONE, ClauseRecord
from mmweaver.motion.language.sentence import parse


def test_every_replacement_is_understood():
    for one in APPROXIMATIONS:
        instead = re.sub(r"\\\d", "", one.instead).strip()
        if (
            instead
            and re.match(r"[a-z]+s\b", instead)
            and not instead.startswith(("in ", "limping"))
            and one.instead == instead
        ):
            assert parse(f"a person {instead}").steps, one.instead


def test_known_sentences_are_left_alone_and_unknown_ones_refused():
    text = "A person walks to the left, then waves."
    assert apply_approximations(text, only_always=True) == text
    for unknown in ("a person does a handstand", "a person teleports", "a person does a cartwheel"):
        with pytest.raises(InputError, match=r"no activity|cannot"):
            parse(unknown)


def test_only_how_something_is_done_is_left_out():
    record = parse("a person walks like a stork").clauses[0]
    assert record.status == "approximated"
    assert "resembles" in record.how or "'like a stork' is not shown" in record.how
    for main in ("walks and does a handstand", "jumps over the chair", "two people walk", "waves without walking"):
        with pytest.raises(InputError):
            parse(main)


def test_what_no_step_shows_is_said_of_its_clause():
    records = parse("a person walks to the door, then dances to the left").clauses
    assert [record.how for record in records] == ["", "is shown as dancing; the side is not shown"]
    raised = parse("a person walks to the left with the right hand raised").clauses[0]
    assert raised == ClauseRecord(raised.clause, DONE, f"is shown as {raised.shown}", raised.shown)


@pytest.mark.parametrize(
    ("text", "acted", "said"),
    [
        ("a person rolls over in bed", ["roll_in_bed"], "onto a side and back"),
        ("a person lies on the floor, then rolls over", ["lie", "roll_over"], "onto a side and back"),
        ("a person is breathing quietly in a chair", ["sit"], "keeping still"),
        ("he stretches and walks out of the room", ["stretch", "walk"], "leaves the room is not shown"),
        ("she tilts her head", ["look_around"], "tilted head"),
        ("a person walks about, rubbing the hands together", ["walk+clap"], "shown as walking while clapping"),
        ("someone jumps rope", ["jump"], "the arms that turn it"),
        ("a person stirs soup in a bowl held in the left arm", ["stir"], "what the other hand holds"),
        ("a person flails the arms to keep from falling over", ["wave"], "is shown as waving"),
        ("a person wipes a table in a circular motion with the right hand", ["wipe"], "circles are not shown"),
        ("she walks, gradually speeds up into a jog", ["walk", "jog"], "gradual change"),
        ("he walks up some steps, turns around and comes back down", ["stairs", "turn", "stairs"], "coming down"),
        ("a person steps up onto a box and steps down again", ["stairs"], "up and down on the spot"),
        ("yoga for twenty seconds", ["tree_pose", "warrior_pose"], "two of its poses"),
    ],
)
def test_what_is_shown_as_something_alike_is_said(text: str, acted: list[str], said: str):
    plan = parse(text, in_part=True)
    does = ["+".join(part for part in (step.lower, step.upper) if part and part != "stand") for step in plan.steps]
    assert does == acted
    assert said in " ".join(clause.how for clause in plan.clauses)


def test_what_is_begun_and_given_up_is_said_to_be_done_wholly():
    plan = parse("starts to sit down but stands up")
    assert [clause.status for clause in plan.clauses] == ["approximated", "done"]
    assert "only begun" in plan.clauses[0].how
    assert parse("starts to sit down").clauses[0].status == "done"


def test_who_goes_around_something_to_sit_does_not_walk_to_and_fro():
    plan = parse("a person went around to sit on the chair")
    assert [(step.lower, step.direction) for step in plan.steps] == [("walk", None), ("sit_down", None)]
    assert "around what the person walks is not shown" in plan.clauses[0].how
