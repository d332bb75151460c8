"""Explains every clause: what its steps do not show and what it is shown as, in the sentence's own words."""

import re
from collections.abc import Sequence
from dataclasses import replace

from mmweaver.motion.language.described_person import strip_stature
from mmweaver.motion.language.lexicon import NUMBERS, PRONOUNS, SEATS, TARGETS, TIMES
from mmweaver.motion.language.measures import unmeasured
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, Step
from mmweaver.motion.language.postures import add_shown_text, steps_of_each
from mmweaver.motion.language.token_coverage import given_words, not_covered
from mmweaver.motion.language.words import word_of

_LOST = re.compile(r"((?:'[^']+'(?: and |, )?)+) (?:is|are) not shown")
_NOT_SHOWN = re.compile(r"((?:the|what|which|how|where) [^';,]*(?:'[^']*')?) is not shown")
_SHOWN_AS = re.compile(r"(?P<what>.*)\b(?:is|are) shown as (?P<how>.+)")
_ROUGHLY = re.compile("only (?:what|that) .* (?:is|are) shown.*")  # `fallback_parsing`
_STEM = 4
_ALIKE = {  # one limb either way; a knee is not kneeling
    "arm": "hand",
    "arms": "hands",
    "fist": "hand",
    "foot": "leg",
    "feet": "legs",
    "knee": "joint",
    "knees": "joint",
}


def add_explanations(records: Sequence[ClauseRecord], steps: Sequence[Step], *, roughly: bool) -> list[ClauseRecord]:
    """Adds to each record what its clause is shown as, unless its words state exactly that.

    Args:
        records: Records of the clauses.
        steps: Final steps.
        roughly: Whether the sentence was parsed roughly; clauses whose words differ from what is shown are then lowered
            to approximated.

    Returns:
        The records with explanations.
    """
    of_each = steps_of_each(len(records), steps)
    records = [_partly_done(record) if own else record for record, own in zip(records, of_each, strict=True)]
    said: list[ClauseRecord] = []
    for number, (record, own) in enumerate(zip(records, of_each, strict=True)):
        if record.status == NOT_DONE or not record.shown:
            said.append(record)
            continue
        goes_on = number > 0 and _goes_on(record, own, said[-1], of_each[number - 1])
        shown, is_plain = record.shown.removeprefix("then "), _says(record, own)
        is_same = bool(said) and said[-1].shown.removeprefix("then ") == shown
        briefly = "the same movement" if is_same and "is shown as" in said[-1].how else shown
        whole = [] if is_plain and not goes_on else [f"is shown as {briefly}"]
        hows = [how for how in record.how.split("; ") if how]
        if "stagger" not in shown:  # of "like a zombie", whatever else the clause says
            hows = [
                how.replace("an unsteady gait is shown as staggering", "the unsteady gait is not shown") for how in hows
            ]
        more = [how for how in hows if not (_ROUGHLY.fullmatch(how) or _is_within(how, shown))]
        hows = _merged_reasons([*whole, *more] or hows)
        otherwise = (goes_on and _is_another(said[-1])) or (roughly and not is_plain)
        status = APPROXIMATED if otherwise else record.status
        said.append(replace(record, status=status, how="; ".join(hows)))
    return said


def _goes_on(record: ClauseRecord, own: Sequence[Step], before: ClauseRecord, steps: Sequence[Step]) -> bool:
    """Whether a clause only states the limb or direction with which the movement explained before continues."""
    words = _stems(record.clause) - _NO_WORDS
    same = {(step.lower, step.upper) for step in own} & {(step.lower, step.upper) for step in steps}
    return "is shown as" in before.how and bool(words and same) and words <= _OF_NUMBERS | _OF_SIDES


def _is_another(record: ClauseRecord) -> bool:
    """Whether a movement is shown as another one, without any word in common: "scratches", "waving"."""
    alike = _stems(record.clause) & _stems(record.shown)
    return record.status == APPROXIMATED and alike <= _NO_WORDS | _OF_NUMBERS | _OF_SIDES


def _partly_done(record: ClauseRecord) -> ClauseRecord:
    """Record of a clause that has steps; if it is not done, patterns have made a clause of a part of it."""
    if record.status != NOT_DONE:
        return record
    hows = ["a part of it is not done" if how.startswith("no activity") else how for how in record.how.split("; ")]
    return replace(record, status=APPROXIMATED, how="; ".join(hows))


def _is_within(how: str, shown: str) -> bool:
    """Whether a reason only states what something is shown as, and the description contains it."""
    found = _SHOWN_AS.fullmatch(how)
    if found is None:
        return False
    generally = not found["what"] or ("'" not in how and _stems(found["how"]) - _NO_WORDS <= _stems(shown))
    return generally or found["how"] == shown


def _merged_reasons(hows: list[str]) -> list[str]:
    """Reasons without repetitions of words that are not shown; all such words are listed in one reason."""
    lost = [words for how in hows if (found := _LOST.fullmatch(how)) for words in re.findall("'([^']+)'", found[1])]
    others = [how for how in dict.fromkeys(hows) if not _LOST.fullmatch(how)]
    said = _stems(" ".join(others))
    kept = [
        words
        for words in dict.fromkeys(lost)
        if not any(words != more and f" {words} " in f" {more} " for more in lost) and not _stems(words) <= said
    ]
    generally = [found[1] for how in others if (found := _NOT_SHOWN.fullmatch(how))]
    listed = [*generally, *map(repr, kept)]
    all_lost = " and ".join([", ".join(listed[:-1]), listed[-1]] if len(listed) > 1 else listed)
    others = [how for how in others if not _NOT_SHOWN.fullmatch(how)]
    return [*others, *([f"{all_lost} {'is' if len(listed) == 1 else 'are'} not shown"] if listed else [])]


def _stems(text: str) -> set[str]:
    lemmas = [word_of(word).lemma for word in re.findall("[a-z0-9]+", text.lower())]
    return {_ALIKE.get(lemma, lemma)[:_STEM] for lemma in lemmas}


def _says(record: ClauseRecord, own: Sequence[Step]) -> bool:
    """Whether the words of a clause and what it is shown as are equivalent: 'she kneels down', 'kneeling down'.

    Sides, directions, counts and postures are compared both ways; one movement has no order. Words for a seat or a
    landmark are free.
    """
    said, seen = _stems(record.clause) - _NO_WORDS, _stems(record.shown)
    if not said:
        return True
    kept = {word for word, kind in TARGETS.items() if any(kind in _place_words(step) for step in own)}
    kept |= {word for word in SEATS if any(step.seat == word for step in own)}
    if len(own) != 1 or not said - _stems(" ".join(kept)) - _OF_NUMBERS <= seen or seen & _TELLING - said:
        return False
    numbers, counts = _numbers(record.clause), _numbers(record.shown)
    return numbers <= counts and counts - {1.0, 90.0} <= numbers  # "once", "one hand", a turn to a side


def _numbers(text: str) -> set[float]:
    """The numbers of a text, in words or digits."""
    words = re.findall(r"[a-z]+|\d+(?:\.\d+)?", text.lower())
    values = [NUMBERS.get(word) if word.isalpha() else float(word) for word in words]
    return {float(value) for value in values if value is not None}


def _place_words(step: Step) -> tuple[str, ...]:
    """The kinds of landmarks that a step goes to, is done at or faces."""
    return step.target, step.facing, *(() if step.place is None else step.place.words.split())


_NO_WORDS = _stems(
    " ".join((*PRONOUNS, "a an the person man woman child boy girl is are his her their to at for on does do still"))
)
_OF_NUMBERS = _stems(" ".join((*NUMBERS, *TIMES, "times seconds")))
_OF_SIDES = _stems("left right both other side one hand arm leg foot with again forward back backwards and then")
_TELLING = _stems(
    "left right both backwards towards away circle slowly quickly knee belly sitting lying kneeling overhead lowering"
)


_WORSE = (DONE, APPROXIMATED, NOT_DONE)


def record_uncovered(
    given_text: str, every_clause: list[ParsedClause], steps: list[Step], records: dict[int, ClauseRecord]
) -> None:
    """Records what the steps do not show of each clause: the parser's findings, then each word without a field.

    Args:
        given_text: The original sentence.
        every_clause: All parsed clauses.
        steps: Final steps.
        records: Record of each clause by its number, modified in place.
    """
    parts = [part for step in steps for part in step.each]
    lost = [(parsed.number, how) for parsed in every_clause for how in parsed.lost]
    approximated = {parsed.number for parsed in every_clause if parsed.approximations}
    lost += not_covered(strip_stature(unmeasured(given_text.lower())), parts, records, approximated)
    for number, how in lost:
        quoted = how.split("'")[1:2]
        is_reported = how in records[number].how or any(
            quoted and quoted[0] in record.how for record in records.values()
        )
        if records[number].status != NOT_DONE and not is_reported:
            records[number] = records[number].lowered_to(APPROXIMATED, how)


def explain_clauses(
    given_text: str, steps: Sequence[Step], records: dict[int, ClauseRecord], *, roughly: bool
) -> tuple[list[Step], list[ClauseRecord], list[str]]:
    """Restates steps and records in the original clauses, in the sentence's order.

    A record states all that its clause is shown as, unless the words state exactly that. A clause added by patterns
    counts with the previous one.

    Args:
        given_text: The original sentence.
        steps: Final steps.
        records: Record of each clause by its number.
        roughly: Whether the sentence was parsed roughly.

    Returns:
        Steps, records, and a note for each clause that is not done as stated.
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
    steps = [_quote_clauses(step, index, clauses) for step in steps]
    clauses = add_explanations(add_shown_text(clauses, steps), steps, roughly=roughly)
    return steps, clauses, [record.sentence for record in clauses if record.status != DONE]


def _quote_clauses(step: Step, index: dict[int, int], clauses: Sequence[ClauseRecord]) -> Step:
    numbers = tuple(dict.fromkeys(index[number] for number in step.clauses))
    words = ", ".join(clauses[number].clause for number in numbers) or step.clause
    other_hand = None if step.other_hand is None else _quote_clauses(step.other_hand, index, clauses)
    return replace(step, clauses=numbers, clause=words, other_hand=other_hand)


def quote_given_words(message: str, given_text: str, clauses: dict[int, str]) -> str:
    """Replaces quoted clauses of a message by the original words.

    Args:
        message: Message that quotes clauses after rewriting.
        given_text: The original sentence.
        clauses: Words of each clause after rewriting, by number.
    """
    if not clauses:
        return message
    own_words = given_words(given_text, {number: ClauseRecord(text) for number, text in clauses.items()})
    for number, text in clauses.items():
        message = message.replace(repr(text), repr(own_words[number] or given_text.strip()))
    return message
