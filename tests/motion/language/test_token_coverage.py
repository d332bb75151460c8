"""Every word that says what is seen is shown by a final step, or the clause's record names it."""

from pathlib import Path

import pytest

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.plan import APPROXIMATED, ClauseRecord
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.token_coverage import not_covered

LOST = read_toml(Path(__file__).with_name("not_shown.toml"))


SPOKEN_TWICE = {  # a sentence whose second movement or way no step shows, were its first step left out
    "a person jumps, then claps and jumps again": ["jump", "clap", "jump"],
    "a person walks to the left, then to the right": ["left", "right"],
}


@pytest.mark.parametrize(("sentence", "what"), LOST.items())
def test_words_that_no_step_shows_are_reported(sentence: str, what: str):
    records = [record for record in parse(sentence, in_part=True).clauses if what in record.how]
    assert records
    assert all(record.status == APPROXIMATED for record in records)


@pytest.mark.parametrize(("sentence", "kinds"), SPOKEN_TWICE.items())
def test_what_is_named_twice_needs_two_steps(sentence: str, kinds: list[str]):

    steps = parse(sentence).steps
    assert len(steps) == len(kinds)
    records = {number: ClauseRecord(record.clause) for number, record in enumerate(parse(sentence).clauses)}
    assert not_covered(sentence, steps, records, set()) == []
    assert not_covered(sentence, steps[:-1], records, set()) != []
