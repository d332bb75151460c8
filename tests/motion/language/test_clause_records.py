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


def test_a_clause_is_the_part_between_two_links() -> None:
    clauses = parse("a person does a right front lunge, then a left front lunge").clauses
    assert [clause.clause for clause in clauses] == ["a person does a right front lunge", "a left front lunge"]
    clauses = parse("a person paces back and forth while talking on the phone").clauses
    assert [clause.clause for clause in clauses] == ["a person paces back and forth", "talking on the phone"]
