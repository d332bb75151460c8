"""A participle that is shown after the movement that it goes with says so, whatever else its record says."""

import pytest

from mmweaver.motion.language.clause_parser import ParsedClause
from mmweaver.motion.language.plan import APPROXIMATED, Step
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.shown_in_turn import shown_in_turn

WALK, KICK = Step(lower="walk", clauses=(0,)), Step(lower="kick", clauses=(1,))


@pytest.mark.parametrize(
    "sentence",
    [
        "the man dances around waving his arms and kicking his legs",
        "a person is walking straight, using their left hand to grab something",
        "the person takes 4 steps swinging their leg out for each step",
        "a person walks forward dribbling a ball",
    ],
)
def test_what_is_shown_after_instead_of_during_is_said(sentence: str) -> None:
    records = [record for record in parse(sentence, in_part=True).clauses if "one after the other" in record.how]
    assert [record.status for record in records] == [APPROXIMATED]


@pytest.mark.parametrize(
    "sentence",
    [
        "a person is walking and kicking",
        "a person walks, then starts kicking",
        "a person walks forward waving the left hand",
        "a person is walking, waving, and then kicking",
    ],
)
def test_what_is_in_turn_or_at_once_as_it_says_needs_no_word(sentence: str) -> None:
    assert not any("one after the other" in record.how for record in parse(sentence, in_part=True).clauses)


@pytest.mark.parametrize(
    ("link", "before", "words", "is_said"),
    [
        ("comma", "a man walks", "kicking", True),
        ("while", "a man is walking", "kicking", True),
        ("then", "a man walks", "kicking", False),
        ("and", "a man is walking", "kicking", False),
        ("comma", "a man walks", "he kicks", False),
    ],
)
def test_the_link_says_whether_a_participle_goes_with_the_clause_before(
    link: str, before: str, words: str, *, is_said: bool
) -> None:
    clauses = [ParsedClause("first", before, number=0), ParsedClause(link, words, number=1)]
    found = [number for number, _ in shown_in_turn(clauses, {0: before, 1: words}, [WALK, KICK])]
    assert found == [1] * is_said


@pytest.mark.parametrize(
    ("text", "is_said"),
    [
        ("a person is dancing side to side and turning", True),
        ("a person dances and spins around", True),
        ("a person is spinning and dancing", True),
        ("a person dances, then turns around", False),
        ("a person walks and turns around", False),
    ],
)
def test_a_turn_during_a_dance_is_said_to_come_after_it(text: str, is_said: bool) -> None:
    notes = " ".join(parse(text, in_part=True).notes)
    assert ("one after the other" in notes) == is_said


def test_a_dance_goes_round_in_no_circle() -> None:
    plan = parse("a person is dancing, moving side to side and in circles", in_part=True)
    assert plan.clauses[-1].status == "approximated"
    assert "the circle" in plan.clauses[-1].how
