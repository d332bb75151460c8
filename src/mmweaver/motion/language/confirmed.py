"""A clause is done only where independent checks find that its steps show all that its words say."""

from collections.abc import Iterator, Sequence

from mmweaver.motion.language.checks.carried_over import carried_over_not_shown
from mmweaver.motion.language.checks.counts import counts_not_shown
from mmweaver.motion.language.checks.endings import endings_not_shown
from mmweaver.motion.language.checks.extents import extents_not_shown
from mmweaver.motion.language.checks.given import given
from mmweaver.motion.language.checks.movements import movements_not_shown
from mmweaver.motion.language.checks.nouns import nouns_not_shown
from mmweaver.motion.language.checks.senses import senses_not_shown
from mmweaver.motion.language.checks.surroundings import special_ways_not_shown
from mmweaver.motion.language.checks.ways import ways_not_shown
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import NOT_DONE, ClauseRecord, Step

_CHECKS = (
    movements_not_shown, ways_not_shown, special_ways_not_shown, counts_not_shown, endings_not_shown,
    extents_not_shown, senses_not_shown, carried_over_not_shown, nouns_not_shown,
)  # fmt: skip


def unconfirmed(
    text: str, every_clause: Sequence[ParsedClause], steps: Sequence[Step], records: dict[int, ClauseRecord]
) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for what the steps, as sequences, do not show of the sentence.

    `text`: as it was given; `steps`: of both hands, see `Step.each`.
    """
    otherwise = {parsed.number for parsed in every_clause if parsed.approximations}
    sentence = given(text, steps, records, otherwise)
    for check in _CHECKS:
        yield from check(sentence)
    yield from _from_a_seat(steps, records)


def _from_a_seat(steps: Sequence[Step], records: dict[int, ClauseRecord]) -> Iterator[tuple[int, str]]:
    """Somebody who gets up after a posture that is not known gets up from a seat."""
    first = next((step for step in steps if step.clauses), None)
    if first is not None and first.lower == "stand_up" and records[min(records)].status == NOT_DONE:
        yield min(first.clauses), "standing up is shown from a seat"
