"""What one part of a sentence hands on to the next: a hand, a count, a posture, a place, a way to and fro."""

import re
from collections.abc import Iterator
from itertools import pairwise

from mmweaver.motion.language.checks.given import Given
from mmweaver.motion.language.lexicon import NUMBERS
from mmweaver.motion.language.named_steps import doing
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import words_in

_SAME_HAND = re.compile(r"\b(?:his|her|their|its|that|same) (?:hand|arm)\b")
_USED_FOR = re.compile(
    r"\bus(?:es|ing) (?:the|his|her|their) (left|right) (?:hand|arm) to [a-z]+[^.;,]*? and (?:then )?[a-z]+\b"
)
_TIMES = re.compile(r"\b(?:twice|(?P<n>[a-z]+|\d+) times)\b")
_ELSEWHERE = re.compile(
    r"\b(?P<verb>reach\w*|point\w*|bend\w*|lean\w*|punch\w*|kick\w*)\b(?: (?!and\b|then\b)[a-z]+)*(?:,| and)* then"
    r"(?: (?:down|up|forwards?|back(?:wards?)?|out|to|the|his|her|their|floor|ground|side|left|right|ceiling|sky))+"
    r" (?P<often>twice|[a-z]+ times|\d+ times)\b"
)
_CYCLE = re.compile(
    r"\b(?P<first>(?:bend|squat|crouch|kneel|duck|lean)s?(?: down| over| forward)?) and (?:then )?"
    r"(?:jump|leap|hop|stand|rise|get|straighten)s?(?: back)?(?: up)? (?:twice|[a-z]+ times|\d+ times)\b"
)
_HEIGHTS = re.compile(
    r"\b(?:jump|hop|kick|punch|reach|squat|bend)(?:s|es|ing)? (?:in|at|to|with) "
    r"(?P<n>[a-z]+|\d+) (?:different )?(?:heights|levels|ways)\b"
)
_POSTURE = re.compile(
    r"\b(?P<said>(?:leaning|bending|bent|hunching|hunched|crouching|crouched|squatting|stooping)(?: over| down"
    r"| forwards?)?)\b(?:(?!\bthen\b|\bbefore\b|\bafter\b|[.;]).)*?\b(?:while|as(?! if| though)|when)\b[^.;]*?"
    r"\b(?:walk|run|jog|step|mov|go)(?:s|es|n?ing|ging)?\b"
)
_LOW = words_in("bend lean squat crouch bow")
_ON_FEET = words_in("walk jog sidestep march stagger limp")
_HELD_UP = re.compile(
    r"\b(?:while|with|as)\b[^.;]*?\b(?P<said>(?:hold|keep)(?:s|ing)? (?:(?:his|her|their|the|both) )*"
    r"(?:arms|hands) (?:up|over|above))\b"
)
_SIDE = r"(?:on|from|at|to) (?:the|his|her|their|its) (?P<{}>left|right)\b(?! (?:hand|arm|foot|leg))"
_PLACES = re.compile(
    rf"\bpick\w*\b[^.;]*?{_SIDE.format('one')}[^.;]*?\b(?:put|plac|set|lay|drop)\w*\b[^.;]*?{_SIDE.format('other')}"
)
_TO_AND_FRO = re.compile(
    r"\bup and down (?:an?|the) (?!stairs?\b|steps\b)(?:[a-z]+ ){0,2}?"
    r"(?:slope|hill|ramp|street|road|hall\w*|room|path)\b"
)
_RETURNED = re.compile(r"\breturn(?:s|ing)? (?:it|them)\b")
_MORE_STEPS = re.compile(
    r"\b(?:starts?|begins?|starting) (?:to walk|walking)\b[^.;]*?\btak(?:es|ing) (?P<n>[a-z]+|\d+) steps\b"
)


def carried_over_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for what a later part of the sentence shares with an earlier one."""
    for check in (
        _same_hand, _used_for, _counted_elsewhere, _cycles, _heights, _postures, _held_up, _places, _to_and_fro,
        _returned, _more_steps,
    ):  # fmt: skip
        yield from check(given)


def _at(given: Given, found: re.Match[str], group: str | int = 0) -> int:
    return given.token_at(found.start(group)).clause


def _number(words: str) -> int:
    first = words.split()[0]
    return 2 if first == "twice" else int(first) if first.isdigit() else NUMBERS.get(first, 0)


def _sided_before(given: Given, step: Step) -> str:
    """The side of the one hand that has been used before a step, or ""."""
    before = given.steps[: given.steps.index(step)]
    sides = {one.hand for one in before if one.hand}
    return sides.pop() if len(sides) == 1 and not sides & {"both"} else ""


def _same_hand(given: Given) -> Iterator[tuple[int, str]]:
    """ "Picks it up with the left hand and shakes their hand": it is still the left one."""
    for _found, token in given.matches(_SAME_HAND):
        clause = token.clause
        for step in given.of_clause(clause):
            side = _sided_before(given, step) if step.upper and not step.hand else ""
            if side:
                yield clause, f"that it is the {side} hand is not shown"


def _used_for(given: Given) -> Iterator[tuple[int, str]]:
    """ "Uses the left hand to reach over and grab": it grabs, too."""
    for found in _USED_FOR.finditer(given.text):
        clause = given.token_at(found.end() - 1).clause
        if any(step.upper and not step.hand for step in given.of_clause(clause)):
            yield clause, f"that it is the {found[1]} hand is not shown"


def _counted_elsewhere(given: Given) -> Iterator[tuple[int, str]]:
    """ "Reaches forward, then down twice": three in all, at two heights."""
    for found in _ELSEWHERE.finditer(given.text):
        count = _number(found["often"])
        own = [step for step in given.steps if step.clauses and step.count == count]
        if count and len(own) == 1:
            yield _at(given, found, "often"), f"only {count} are shown, all alike"


def _cycles(given: Given) -> Iterator[tuple[int, str]]:
    """ "Bends down and jumps up three times": both are repeated."""
    for found in _CYCLE.finditer(given.text):
        first, last = given.of_clause(_at(given, found)), given.of_clause(given.token_at(found.end() - 1).clause)
        if first and last and first[0].count < 2 <= last[-1].count:
            yield _at(given, found), f"{found['first']!r} is shown once only"


def _heights(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_HEIGHTS):
        count, own = _number(found["n"]), given.of_clause(token.clause)
        if count and own and max(step.count for step in own) < count:
            yield token.clause, f"{found['n']!r} is not shown"


def _postures(given: Given) -> Iterator[tuple[int, str]]:
    """ "Leaning over while walking": the posture is left before the walk."""
    for found, token in given.matches(_POSTURE):
        low = [i for i, step in enumerate(given.steps) if step.lower in _LOW]
        if low and any(step.lower in _ON_FEET for step in given.steps[low[0] + 1 :]):
            yield token.clause, f"{found['said']!r} is shown before walking, not during it"


def _held_up(given: Given) -> Iterator[tuple[int, str]]:
    """Arms that are held up meanwhile, and raised by a step of their own after the movement."""
    for found in _HELD_UP.finditer(given.text):
        clause = _at(given, found, "said")
        for before, step in pairwise(given.steps):
            if clause in step.clauses and step.upper in ("raise", "raise_hold") and step.lower == "stand":
                yield clause, f"{doing(before)} and {doing(step)} are shown one after the other"


def _places(given: Given) -> Iterator[tuple[int, str]]:
    found = _PLACES.search(given.text)
    stays = not any(step.moves or step.lower == "turn" for step in given.steps[1:-1])
    if found and found["one"] != found["other"] and stays and any(step.lower == "put_down" for step in given.steps):
        yield _at(given, found, "other"), "it is put down where it was picked up"


def _to_and_fro(given: Given) -> Iterator[tuple[int, str]]:
    for _found, token in given.matches(_TO_AND_FRO):
        own = [step for step in given.of_clause(token.clause) if step.moves]
        if own and all(step.direction not in ("pacing", "back") for step in own):
            yield token.clause, "'up and down' is shown as one way"


def _returned(given: Given) -> Iterator[tuple[int, str]]:
    """A hand that is raised and stays up does not return."""
    for found, token in given.matches(_RETURNED):
        clause = token.clause
        if any(step.upper == "raise_hold" for step in given.steps):
            yield clause, f"{found[0]!r} is not shown"


def _more_steps(given: Given) -> Iterator[tuple[int, str]]:
    """ "Starts walking and takes eleven steps": eleven in all."""
    for found, token in given.matches(_MORE_STEPS):
        gaits = [step for step in given.steps if step.lower == "walk"]
        if len(gaits) > 1 and gaits[0].count == 0 and any(step.count == _number(found["n"]) for step in gaits[1:]):
            yield token.clause, f"steps before the {found['n']} are shown, too"
