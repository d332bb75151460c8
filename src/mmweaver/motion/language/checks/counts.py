"""How often and how variously: words of repetition, turns and angles, against what the steps repeat."""

import re
from collections.abc import Iterator
from itertools import pairwise

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.checks.given import Given
from mmweaver.motion.language.lexicon import NUMBERS
from mmweaver.motion.language.named_hands import hand_of
from mmweaver.motion.language.named_steps import doing
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import words_in

_WAYS_ABOUT = re.compile(
    r"\b(?:in |into |to )?(?:all|different|multiple|various|many|several|random) (?:[a-z]+ )?"
    r"(?:directions?|ways|sides)\b"
)
_OFTEN = re.compile(
    r"\b(?:(?:multiple|several|many|numerous|few|couple of|number of|some|more) (?:more )?times"
    r"|repeatedly|repetitively|over and over|again and again|time and again|each time|every time"
    r"|(?:for |with |on |in )?(?:each|every) (?:step|stride|jump|direction|side|turn)s?)\b"
)
_IN_TURN = re.compile(
    r"\bone (?:[a-z]+ )?(?:after|by|then|and then) (?:an?other|the other|one)\b|\bone (?:[a-z]+ )?at a time\b"
    r"|\balternat\w+\b|\btaking turns\b|\bin turns?\b"
)
# What goes from one side to the other by itself.
_ALTERNATES = words_in(
    "walk jog march punch crawl stairs walking_lunge dance sidestep limp stagger pedal hop twist swipe throw lunge"
)
_PLURAL = re.compile(
    r"\b(?:do|does|doing|did|performs?|performing|practic\w+|makes|making) (?!a\b|an\b|one\b)(?:[a-z-]+ ){0,3}?"
    r"(?P<noun>(?:[a-z]+ )?(?:raises|lifts|kicks|lunges|squats|bows|bends|jumps|throws|reaches|swings|leans|punches))\b"
)
_ANGLE = re.compile(r"\b(\d+) ?(?:deg\w*|°)|\b(quarter|half|full) (?:turn|circle|rotation|spin)")
_MORE_ANGLE = re.compile(r"\b(?:another |then |and )(\d+|ninety)(?: deg\w*)? more\b|\banother (\d+)")
_ONE_STEP = re.compile(
    r"\bsteps? (?:one|once)\b|\bthe step(?= back| forward)|\b(?:a|an|one|single|another)(?: (?!side)[a-z]+)? step\b"
)
FULL_TURN_DEG = 360.0
_FULL_TURNS = re.compile(
    r"\b(two|three|four|five|several|multiple|few|\d+) (?:full|complete|whole|entire)"
    r" (?:turns|rotations|spins|circles|revolutions)\b"
)
_BOTH_HANDS = re.compile(r"\bboth (?:of )?(?:his |her |their |the )?(?:hands|arms)\b")
_NAMED_HAND = re.compile(r"\b(?:with|using) (?:his |her |their |the |only )*(?:left|right|one) (?:hand|arm)\b")
_WITH_BOTH = words_in("golf sweep")
_SIDES_OFTEN = re.compile(r"\b(?:left|right) and (?:then )?(?:left|right) (twice|\w+ times|repeatedly)\b")
_REVERSES = re.compile(
    r"\b(?:then|and|before) (?:reverses?|reversing|changes? directions?|switch(?:es)? directions?)\b"
)


def counts_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for repetitions and changes of direction that no step has."""
    for check in (
        _several,
        _various,
        _in_turn,
        _plural,
        _uncounted,
        _more,
        _reversed,
        _full_turns,
        _both,
        _other_hands,
    ):
        yield from check(given)


def repeats(step: Step) -> bool:
    """Whether what a step shows is done more than once, in its natural time or by its count."""
    if step.count:
        return step.count > 1
    if step.moves or step.style == "several":
        return True
    activity = BY_KEY[step.upper or step.lower]
    if activity.once:
        return False
    if activity.counted_s is None:
        return True
    _, each_s, extra_s = activity.counted_s
    return activity.natural_s >= extra_s + 1.7 * each_s


def _fills_its_time(step: Step) -> bool:
    """Whether it is an exercise of the whole body, which is repeated for as long as there is time."""
    activity = BY_KEY[step.lower]
    return activity.counted_s is not None and not activity.once


def _several(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_OFTEN):
        own = given.own(token)
        each = re.search(r"\b(?:each|every)\b", found[0])
        sides = {step.direction for step in own} | {step.hand for step in own} | {step.foot for step in own}
        again = len(own) > 1 and len({(step.lower, step.upper) for step in own}) < len(own)
        if (
            each
            and "side" in found[0]
            and {"left", "right"} <= sides | ({"left", "right"} if "both" in sides else set())
        ):
            continue
        if (each and "side" not in found[0]) or not (again or any(map(repeats, own))):
            yield token.clause, f"{found[0].strip()!r} is not shown"


def _various(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_WAYS_ABOUT):
        ways = {step.direction for step in given.own(token)} - {""}
        if len(ways) < 2 and not ways & {"pacing", "around"}:
            yield token.clause, f"{found[0].strip()!r} is not shown"


def _in_turn(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_IN_TURN):
        last = given.token_at(found.start() + found[0].rfind(" ") + 1)  # "one hand and then the other": another clause
        own = [*given.own(token), *given.own(last)]
        limbs = {step.hand for step in own if step.upper} | {step.foot for step in own}
        if {"left", "right"} <= limbs or any({step.lower, step.upper} & _ALTERNATES for step in own):
            continue
        if any(_is_one_side_after_the_other(*pair) and {*pair} & {*own} for pair in pairwise(given.steps)):
            continue
        yield token.clause, f"{found[0]!r} is not shown"


def _is_one_side_after_the_other(before: Step, step: Step) -> bool:
    """Whether a movement is done with one limb and then with that of the other side."""
    same = (before.lower, before.upper) == (step.lower, step.upper)
    return same and {"left", "right"} in ({before.hand, step.hand}, {before.foot, step.foot})


def _plural(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_PLURAL):
        own = given.own(token)
        if len(own) < 2 and not any(repeats(step) or _fills_its_time(step) for step in own):
            yield token.clause, f"{found['noun']!r} is shown once"


def _uncounted(given: Given) -> Iterator[tuple[int, str]]:
    """ "A step forward, to his left": a walk that goes on from one step, and has no number."""
    for _found, token in given.matches(_ONE_STEP):
        for step in given.steps:
            later = (
                step.lower in ("walk", "sidestep")
                and step.direction != "back"
                and not step.count
                and not step.distance_m
            )
            verbs = any(
                one.word.is_verb or one.word.is_going for one in given.tokens if one.clause in step.clauses[-1:]
            )
            is_it = token.clause in step.clauses
            if later and step.clauses and (is_it or (step.clauses[0] >= token.clause and not verbs)):
                yield max(step.clauses), "that it is one step is not kept"


def _more(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_MORE_ANGLE):
        turns = [step for step in given.steps if step.turn_deg or step.lower == "turn"]
        angles = len(_ANGLE.findall(given.text))
        if turns and len(turns) < max(angles, 2):
            yield token.clause, f"{found[0].strip()!r} is not shown"


def _reversed(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_REVERSES):
        own = given.of_clause(token.clause)
        ways = {step.direction for step in given.steps} | {step.arc_deg > 0 for step in given.steps if step.arc_deg}
        turned = any(step.lower == "turn" or step.direction in ("back", "backwards") for step in own)
        backwards = [step for step in own if step.direction == "backwards"]
        if backwards:
            yield token.clause, f"{found[0].split(' ', 1)[1]!r} is shown as {doing(backwards[0])}"
        elif not turned and len(ways - {""}) < 2:
            yield token.clause, f"{found[0].split(' ', 1)[1]!r} is not shown"


def _full_turns(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_FULL_TURNS):
        times = NUMBERS.get(found[1], 0) or int(found[1]) if found[1] in NUMBERS or found[1].isdigit() else 3
        own = given.own(token)
        turned_deg = sum(max(abs(step.turn_deg), abs(step.arc_deg)) for step in own)
        if turned_deg < times * FULL_TURN_DEG and not any(step.count >= times for step in own):
            yield token.clause, f"{found[0]!r} is not shown"


def _both(given: Given) -> Iterator[tuple[int, str]]:
    """ "Then both", and "left and right twice"."""
    for token in given.tokens:
        is_last = not given.texts(token.place + 1, token.place + 2) or given.tokens[token.place + 1].part != token.part
        own = given.of_clause(token.clause)
        if token.text == "both" and is_last and own and not any(step.upper and step.hand == "both" for step in own):
            yield token.clause, "'both' is not shown"
    for found, token in given.matches(_SIDES_OFTEN):
        counts = {step.count for step in given.steps if step.direction in ("left", "right")}
        if len(counts) > 1:
            yield token.clause, f"{found[1]!r} is shown for one side"


def _other_hands(given: Given) -> Iterator[tuple[int, str]]:
    """ "Drinks with both hands", where the activity moves one, and "swings the club with the right hand"."""
    for _, token in given.matches(_BOTH_HANDS):
        of_hands = [part for step in given.of_clause(token.clause) for part in step.each if part.upper]
        hands = [hand_of(part, part.upper) for part in of_hands]
        in_turn = {step.hand for step in given.steps if of_hands and step.upper == of_hands[0].upper}
        if len(hands) == 1 and hands[0] in ("one", "left", "right") and not in_turn >= {"left", "right"}:
            yield token.clause, "one hand is shown, not both"
    for _, token in given.matches(_NAMED_HAND):
        if any(step.upper in _WITH_BOTH for step in given.of_clause(token.clause)):
            yield token.clause, "both hands are shown, not one"
