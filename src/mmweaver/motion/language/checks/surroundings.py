"""Ways over, around and up something, and of the arms, which the movements of the library do not go."""

import re
from collections.abc import Iterator

from mmweaver.motion.language.checks.given import Given
from mmweaver.motion.language.named_steps import doing
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import words_in

_TURNED_ARMS = re.compile(
    r"\b(spin\w*|rotat\w+|turn\w*|circl\w+) (?:(?:the|his|her|their|both|left|right) )*(?:arms?|hands?|wrists?)\b"
)
_ON_GROUND = words_in("jump leap hop walk sidestep jog hop_one_leg march")
_OVER = re.compile(
    r"\b(?:jump|step|hop|leap|climb|walk|run|jog|get|skip|go)\w* (?:[a-z]+ )??"
    r"(?P<said>(?:down |up )?(?:off|onto|over|under|through)"
    r"(?! to\b| it\b| there\b| and\b| towards\b| his\b| her\b| their\b)(?: of)?(?: [a-z]+){1,2})"
)
_STEPS_UP = re.compile(r"\bstep(?:s|ping|ped)? (?:up|down)\b(?! to\b)")
_AROUND = re.compile(
    r"\baround (?:it|him|her|them|an? [a-z]+|the (?!room|place|house|kitchen|area|floor|world)[a-z]+)\b"
)
_ARMS_AHEAD = re.compile(r"\b(?:arms?|hands?) (?:[a-z]+ ){0,2}?(?:forwards?|ahead|in front|to the front)\b")
_HELD = r"(?:straight |held |stretched )?"
_TWO_ARMS = re.compile(
    rf"\b(?:left|right) (?:arm|hand) {_HELD}(?P<way>out|up|down|forwards?|back|behind|to the side)\b"
    r"[a-z ]*?(?:\band\b|,|\bwhile\b)[a-z ]*? ?"
    rf"(?:left|right) (?:arm|hand) {_HELD}(?P<other>out|up|down|forwards?|back|behind|to the side)\b"
)


def special_ways_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for ways that are shown on level ground, or by the body for the arms."""
    for check in (_two_arms, _turned_arms, _over_something, _up_or_down, _around_something, _arms_ahead):
        yield from check(given)


def _two_arms(given: Given) -> Iterator[tuple[int, str]]:
    """ "The left arm out and the right arm forward": each arm has its way."""
    found = _TWO_ARMS.search(given.text)
    alike = any(step.hand == "both" and step.other_hand is None for step in given.steps)
    if found and found["way"] != found["other"] and alike:
        yield given.token_at(found.start()).clause, "both arms are shown alike"


def _turned_arms(given: Given) -> Iterator[tuple[int, str]]:
    """ "Spins the arms" turns no body."""
    for found, token in given.matches(_TURNED_ARMS):
        clause = token.clause
        own = [step for step in given.steps if clause in step.clauses]
        if any(step.lower == "turn" for step in own) and not any(step.upper for step in own):
            yield clause, f"{found[0]!r} is shown as turning the body"


def _over_something(given: Given) -> Iterator[tuple[int, str]]:
    """ "Jumps off something", "steps over a log": the movement is shown on level ground."""
    for found, token in given.matches(_OVER):
        clause = token.clause
        own = [step for step in given.steps if clause in step.clauses]
        on_ground = [step for step in own if step.lower in _ON_GROUND and not _goes_somewhere(step)]
        if on_ground:
            yield clause, f"{found['said'].strip()!r} is not shown"


def _goes_somewhere(step: Step) -> bool:
    return bool(step.target or step.place or step.seat or step.arc_deg or step.direction == "circle")


def _up_or_down(given: Given) -> Iterator[tuple[int, str]]:
    """ "Steps up, then steps down": a walk goes neither up nor down."""
    for found, token in given.matches(_STEPS_UP):
        clause = token.clause
        own = [step for step in given.steps if clause in step.clauses]
        if own and all(step.lower in ("walk", "sidestep") for step in own):
            yield clause, f"{found[0]!r} is shown on level ground"


def _around_something(given: Given) -> Iterator[tuple[int, str]]:
    for found, token in given.matches(_AROUND):
        clause = token.clause
        own = [step for step in given.steps if clause in step.clauses and step.moves]
        if own and all(step.direction in ("pacing", "") and step.place is None and not step.arc_deg for step in own):
            yield clause, f"{found[0]!r} is shown as {doing(own[0])}"


def _arms_ahead(given: Given) -> Iterator[tuple[int, str]]:
    """Arms that are held ahead of a body that goes are held to the sides."""
    for found, token in given.matches(_ARMS_AHEAD):
        own = [step for step in given.steps if step.upper == "arms_out"]
        if own and not any(step.arms_ahead for step in own):
            yield token.clause, f"{found[0]!r} is shown as arms to the sides"
