"""The record of every clause: what of it no step shows, and what it is shown as, in the sentence's own words."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from mmweaver.motion.language.accounts import as_given, unaccounted
from mmweaver.motion.language.confirmed import unconfirmed
from mmweaver.motion.language.coverage import not_shown, sizes_not_shown
from mmweaver.motion.language.described_person import without_stature
from mmweaver.motion.language.mentions import not_in_any_step, risings_that_no_clause_names, without_no_limbs
from mmweaver.motion.language.named_steps import with_what_is_shown
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step
from mmweaver.motion.language.said_as_shown import saying_what_is_shown
from mmweaver.motion.language.shared_steps import shown_only_once
from mmweaver.motion.language.shown_in_turn import shown_in_turn

_WORSE = (DONE, APPROXIMATED, NOT_DONE)
_OF_A_SIDE = re.compile("'(?:left|right)'")


def note_what_is_not_shown(
    given_text: str, every_clause: list[ParsedClause], steps: list[Step], records: dict[int, ClauseRecord]
) -> None:
    """Records what of each clause its steps do not show; sizes are looked for in the sentence: phrases lose them."""
    given_text = without_stature(given_text.lower())
    steps = [part for step in steps for part in step.each]

    def say(number: int, how: str) -> None:
        if how not in records[number].how and records[number].status != NOT_DONE:
            records[number] = records[number].lowered_to(APPROXIMATED, how)

    for parsed in every_clause:
        own = [step for step in steps if parsed.number in step.clauses] or steps
        for how in [*parsed.lost, *not_shown(parsed.words, own)]:
            say(parsed.number, how)
    for number, how in _found(given_text, every_clause, steps, records):
        say(number, how)
    otherwise = {parsed.number for parsed in every_clause if parsed.approximations}
    for number, how in unaccounted(without_no_limbs(given_text), steps, records, otherwise):
        if not _is_named(how, records):
            say(number, how)
    for number, how in unconfirmed(given_text, every_clause, steps, records):
        side_is_named = _OF_A_SIDE.match(how) and "side is not shown" in records[number].how
        if not (side_is_named or _is_named(how, records)):
            say(number, how)


def _found(
    given_text: str, every_clause: list[ParsedClause], steps: list[Step], records: dict[int, ClauseRecord]
) -> Iterator[tuple[int, str]]:
    """(number of the clause, what of it is not shown) of what the grammar is known to lose."""
    is_said = any(parsed.in_turn for parsed in every_clause)
    yield from shown_only_once(every_clause, steps)
    yield from () if is_said else shown_in_turn(every_clause, as_given(given_text, records), steps)
    for after, how in risings_that_no_clause_names(steps):
        yield after.clauses[0] if after.clauses else max(records), how
    for how in sizes_not_shown(given_text, steps):
        size = how.split("'")[1]
        yield next((n for n, record in sorted(records.items()) if size in record.clause.split()), max(records)), how
    own_words = as_given(given_text, records)
    for words, how in not_in_any_step(given_text, steps, records):
        if not any(words in record.how for record in records.values()):
            of = [n for n, record in sorted(records.items()) if words in record.clause]
            of += [n for n, own in sorted(own_words.items()) if words in own.lower()]
            yield of[0] if of else max(records), how


def _is_named(how: str, records: dict[int, ClauseRecord]) -> bool:
    """Whether the words that a reason quotes are named by a record already."""
    words = how.split("'")[1:2]
    return bool(words) and any(words[0] in record.how for record in records.values())


def in_the_given_words(
    given_text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], *, roughly: bool
) -> tuple[list[Step], list[ClauseRecord], list[str]]:
    """Steps and records with the clauses as they were given, in the sentence's order, and a note for each not done so.

    A record says all that its clause is shown as, unless the words say just that; notes are of clauses that are not
    done. A clause that patterns have added counts with the one before.
    """
    own_words = as_given(given_text, records)
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
    own_words = as_given(given_text, {number: ClauseRecord(text) for number, text in clauses.items()})
    for number, text in clauses.items():
        message = message.replace(repr(text), repr(own_words[number] or given_text.strip()))
    return message
