"""The record of every clause: what of it no step shows, and what it is shown as, in the sentence's own words."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from mmweaver.motion.language.accounts import as_given, unaccounted
from mmweaver.motion.language.confirmed import unconfirmed
from mmweaver.motion.language.coverage import not_shown, sizes_not_shown
from mmweaver.motion.language.lexicon import NUMBERS, PRONOUNS, SEATS, TARGETS, TIMES
from mmweaver.motion.language.mentions import not_in_any_step, risings_that_no_clause_names, without_no_limbs
from mmweaver.motion.language.named_steps import doing
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step
from mmweaver.motion.language.shared_steps import shown_only_once
from mmweaver.motion.language.shown_in_turn import shown_in_turn
from mmweaver.motion.language.words import word_of

_WORSE = (DONE, APPROXIMATED, NOT_DONE)
_LOST = re.compile(r"((?:'[^']+'(?: and |, )?)+) (?:is|are) not shown")
_OF_A_SIDE = re.compile("'(?:left|right)'")
_STEM = 4


def note_what_is_not_shown(
    given_text: str, every_clause: list[ParsedClause], steps: list[Step], records: dict[int, ClauseRecord]
) -> None:
    """Records what of each clause its steps do not show; sizes are looked for in the sentence: phrases lose them."""

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
    for words, how in not_in_any_step(given_text, steps, records):
        if not any(words in record.how for record in records.values()):
            yield next((n for n, record in sorted(records.items()) if words in record.clause), max(records)), how


def _is_named(how: str, records: dict[int, ClauseRecord]) -> bool:
    """Whether the words that a reason quotes are named by a record already."""
    words = how.split("'")[1:2]
    return bool(words) and any(words[0] in record.how for record in records.values())


def in_the_given_words(
    given_text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], *, roughly: bool
) -> tuple[list[Step], list[ClauseRecord], list[str]]:
    """Steps and records with the clauses as they were given, in the sentence's order, and a note for each not done so.

    A clause that is not simply done says what it is shown as; of a sentence that is read `roughly` every clause does,
    unless its words say just that. A clause that patterns have added counts with the one before.
    """
    own_words = as_given(given_text, records)
    given = [number for number in sorted(records) if own_words[number]] or [min(records)]
    of_given = {number: max((one for one in given if one <= number), default=given[0]) for number in records}
    clauses, notes = [], []
    for number in given:
        parts = [record for other, record in sorted(records.items()) if of_given[other] == number]
        words, status = own_words[number] or given_text.strip(), max((part.status for part in parts), key=_WORSE.index)
        every = [part for step in steps for part in step.each]
        own = [step for step in every if number in {of_given[n] for n in step.clauses}]
        shown = ", then ".join(dict.fromkeys(map(doing, own)))
        hows = [how.replace(repr(part.clause), repr(words)) for part in parts for how in part.how.split("; ") if how]
        if status == NOT_DONE and shown:  # a part of it that patterns have made a clause of
            status = APPROXIMATED
            hows = ["a part of it is not done" if how.startswith("no activity") else how for how in hows]
        if roughly and status == DONE and shown and not _says(words, shown, own):
            status = APPROXIMATED
        if status == APPROXIMATED:
            is_said = any("shown as" in how or "no movement" in how for how in hows)
            names_it = bool(shown) and not is_said and not _says(words, shown, own)
            hows = _without_repeats([f"is shown as {shown}"] * names_it + hows)
        record = ClauseRecord(words, status, "; ".join(hows))
        clauses.append(record)
        notes += [record.sentence] if record.how else []
    index = {number: given.index(of_given[number]) for number in records}
    return [_in_own_words(step, index, clauses) for step in steps], clauses, notes


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


def _without_repeats(hows: list[str]) -> list[str]:
    """Reasons without those that only say again which words are not shown; all such words in one reason."""
    lost = [words for how in hows if (found := _LOST.fullmatch(how)) for words in re.findall("'([^']+)'", found[1])]
    others = [how for how in dict.fromkeys(hows) if not _LOST.fullmatch(how)]
    others = [how for how in others if not any(_names(how, words) for words in lost)]
    others = [how for how in others if "the other " not in how or how.replace("the other ", "the ") not in others]
    said = _stems(" ".join(others))
    kept = [
        words
        for words in dict.fromkeys(lost)
        if not any(words != more and f" {words} " in f" {more} " for more in lost) and not _stems(words) <= said
    ]
    listed = [*map(repr, kept)]
    all_lost = " and ".join([", ".join(listed[:-1]), listed[-1]] if len(listed) > 1 else listed)
    return [*others, *([f"{all_lost} {'is' if len(kept) == 1 else 'are'} not shown"] if kept else [])]


def _names(how: str, words: str) -> bool:
    """Whether a reason says only what happens with a part of the body that the words name, too."""
    found = re.fullmatch("what happens with '([^']+)' is not shown", how)
    return found is not None and f" {found[1]} " in f" {words} "


def _stems(text: str) -> set[str]:
    return {word_of(word).lemma[:_STEM] for word in re.findall("[a-z0-9]+", text.lower())}


def _says(words: str, shown: str, own: Sequence[Step]) -> bool:
    """Whether the words of a clause are those of what it is shown as: 'she kneels down', 'kneeling down'.

    Where it is done, how often and for how long, as its steps have it, need no other words.
    """
    kept = {word for word, kind in TARGETS.items() if any(kind in _where(step) for step in own)}
    kept |= {word for word in SEATS if any(step.seat == word for step in own)}
    if any(step.count or step.seconds for step in own):
        kept |= {*NUMBERS, *TIMES, "times", "seconds"}
    return _stems(words) - _NO_WORDS - _stems(" ".join(kept)) <= _stems(shown)


def _where(step: Step) -> tuple[str, ...]:
    """The Landmark.kinds that a step goes to, is done at or faces."""
    return step.target, step.facing, *(() if step.place is None else step.place.words.split())


_NO_WORDS = _stems(
    " ".join((*PRONOUNS, "a an the person man woman child boy girl is are his her their to at for on does do"))
)
