"""Clauses that share a step though they say that something is done again, or to the other side: they are not done."""

from collections.abc import Iterator, Sequence

from mmweaver.motion.language.coverage import sides_gone_to, sides_of
from mmweaver.motion.language.lexicon import FILLERS
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import Step

_WAYS = {"up", "down", "out", "in"}


def says_again(parsed: ParsedClause) -> bool:
    """Whether a clause says that something is done once more."""
    return any(word.text == "again" for word in parsed.words)


def says_how_far_it_pivots(found: Sequence[ParsedClause], parsed: ParsedClause) -> bool:
    """Whether a turn is the pivot of the clause before it: 'pivots on his left foot and does a half turn'."""
    pivot, turn = found[-1].steps[-1] if found else None, parsed.steps[0]
    if pivot is None or {pivot.lower, turn.lower} != {"turn"} or len(parsed.steps) > 1 or parsed.link == "then":
        return False
    on_a_foot = pivot.foot and not (pivot.turn_deg or pivot.direction in OPPOSITE or says_again(parsed))
    return bool(on_a_foot) and any(word.lemma == "pivot" for word in found[-1].words)


def shown_only_once(every_clause: Sequence[ParsedClause], steps: Sequence[Step]) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is not shown) for clauses that differ from the one whose step they share.

    Such a clause says "again", another side, or "the other" of a pair, and has no step more than that one.
    """
    places = {one.number: {i for i, step in enumerate(steps) if one.number in step.clauses} for one in every_clause}
    for i, parsed in enumerate(every_clause):
        own = [steps[place] for place in sorted(places[parsed.number])]
        before = [
            one
            for one in every_clause[:i]
            if not own or (places[one.number] and places[one.number] <= places[parsed.number])
        ]
        if not before:
            continue
        if says_again(parsed) and _is_done_twice(before, parsed):
            yield parsed.number, "the second time is not shown"
        elif _names_other_side(before, parsed, own):
            yield parsed.number, "the other side is not shown"
        elif _ends_with_another(parsed) and not parsed.steps:
            yield parsed.number, "the other one is not shown"


def _ends_with_another(parsed: ParsedClause) -> bool:
    texts = [word.text for word in parsed.words]
    return bool({"another", "other"} & {*texts[-1:], *(texts[-2:-1] if texts[-1:] == ["one"] else ())})


def _is_done_twice(before: Sequence[ParsedClause], parsed: ParsedClause) -> bool:
    """Whether a clause has the movement of one before, or no verb but a word of it: 'hands up ... up again'."""
    done = {(step.lower, step.upper) for one in before for step in one.steps} - {("stand", "")}
    said = {word.text for one in before for word in one.words}
    more = {word.text for word in parsed.words} - (FILLERS - _WAYS) - {"again"}
    return any((step.lower, step.upper) in done for step in parsed.steps) or (not parsed.steps and bool(more & said))


def _sides_in(parsed: ParsedClause) -> set[tuple[str, str]]:
    """("to" or "from", side) of the sides that something goes to or comes from."""
    texts = [word.text for word in parsed.words]
    come_from = {("from", text.removeprefix("from_")) for text in texts if text in ("from_left", "from_right")}
    return {("to", side) for side in sides_gone_to(texts)} | come_from


def _names_other_side(before: Sequence[ParsedClause], parsed: ParsedClause, own: Sequence[Step]) -> bool:
    """Whether a clause names the side opposite to that of a clause before, and their step has one side only."""
    sides = _sides_in(parsed)
    earlier = {side for one in before for side in _sides_in(one)}
    has_both = any(len(sides_of(part)) == 2 for part in own)
    return len(sides) == 1 and {(way, OPPOSITE[side]) for way, side in sides} == earlier and bool(own) and not has_both
