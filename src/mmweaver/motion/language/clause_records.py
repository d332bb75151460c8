"""The record of every clause: what of it no step shows, and what it is shown as, in the sentence's own words."""

from collections.abc import Sequence
from dataclasses import replace

from mmweaver.motion.language.alignment import given_words
from mmweaver.motion.language.described_person import without_stature
from mmweaver.motion.language.named_steps import with_what_is_shown
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step
from mmweaver.motion.language.said_as_shown import saying_what_is_shown
from mmweaver.motion.language.token_coverage import not_covered

_WORSE = (DONE, APPROXIMATED, NOT_DONE)


def note_what_is_not_shown(
    given_text: str, every_clause: list[ParsedClause], steps: list[Step], records: dict[int, ClauseRecord]
) -> None:
    """Records what of each clause its steps do not show: what parsing has found, then each word without a field."""
    parts = [part for step in steps for part in step.each]
    lost = [(parsed.number, how) for parsed in every_clause for how in parsed.lost]
    approximated = {parsed.number for parsed in every_clause if parsed.approximations}
    lost += not_covered(without_stature(given_text.lower()), parts, records, approximated)
    for number, how in lost:
        quoted = how.split("'")[1:2]
        is_reported = how in records[number].how or any(
            quoted and quoted[0] in record.how for record in records.values()
        )
        if records[number].status != NOT_DONE and not is_reported:
            records[number] = records[number].lowered_to(APPROXIMATED, how)


def in_the_given_words(
    given_text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], *, roughly: bool
) -> tuple[list[Step], list[ClauseRecord], list[str]]:
    """Steps and records with the clauses as they were given, in the sentence's order, and a note for each not done so.

    A record says all that its clause is shown as, unless the words say just that; notes are of clauses that are not
    done. A clause that patterns have added counts with the one before.
    """
    own_words = given_words(given_text, records)
    given = [number for number in sorted(records) if own_words[number]] or [min(records)]
    of_given = {number: max((one for one in given if one <= number), default=given[0]) for number in records}
    clauses = []
    for number in given:
        parts = [record for other, record in sorted(records.items()) if of_given[other] == number]
        words, status = own_words[number] or given_text.strip(), max((part.status for part in parts), key=_WORSE.index)
        hows = [how.replace(repr(part.clause), repr(words)) for part in parts for how in part.how.split("; ") if how]
        clauses.append(ClauseRecord(words, status, "; ".join(hows)))
    index = {number: given.index(of_given[number]) for number in records}
    steps = [_in_own_words(step, index, clauses) for step in steps]
    clauses = saying_what_is_shown(with_what_is_shown(clauses, steps), steps, roughly=roughly)
    return steps, clauses, [record.sentence for record in clauses if record.status != DONE]


def _in_own_words(step: Step, index: dict[int, int], clauses: Sequence[ClauseRecord]) -> Step:
    numbers = tuple(dict.fromkeys(index[number] for number in step.clauses))
    words = ", ".join(clauses[number].clause for number in numbers) or step.clause
    other_hand = None if step.other_hand is None else _in_own_words(step.other_hand, index, clauses)
    return replace(step, clauses=numbers, clause=words, other_hand=other_hand)


def in_own_words(message: str, given_text: str, clauses: dict[int, str]) -> str:
    """A message that quotes clauses as they were taken, with the sentence's own words instead."""
    if not clauses:
        return message
    own_words = given_words(given_text, {number: ClauseRecord(text) for number, text in clauses.items()})
    for number, text in clauses.items():
        message = message.replace(repr(text), repr(own_words[number] or given_text.strip()))
    return message
