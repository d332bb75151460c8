"""Parses a sentence into a MotionPlan: every clause becomes a step or an overlay, or an error names the clause.

Entry point of sentence parsing: text in, MotionPlan out. The parser in use is chosen here only.
"""

import re
from copy import deepcopy
from dataclasses import replace
from functools import cache
from typing import Protocol

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.approximations import apply_approximations
from mmweaver.motion.language.clause_parser import parse_clause
from mmweaver.motion.language.clauses import Clause, split_clauses
from mmweaver.motion.language.described_person import described_person
from mmweaver.motion.language.durations import durations_in_seconds
from mmweaver.motion.language.explanations import explain_clauses, quote_given_words, record_uncovered
from mmweaver.motion.language.fallback_parsing import (
    EXACT,
    LEAVING_OUT,
    MISSING,
    ROUGH,
    may_be_missed,
    parse_with_less,
    read_roughly,
    says_more_of,
)
from mmweaver.motion.language.lexicon import ARMS, NUMBERS, RECOVERING
from mmweaver.motion.language.measures import measures_in_si
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.places import room_of
from mmweaver.motion.language.plan import APPROXIMATED, DONE, NOT_DONE, ClauseRecord, MotionPlan, Side, Step, Way
from mmweaver.motion.language.posture_persistence import ARM_POSTURES, persist_postures
from mmweaver.motion.language.postures import add_shown_text, inherit_state, insert_transitions, repeat_pairs
from mmweaver.motion.language.repetitions import RepeatedSentence, repetition_of
from mmweaver.motion.language.rewrite_rules import rewritten
from mmweaver.motion.language.simultaneous import going_on, sequence_steps
from mmweaver.motion.language.suggestions import not_known
from mmweaver.motion.language.things import face_things, looks_as_facing
from mmweaver.motion.language.verb_steps import AIMED, SIDES
from mmweaver.motion.language.words import Word, correct_spelling, words_of

MAX_CHARACTERS = 1000
MAX_STEPS = 24
_LONG_NUMBER = re.compile(r"\d{10}")
_YOUR = re.compile(r"\byour\b", re.IGNORECASE)  # "raise your hand", addressed to the person
JUMPING = ("jump", "leap", "hop")
BENT = ("bend", "bow", "squat", "crouch", "lunge")  # they end upright
LOWERING = {"lower", "lowers", "lowering", "lowered", "drops", "drop", "down", "sink"}


def parse(text: str, *, in_part: bool = False) -> MotionPlan:
    """Parses what a person does into steps in temporal order, not scheduled yet.

    A sentence that is not understood is tried in other words (`rewrite_rules`), then with similar movements instead of
    unknown ones (`approximations`), which the clause's record reports. Left and right of a direction are the viewer's
    (as in the photo), of a hand or a turn the person's own. See docs/decisions/reading-sentences.md.

    Args:
        text: The sentence.
        in_part: Whether, as a last resort, clauses that are not understood are recorded as not done, if at least as
            many are understood, or parsed roughly (`fallback_parsing`). Labelled data is parsed without.

    Returns:
        The plan, with a record of every clause.

    Raises:
        InputError: If the text is empty or too long, a negation, about several people, or has a clause that names no
            known activity: nothing is dropped silently.
    """
    given_text = text
    if not text.strip():
        raise InputError(f"the text is empty; say what the person does, for example {EXAMPLE!r}")
    if _LONG_NUMBER.search(text):
        raise InputError("a number in the sentence has more than 9 digits; say a smaller one")
    if len(text) > MAX_CHARACTERS:
        raise InputError(f"the text has {len(text)} characters, {MAX_CHARACTERS} are allowed; say it shorter")
    repeated = repetition_of(text)
    if repeated.times > 1 and len(repeated.text.split()) > 1:
        return _several_times(parse(repeated.text, in_part=in_part), repeated, given_text)
    text = looks_as_facing(measures_in_si(_YOUR.sub("his", text).lower()))
    text = rewritten(durations_in_seconds(text), "first")
    try:
        return _parsed(apply_approximations(text, only_always=True), given_text)
    except InputError as error:
        other_words = rewritten(text.lower(), "last")
        normal = apply_approximations(other_words, only_always=True)
        similar = apply_approximations(other_words, is_understood=cache(_is_understood_alone))
        partly = apply_approximations(other_words, in_part=in_part)
        attempts = (
            (normal, EXACT),
            (similar, EXACT),
            (normal, LEAVING_OUT),
            (similar, LEAVING_OUT),
            (similar, MISSING),
            (partly, EXACT),
            (partly, ROUGH),
            (normal, ROUGH),
        )
        for other, leaving in attempts if in_part else attempts[:4]:
            try:
                return _parsed(other, given_text, leaving)
            except InputError:
                continue
        raise error from None


def _several_times(plan: MotionPlan, repeated: RepeatedSentence, given_text: str) -> MotionPlan:
    """Repeats a plan as often as stated; raises InputError for too many steps."""
    if len(plan.steps) * repeated.times > MAX_STEPS:
        raise InputError(
            f"{len(plan.steps)} movements {repeated.times} times are more than {MAX_STEPS}; say fewer, or none and ask"
            " for more --seconds"
        )
    number, first = len(plan.clauses), plan.steps[0]
    if len(plan.steps) == 1 and BY_KEY[first.upper or first.lower].counted_s and not first.count and not first.moves:
        first = replace(first, count=repeated.times, clauses=(*first.clauses, number))
        steps = [first]
    else:
        more = [replace(step, clauses=(*step.clauses, number)) for step in plan.steps * (repeated.times - 1)]
        steps = inherit_state(insert_transitions([*plan.steps, *more]))
    again = ClauseRecord(repeated.words)
    if any(clause.status == NOT_DONE for clause in plan.clauses):
        again = again.lowered_to(APPROXIMATED, "what is not shown once is not shown again")
    clauses = add_shown_text((*plan.clauses, again), steps)
    said = {before.sentence: now.sentence for before, now in zip(plan.clauses, clauses, strict=False)}
    notes = [said.get(note, note) for note in plan.notes] + [again.sentence] * (again.status != DONE)
    return replace(plan, text=given_text, steps=tuple(steps), clauses=clauses, notes=tuple(notes))


def _parsed(text: str, given_text: str, leaving: int = EXACT) -> MotionPlan:
    """The plan of one wording of a sentence; `leaving` is what may be dropped or parsed roughly, which is reported.

    Raises InputError in the words of the original sentence.
    """
    text, notes = correct_spelling(text)
    words = words_of(text)
    clauses = {clause.number: clause.text for clause in split_clauses(words)}
    try:
        return _planned(words, notes, given_text, leaving)
    except InputError as error:
        raise InputError(quote_given_words(str(error), given_text, clauses)) from None


def _planned(words: list[Word], notes: list[str], given_text: str, leaving: int) -> MotionPlan:
    parsed_clauses, every_clause, records = _parsed_clauses(words, notes, leaving)
    if not parsed_clauses:
        raise InputError(not_known(given_text.strip()))
    sequence = sequence_steps(parsed_clauses, leaving)
    steps = inherit_state(insert_transitions(going_on(sequence)))
    said = {number: f"{record.clause} {record.how}" for number, record in records.items()}
    steps, lost = persist_postures(steps, said, {one.number for one in every_clause if one.link == "then"})
    steps = face_things(repeat_pairs(steps, MAX_STEPS), given_text)
    for number, how in lost:
        records[number] = records[number].lowered_to(APPROXIMATED, how)
    record_uncovered(given_text, every_clause, steps, records)
    if len(steps) > MAX_STEPS:
        raise InputError(f"the text asks for {len(steps)} movements, {MAX_STEPS} are allowed; say fewer")
    room = room_of(given_text)
    if room:
        notes.append(f"the room of the photo is taken as the {room} of the sentence")
    if leaving and all(step.lower == "stand" and not step.upper for step in steps):
        raise InputError(not_known(given_text.strip()))
    steps, clauses, how_shown = explain_clauses(given_text, steps, records, roughly=bool(leaving))
    return MotionPlan(
        text=given_text,
        steps=tuple(steps),
        notes=tuple(dict.fromkeys([*notes, *how_shown])),
        clauses=tuple(clauses),
        person=described_person(given_text),
    )


def _is_understood_alone(part: str) -> bool:
    """Whether a part of a sentence is done as stated, so that nothing in it needs an approximation."""
    try:
        plan = _parsed(part, part) if part else None
    except InputError:
        return False
    return plan is not None and all(clause.status == DONE for clause in plan.clauses)


def _parsed_clauses(
    words: list[Word], notes: list[str], leaving: int
) -> tuple[list[ParsedClause], list[ParsedClause], dict[int, ClauseRecord]]:
    """The clauses that name an activity, all clauses, and a record of every clause by its number."""
    found: list[ParsedClause] = []
    every_clause: list[ParsedClause] = []
    records: dict[int, ClauseRecord] = {}
    ahead: ParsedClause | None = None  # modifiers before the first verb: "is carefully and slowly walking"
    missed: Clause | None = None
    for clause in split_clauses(words):
        goes_on = missed is not None and says_more_of(missed, clause)
        missed = clause if leaving >= MISSING and (goes_on or not _is_understood(clause, found)) else None
        rough = read_roughly(deepcopy(clause)) if missed is not None and leaving == ROUGH else None
        if missed is not None and rough is None:
            records[clause.number] = ClauseRecord(clause.text, NOT_DONE, "no activity in it is known")
            continue
        parsed = rough or (parse_with_less(clause, is_first=not found) if leaving else parse_clause(clause))
        missed = None
        if not parsed.steps and not parsed.unknown and parsed.approximations and not found:
            parsed.steps, parsed.forms = [_staying(parsed)], ["s"]
        every_clause.append(parsed)
        notes += parsed.notes
        status = APPROXIMATED if parsed.approximations else DONE
        records[clause.number] = ClauseRecord(clause.text, status, "; ".join(parsed.approximations))
        if parsed.adds_nothing and not parsed.is_empty and not found and not parsed.approximations:
            ahead = parsed
        else:
            _take(parsed, found)
        if ahead is not None and found:
            found[0].absorb(ahead)
            ahead = None
    not_done = sum(record.status == NOT_DONE for record in records.values())
    if not_done > sum(bool(parsed.steps) for parsed in every_clause):
        raise InputError(not_known(next(r.clause for r in records.values() if r.status == NOT_DONE)))
    return found, every_clause, records


def _staying(parsed: ParsedClause) -> Step:
    """Step of a clause whose verb moves nothing: 'meditates on the sofa for five seconds' sits there."""
    about = parsed.about
    lower = "stand" if not about.seat else "lie_on_seat" if about.seat == "bed" else "sit"
    return Step(
        lower=lower,
        seat=about.seat,
        place=about.place,
        seconds=about.seconds,
        facing=about.facing,
        clause=parsed.text,
        clauses=(parsed.number,),
    )


def _is_understood(clause: Clause, found: list[ParsedClause]) -> bool:
    """Whether a clause gives a step or extends a previous one; raises InputError for one that may not be skipped."""
    try:
        _take(parse_with_less(deepcopy(clause), is_first=not found), deepcopy(found))
    except InputError:
        if not may_be_missed(clause):
            raise
        return False
    return True


def _take(parsed: ParsedClause, found: list[ParsedClause]) -> None:
    """Adds a clause to those found, or its modifiers to the previous one. Raises InputError if it is unknown."""
    if parsed.adds_nothing and found and parsed.link in ("and", "comma", "then", "while"):
        _fill_in(found[-1], parsed)
        last = found[-1].steps[-1]
        another = _another_step(last, parsed)
        if another is not None:
            found[-1].take_its_speed(parsed)
            found[-1].steps.append(replace(another, speed=another.speed or parsed.about.speed))
            found[-1].forms.append("s")
        elif _goes_elsewhere(last, parsed):
            found[-1].go_on(parsed)
        else:
            found[-1].absorb(parsed)
    elif parsed.steps and not _is_its_end(found, parsed):
        found.append(parsed)
    elif parsed.steps or (found and _needs_no_step([step for one in found for step in one.steps], parsed)):
        last = found[-1].steps[-1]
        found[-1].steps[-1] = replace(last, clauses=(*last.clauses, parsed.number))
    elif not parsed.is_empty:
        raise InputError(not_known(parsed.text))


def _fill_in(before: ParsedClause, parsed: ParsedClause) -> None:
    """Fills in what a walk and the next clause leave open: 'one step forward, two back', 'a step aside and back'."""
    last = before.steps[-1]
    if last.count and last.lower in ("walk", "sidestep") and not parsed.about.count:
        number = next((NUMBERS[word.text] for word in parsed.words if word.text in NUMBERS), 0)
        parsed.about = replace(parsed.about, count=number)


def _another_step(last: Step, parsed: ParsedClause) -> Step | None:
    """Next step of a clause without a verb: the last one with the other hand, or to another side."""
    other_side = _repeated_with_other_limb(last, parsed)
    if other_side is not None or _goes_elsewhere(last, parsed):
        return other_side
    if not _once_more(last, parsed):
        return None
    side = parsed.about.direction
    assert side is not None  # as `_once_more` found
    way = {"facing": side, "direction": None} if last.facing in OPPOSITE else {"direction": side}
    if last.lower == "turn" and last.turn_deg:  # "spins clockwise, then counterclockwise"
        way = {"turn_deg": abs(last.turn_deg) * SIDES[side], "direction": None, "either_side": False}
    return replace(last, **way, clauses=(parsed.number,))


def _once_more(last: Step, parsed: ParsedClause) -> bool:
    """Whether a clause without a verb repeats the last movement to a side: 'bows to the left, then to the right'."""
    on_the_spot = not last.moves and last.lower not in ("stand", "sit", "kneel", "lie") and not last.upper
    on_the_spot |= last.lower in ("leap", "crawl", "limp", "stagger")  # of the walks `_goes_elsewhere` says more
    on_the_spot |= last.upper in AIMED and last.facing == OPPOSITE.get(parsed.about.direction)
    sides = (last.direction, last.facing if last.upper in AIMED else "")
    other_side = parsed.link == "and" and OPPOSITE.get(parsed.about.direction) in sides
    return (parsed.link == "then" or other_side) and on_the_spot and isinstance(parsed.about.direction, Side)


def _repeated_with_other_limb(last: Step, parsed: ParsedClause) -> Step | None:
    """Repeats the last movement with the other hand or foot: 'punches with the left hand, then the right'."""
    about = parsed.about
    aimed = parsed.link == "and" and not (about.hand or about.foot)  # "to the left and to the right"
    in_turn = parsed.link in ("then", "comma") or aimed or (parsed.link == "and" and about.count)
    side = about.hand or about.foot or about.direction
    is_aim = last.hand and not about.hand and not aimed and any(word.text == "to" for word in parsed.words)
    if is_aim or not in_turn or side not in OPPOSITE or OPPOSITE[side] not in (last.hand, last.foot) or last.moves:
        return None
    limb = {"hand": side} if last.hand else {"foot": side}
    return replace(last, **limb, count=about.count or last.count, clauses=(parsed.number,))


def _goes_elsewhere(last: Step, parsed: ParsedClause) -> bool:
    """Whether a clause without a verb is the next part of a walk: 'walks two steps forwards, then two to the left'."""
    direction = parsed.about.direction
    sideways = isinstance(direction, Side) and last.direction in (Way.FORWARDS, Way.BACKWARDS, Way.BACK, *OPPOSITE)
    sideways |= (
        parsed.link == "then" and direction in (Way.BACK, Way.BACKWARDS) and not last.direction
    )  # "and then back"
    measured = bool(parsed.about.seconds or parsed.about.distance_m)  # "to the left for 3 s and to the right for 5 s"
    follows = parsed.link in ("then", "comma") or (parsed.link == "and" and (measured or last.lower == "sidestep"))
    is_other = direction != last.direction or (parsed.link == "then" and isinstance(direction, Side))
    return follows and is_other and sideways and last.lower in ("walk", "jog", "sidestep") and not last.arc_deg


def _is_its_end(parsed_clauses: list[ParsedClause], parsed: ParsedClause) -> bool:
    """Whether a clause only ends the movement before it: 'lifts a foot and puts it down', 'is pushed and stumbles'."""
    if not parsed_clauses or len(parsed.steps) > 1:
        return False
    before, now = parsed_clauses[-1].steps[-1], parsed.steps[0]
    if now.lower == "put_down" and before.upper in ("raise", "arms_out"):
        return True
    if before.upper:
        return False
    stumbles = before.lower == now.lower == "stumble"
    if stumbles and now.direction and before.direction not in (None, now.direction):
        return False
    if stumbles and (now.direction or now.style) and not before.direction:
        parsed_clauses[-1].steps[-1] = replace(before, direction=now.direction, style=now.style)
    again = before.lower in JUMPING and now.lower in JUMPING and parsed.link == "comma" and parsed.form == "ing"
    lifted = before.lower == "march" and now.lower == "raise_leg" and parsed.form == "ing"
    return stumbles or lifted or (before.lower, now.lower) == ("raise_leg", "put_down") or (again and not now.direction)


def _needs_no_step(steps: list[Step], parsed: ParsedClause) -> bool:
    """Whether the steps before imply a clause: lowering a raised hand or leg, recovering from a push."""
    before, words = steps[-1], set(parsed.unknown) | set(parsed.text.split())
    if before.upper in ("raise", "arms_out") or before.lower == "raise_leg":
        held = {"holds", "holding", "keeps", "keeping"} & words and {"it", "them"} & words
        return bool(LOWERING & words or (held and not parsed.about.seconds))
    if before.upper and LOWERING & words and (ARMS | ({"them"} if before.upper in ARM_POSTURES else set())) & words:
        return True
    if before.lower in BENT:
        return bool({"straightens", "straightening", "comes", "coming"} & words and "up" in words)
    if before.lower in (*JUMPING, "hop_one_leg"):
        return bool({"land", "lands", "landing"} & words)
    return any(step.lower == "stumble" for step in steps) and bool(RECOVERING & words)


EXAMPLE = "a person walks towards the radar, then waves"


class SentenceParser(Protocol):
    """Interface of a parser of sentences."""

    def __call__(self, text: str, *, in_part: bool = False) -> MotionPlan:
        """The steps of a sentence in temporal order, not scheduled yet.

        Args:
            text: The sentence.
            in_part: Whether clauses that are not understood are recorded as not done, if at least as many are.

        Returns:
            The plan, with a record of every clause: done, approximated or not done.

        Raises:
            InputError: If the sentence is not understood; one line states the part, and what is known.
        """


parse_sentence: SentenceParser = parse
