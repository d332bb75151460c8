"""The record of every clause: what of it no step shows, and what it is shown as, in the sentence's own words."""

from collections.abc import Sequence
from dataclasses import replace

from mmweaver.motion.language.accounts import as_given, unaccounted
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.clause_parser import ParsedClause
from mmweaver.motion.language.coverage import not_shown, sizes_not_shown
from mmweaver.motion.language.mentions import not_in_any_step, risings_that_no_clause_names, without_no_limbs
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step

_ONE = ("left", "right")
_AIMED = ("turn", "stumble", "lean", "leap")
_WAYS = {
    **{way: f" {way}" for way in ("forwards", "backwards", "away", "back", "around")},
    **{side: f" to the {side}" for side in _ONE}, "towards": " towards the radar", "pacing": " to and fro",
    "circle": " in a circle", "spot": " on the spot",
}  # fmt: skip


def note_what_is_not_shown(
    given_text: str,
    every_clause: list[ParsedClause],
    steps: list[Step],
    records: dict[int, ClauseRecord],
    notes: list[str],
) -> None:
    """Says of each clause what its steps do not show; sizes are looked for in the sentence: phrases take them away."""

    def say(number: int, how: str) -> None:
        if how not in records[number].how and records[number].status != NOT_DONE:
            records[number] = records[number].lowered_to(APPROXIMATED, how)
            notes.append(f"of {records[number].clause!r}, {how}")

    for parsed in every_clause:
        own = [step for step in steps if parsed.number in step.clauses] or steps
        for how in [*parsed.lost, *not_shown(parsed.words, own)]:
            say(parsed.number, how)
    for after, how in risings_that_no_clause_names(steps):
        say(after.clauses[0] if after.clauses else max(records), how)
    for how in sizes_not_shown(given_text, steps):
        size = how.split("'")[1]
        say(next((n for n, record in sorted(records.items()) if size in record.clause.split()), max(records)), how)
    for words, how in not_in_any_step(given_text, steps, records):
        if not any(words in record.how for record in records.values()):
            say(next((n for n, record in sorted(records.items()) if words in record.clause), max(records)), how)
    otherwise = {parsed.number for parsed in every_clause if parsed.approximations}
    for number, how in unaccounted(without_no_limbs(given_text), steps, records, otherwise):
        if how.split("'")[1:2] == [] or not any(how.split("'")[1] in record.how for record in records.values()):
            say(number, how)


def in_the_given_words(
    given_text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], notes: Sequence[str], *, roughly: bool
) -> tuple[list[ClauseRecord], list[str]]:
    """The records in the sentence's order and the notes, both with the clauses as they were given.

    A clause that is not simply done says what it is shown as; of a sentence that is read `roughly` every clause does.
    """
    own_words = as_given(given_text, records)
    said = list(notes)
    for number, record in records.items():
        of_it, words = f"of {record.clause!r}, ", own_words[number]
        said = [_sentence(words, note.removeprefix(of_it)) if note.startswith(of_it) else note for note in said]
        shown = ", then ".join(dict.fromkeys(_doing(step) for step in steps if number in step.clauses))
        if not shown or record.status == NOT_DONE or (record.status == DONE and not roughly):
            continue
        if record.status == DONE:
            said.append(f"{words!r} is shown as {shown}")
        if "shown as" not in record.how:
            how = "; ".join(filter(None, (f"is shown as {shown}", record.how)))
            records[number] = replace(record, status=APPROXIMATED, how=how)
    clauses = [replace(records[number], clause=own_words[number]) for number in sorted(records)]
    return clauses, list(dict.fromkeys(said))


def _doing(step: Step) -> str:
    """What a step shows, with its way or side: 'walking backwards', 'kicking with the left foot'."""
    limb = (
        f" with the {step.hand} hand"
        if step.hand in _ONE
        else f" with the {step.foot} foot"
        if step.foot in _ONE
        else ""
    )
    limb = " with both hands" if step.hand == "both" and step.upper else limb
    way = _WAYS.get(step.direction, "") if step.moves or step.lower in _AIMED else ""
    upper = BY_KEY[step.upper].name if step.upper else ""
    if step.upper == "raise":
        upper, limb = (
            {"": "raising a hand", "both": "raising both hands"}.get(step.hand, f"raising the {step.hand} hand"),
            "",
        )
    lower = "" if step.lower == "stand" and upper else f"{BY_KEY[step.lower].name}{way}"
    return " and ".join(filter(None, (lower, upper))) + limb


def _sentence(words: str, how: str) -> str:
    """What became of a clause, as it is said to the user."""
    return f"{words!r} {how}" if how.startswith(("is ", "has ")) else f"in {words!r}, {how}"
