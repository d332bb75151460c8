"""Messages quote the user's own words, say each thing once, and nothing where a clause is done as it was said."""

import re
from pathlib import Path

import pytest

from mmweaver.core.errors import InputError
from mmweaver.motion.language.plan import DONE
from mmweaver.motion.language.sentence import parse

SENTENCES = (Path(__file__).parents[3] / "studies/motion/sentences/strangers.txt").read_text(encoding="utf-8")
MESSAGES = re.compile(r"(?:the clause )?'([^']+)'(?: names| says| speaks| is|:| cannot)|in '([^']+)',")


@pytest.mark.parametrize(
    "text",
    [
        "a person does a cartwheel around the corner",
        "someone cartwheels in a circle",
        "two people walk back and forth",
        "Nobody walks 90 degrees to the left",
    ],
)
def test_refusals_quote_the_sentence_as_it_was_given(text: str) -> None:
    with pytest.raises(InputError) as error:
        parse(text, in_part=True)
    quoted = next(filter(None, MESSAGES.search(str(error.value)).groups()))
    assert quoted in text


def test_records_notes_and_steps_quote_the_sentence_as_it_was_given():
    for text in SENTENCES.splitlines():
        try:
            plan = parse(text, in_part=True)
        except InputError as error:
            found = MESSAGES.match(str(error))
            assert found is None or found[1] in text
            continue
        for words in (record.clause for record in plan.clauses):
            assert all(part in text for part in words.split(" ... "))
        assert len(set(plan.notes)) == len(plan.notes)
        not_done = [record for record in plan.clauses if record.status != DONE]
        assert [record.sentence for record in not_done] == [note for note in plan.notes if note in {
            record.sentence for record in not_done
        }]  # fmt: skip
        assert {number for step in plan.steps for number in step.clauses} <= set(range(len(plan.clauses)))


@pytest.mark.parametrize(
    ("text", "how"),
    [
        (
            "she waves goodbye over her shoulder",
            "hand repeatedly; 'over' and 'shoulder' are not shown",
        ),
        ("a person claps above the head", "is shown as clapping repeatedly; 'above' and 'head' are not shown"),
        ("he scratches his head thinking", "'thinking' has no movement that is shown"),
        ("a person bows to the left and then to the right", "is shown as bowing once; the side is not shown"),
        ("a person rides an exercise bike", "is shown as riding an exercise bike; the bike is not shown"),
        ("a person climbs the stairs carrying a box", "'carrying a box' is not shown"),
    ],
)
def test_what_is_not_shown_is_said_once(text: str, how: str) -> None:
    record = parse(text, in_part=True).clauses[0]
    assert how in record.how
    assert len(re.findall("not shown", record.how)) <= 1


def test_what_is_done_as_it_was_said_needs_no_note():
    plan = parse("she kneels down, then flosses", in_part=True)
    assert plan.clauses[0].status == DONE
    assert [note for note in plan.notes if "kneels" in note] == []
    assert [note for note in plan.notes if "'flosses' is not done" in note]


def test_a_part_that_is_understood_is_not_replaced_where_another_is_not():
    plan = parse("a woman takes off her coat and hangs it up", in_part=True)
    assert [step.upper for step in plan.steps] == ["jacket_off", "reach"]


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("an old man walks to the window, looking around", [("walk", "look_around")]),
        ("sits down while reading a newspaper", [("sit_down", "read"), ("sit", "read")]),
        ("a person is looking around and making a few steps", [("stand", "look_around"), ("walk", "")]),
        ("he walks to the door and back", [("walk", ""), ("walk", "")]),
        ("a woman does yoga: the tree pose, then the warrior pose", [("tree_pose", ""), ("warrior_pose", "")]),
        ("the woman gets out of bed", [("lie_on_seat", ""), ("sit_up", ""), ("stand_up", "")]),
    ],
)
def test_everyday_sentences(text: str, steps: list[tuple[str, str]]) -> None:
    assert [(step.lower, step.upper) for step in parse(text, in_part=True).steps] == steps


def test_a_clause_is_the_part_between_two_links() -> None:
    clauses = parse("a person does a right front lunge, then a left front lunge").clauses
    assert [clause.clause for clause in clauses] == ["a person does a right front lunge", "a left front lunge"]
    clauses = parse("a person paces back and forth while talking on the phone").clauses
    assert [clause.clause for clause in clauses] == ["a person paces back and forth", "talking on the phone"]


def test_where_and_how_long_need_no_other_words() -> None:
    plan = parse("a woman walks to the window, fiddles the knob for three seconds and walks back", in_part=True)
    assert plan.clauses[0].how == plan.clauses[-1].how == ""


def test_what_is_not_shown_is_said_of_the_clause_that_says_it() -> None:
    blocks, punches = parse("a person blocks with the left arm and punches with the right").clauses
    assert "which hand or foot it is" in blocks.how
    assert "which hand" not in punches.how
