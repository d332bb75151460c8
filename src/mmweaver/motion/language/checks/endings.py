"""What undoes or ends something, and postures that are kept: each has its step, or it is said."""

import re
from collections.abc import Iterator
from itertools import pairwise

from mmweaver.motion.language.checks.given import LINKS, Given, Token
from mmweaver.motion.language.lexicon import ARMS
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verb_steps import LEGS
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA, words_in

_UNDOING = re.compile(r"un(?:cross|fold|bend|wind|clasp|clench|twist)\w*|releas(?:es?|ing|ed)")
_PLACE = r"(?:place|spot|position|point|location|start|pose|stance|space)"
_RETURN = re.compile(
    rf"\b(?:back|returns?|returning|returned)\b[a-z ]{{0,12}}?\b(?:to|in|at|into)\b (?:[a-z']+ ){{0,3}}?{_PLACE}\b"
    r"|\b(?:back|returns?|returning) (?:to )?where\b|\bback to place\b"
    r"|\bends? (?:up )?(?:in |at |where )[a-z ]*start\w*"
)
_POSE = re.compile(r"\b(?:stand\w*|straight|upright|neutral|rest\w*)\b")  # a pose of the body, not a place
_GOES_BACK = words_in("back pacing circle")
_STOPS = words_in("stop stops stopped stopping quits quit ceases finishes")
_PUT_BACK = re.compile(
    r"\b(?:puts?|places?|sets?|lays?|brings?|puttings?)\b (?:it|them)\b[a-z ]{0,10}\b(?:down|back)\b"
)
_LOWERED_OUT = re.compile(
    r"\b(?:lower|drop|bring|com)(?:s|es|ing|ed)? [a-z ]{0,25}?"
    r"(?P<how>(?:(?:extended|stretched|outstretched|straight)(?: out)?|out|wide)"
    r"(?: (?:to|at) (?:both|the|his|her|their) sides?)?"
    r"|to both sides|sideways)\b"
)
_LOW_STATES = re.compile(
    r"\b(?:squatting|crouching|crouched|squatted|kneeling|bent over|bending over|lunging|"
    r"(?:in|into|to|on) (?:an? |his |her |their |the )?(?:deep |low |half )?(?:squat|crouch|lunge|kneel)\w*"
    r"|(?:stand|balanc|stay)(?:s|es|ing|ed)? on (?:one|his|her|their|the) (?:left |right )?(?:leg|foot))\b"
)
_KEPT = words_in("squat crouch lunge one_leg kneel kneel_down bend lean bow raise_leg")
_RISES = words_in("stand_up kneel_up get_up")
_UP = re.compile(
    r"\b(?:up|rises?|rising|stands?|standing|stood|straight\w*|upright|releases?|lowers?|jump\w*|hop\w*|leap\w*|"
    r"puts? (?:it|his|her|their|the)|steps?|walk\w*|back)\b"
)


def endings_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for ways back, endings and kept postures that no step shows."""
    for check in (_undone, _returned, _stopped, _put_back, _lowered_out, _kept):
        yield from check(given)


def _undone(given: Given) -> Iterator[tuple[int, str]]:
    for token in given.tokens:
        alone = [step for step in given.steps if step.clauses == (token.clause,)]
        shown = any(step.lower in ("stand", "stand_up") and not step.upper for step in alone)
        if _UNDOING.fullmatch(token.text) and not shown:
            yield token.clause, f"{token.text!r} is not shown"


def _returned(given: Given) -> Iterator[tuple[int, str]]:
    """The way back to where somebody was: by a walk back, or by whoever has not left the place."""
    for found, token in given.matches(_RETURN):
        clause = token.clause
        if _POSE.search(found[0]):
            continue
        if any(clause < min(step.clauses, default=0) for step in given.steps if _goes_back(step)):
            continue
        before = [step for step in given.steps if min(step.clauses, default=0) <= clause]
        gone = [i for i, step in enumerate(before) if step.moves]
        if not gone or any(map(_goes_back, before[gone[-1] + 1 :])):
            continue
        if _goes_back(before[gone[-1]]) or _comes_back(before):
            continue
        yield clause, "the way back is not shown"


def _goes_back(step: Step) -> bool:
    return step.direction in _GOES_BACK and step.moves


def _comes_back(steps: list[Step]) -> bool:
    """Whether a walk has a return of the same kind: forwards and backwards, left and right."""
    ways = [step.direction for step in steps if step.moves]
    opposite = {"forwards": "backwards", "backwards": "forwards", "left": "right", "right": "left"}
    return len(ways) > 1 and any(opposite.get(way) == ways[-1] for way in ways[:-1])


def _stopped(given: Given) -> Iterator[tuple[int, str]]:
    """ "Stops clapping" has no step that claps."""
    for token in given.tokens:
        if token.text not in _STOPS:
            continue
        for after in given.tokens[token.place + 1 : token.place + 5]:
            if after.part != token.part and after.text not in LINKS and not after.text.endswith("ing"):
                break
            if after.word.form != "ing" or not after.word.is_activity or after.word.lemma == "stand":
                continue
            activity = [key for key in ACTIVITY_OF_LEMMA[after.word.lemma] if key]
            own = [step for step in given.steps if {token.clause, after.clause} & {*step.clauses}]
            only = [step for step in own if min(step.clauses) >= token.clause]
            if any({step.lower, step.upper} & {*activity} for step in only):
                yield token.clause, f"the end of {after.text!r} is not shown"


def _put_back(given: Given) -> Iterator[tuple[int, str]]:
    """ "Lifts the hand, then places it back down": no thing is put down."""
    for _found, token in given.matches(_PUT_BACK):
        before = given.tokens[: token.place]
        objects = [
            one.text for one in before if one.text in _THINGS or (one.text in ARMS | LEGS and _is_object(given, one))
        ]
        if objects[-1:] and objects[-1] in ARMS | LEGS and any(step.lower == "put_down" for step in given.own(token)):
            yield token.clause, f"the {objects[-1]} is not lowered: a thing is put down"


def _lowered_out(given: Given) -> Iterator[tuple[int, str]]:
    """Arms that come down stretched out to the sides, which are shown as coming down in front."""
    for found, token in given.matches(_LOWERED_OUT):
        lowers = [step for step in given.own(token) if step.upper in ("raise", "raise_hold") or step.lower == "stand"]
        if lowers and not any(step.upper == "arms_out" for step in given.own(token)):
            yield token.clause, f"{found['how']!r} is not shown"


def _is_object(given: Given, limb: Token) -> bool:
    """Whether a limb is what is moved, not what something is done with."""
    return not {"with", "in", "using"} & {*given.texts(limb.place - 3, limb.place)}


_THINGS = words_in("something object objects box cup glass bottle bag item ball book plate thing phone weight")


def _kept(given: Given) -> Iterator[tuple[int, str]]:
    """Somebody in a squat or on one leg does what follows there, unless a word says that it is left."""
    for found, token in given.matches(_LOW_STATES):
        for before, after in pairwise(given.steps):
            low = token.clause in before.clauses and before.lower in _KEPT and not before.upper
            rises = after.lower in _RISES or _UP.search(given.text[found.end() :])
            if low and after.lower != before.lower and not rises and after.upper and after.posture != before.posture:
                yield max(after.clauses, default=token.clause), f"{after.name} is shown after {before.name}"
            elif (
                low
                and after.lower == "stand"
                and after.upper
                and not rises
                and before.lower not in ("kneel", "kneel_down")
            ):
                yield max(after.clauses, default=token.clause), f"{after.name} is shown standing, after {before.name}"
