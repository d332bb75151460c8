"""Clauses that share a step though they say that something is done again, or to the other side: they are not done."""

from collections.abc import Iterator, Sequence

from mmweaver.motion.language.clause_parser import ParsedClause
from mmweaver.motion.language.coverage import sides_gone_to, sides_of
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.plan import Step


def says_again(parsed: ParsedClause) -> bool:
    """Whether a clause says that something is done once more."""
    return any(word.text == "again" for word in parsed.words)


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
        elif parsed.words and parsed.words[-1].text in ("another", "other") and not parsed.steps:
            yield parsed.number, "the other one is not shown"


def _is_done_twice(before: Sequence[ParsedClause], parsed: ParsedClause) -> bool:
    """Whether a clause has the movement of one before, or no verb but a side."""
    done = {(step.lower, step.upper) for one in before for step in one.steps} - {("stand", "")}
    return any((step.lower, step.upper) in done for step in parsed.steps) or bool(
        not parsed.steps and sides_gone_to([word.text for word in parsed.words])
    )


def _names_other_side(before: Sequence[ParsedClause], parsed: ParsedClause, own: Sequence[Step]) -> bool:
    """Whether a clause names the side opposite to that of a clause before, and their step has one side only."""
    sides = {*sides_gone_to([word.text for word in parsed.words])}
    earlier = {side for one in before for side in sides_gone_to([word.text for word in one.words])}
    has_both = any(len(sides_of(part)) == 2 for part in own)
    return len(sides) == 1 and {OPPOSITE[side] for side in sides} == earlier and bool(own) and not has_both
