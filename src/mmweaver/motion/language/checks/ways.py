"""Sides and ways, in order and as often as a sentence names them, against those of the steps."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from mmweaver.motion.language.accounts import OF_A_LIMB, has_way
from mmweaver.motion.language.checks.given import Given, Token
from mmweaver.motion.language.checks.matching import not_shown_as_often, out_of_order
from mmweaver.motion.language.checks.movements import says_its_order
from mmweaver.motion.language.coverage import goes_aside, goes_back
from mmweaver.motion.language.lexicon import ARMS
from mmweaver.motion.language.mentions import BOTH_SIDES, moves_limb
from mmweaver.motion.language.named_steps import in_turn
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verb_steps import LEGS
from mmweaver.motion.language.verbs import words_in

_AHEAD, _BACK = words_in("forward forwards ahead"), words_in("backward backwards back")
_SIDES = re.compile(r"(left|right)(?:wards?)?")
_NO_WAY_AFTER = words_in("after before now there in hand handed foot footed")
_OF_ITS_OWN = words_in("his her their its the of lower upper on")  # "his back", "lies on back"
_BEFORE_SIDES = words_in("the his her their its to towards and")
_GOING = words_in("going walking moving stepping jogging running")
_NOT_BACKWARDS = words_in("up down and to in into of at out together")
_RETURNS = words_in("turn turns turning turned look looks looking comes goes")
_TO_AND_FRO = words_in("circle pacing")
_MANY = 4  # mentions that a step shows which goes to and fro


@dataclass(frozen=True)
class _Mention:
    token: Token
    way: str  # left | right | ahead | back

    def is_shown_by(self, step: Step) -> bool:
        if self.way in ("left", "right"):
            to_both = bool({step.lower, step.upper} & BOTH_SIDES) and not step.direction
            return to_both or goes_aside(step) or self.way in (step.hand, step.foot) or "both" in (step.hand, step.foot)
        return has_way(step, self.token.text) if self.way == "ahead" else goes_back(step)


def ways_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for ways and sides that are named more often than they are shown."""
    mentions = list(_mentions(given))
    slots = _slots(given, mentions)
    words, ways = [one.token.text for one in mentions], [one.way for one in mentions]
    for i, how in not_shown_as_often(words, ways, slots):
        yield mentions[i].token.clause, how
    late = out_of_order(len(mentions), slots)
    if late is not None and not says_its_order(given):
        yield mentions[late].token.clause, f"the order shown is {in_turn(given.steps)}"
    yield from _limbs_in_turn(given)


def _slots(given: Given, mentions: list[_Mention]) -> list[list[frozenset[int]]]:
    """Of each step, the mentions that it can show: one side and one way ahead or back; more of what goes to and fro."""
    own = [[step for step in given.steps if _is_own(one, step)] or given.steps for one in mentions]
    slots = []
    for step in given.steps:
        fitting = frozenset(i for i, one in enumerate(mentions) if step in own[i] and one.is_shown_by(step))
        aside = frozenset(i for i in fitting if mentions[i].way in ("left", "right"))
        to_both = bool({step.lower, step.upper} & BOTH_SIDES) and not step.direction
        again = (to_both or step.count > 1) and step.lower not in ("walk", "sidestep")
        slots.append([aside, fitting - aside] * (_MANY if again or step.direction in _TO_AND_FRO else 1))
    return slots


def _is_own(mention: _Mention, step: Step) -> bool:
    return mention.token.clause in step.clauses and mention.is_shown_by(step)


def _mentions(given: Given) -> Iterator[_Mention]:
    last: _Mention | None = None
    for token in given.tokens:
        way = _way_of(given, token)
        if not way:
            continue
        one = _Mention(token, way)
        if last is not None and last.way == way and last.token.part == token.part:
            continue
        yield one
        last = one


def _way_of(given: Given, token: Token) -> str:
    """Which way a word says that somebody goes, or "" as in "his left hand", "turns back" and "right after"."""
    before, after = given.texts(token.place - 3, token.place), given.texts(token.place + 1, token.place + 3)
    is_adverb = bool(after) and after[0] in _NO_WAY_AFTER and not {*before[-1:]} & _BEFORE_SIDES  # "right after that"
    if token.place in given.compared or is_adverb or _is_meanwhile(given, token):
        return ""
    side = _SIDES.fullmatch(token.text)
    if side:
        return "" if _is_no_side(given, token, before, after) else side[1]
    if token.text in _AHEAD:
        of_the_arms = bool(before) and before[-1] in ARMS
        return "" if of_the_arms or (after[:1] == ["and"] and {*after} & _BACK) else "ahead"
    if token.text in _BACK:
        is_noun = bool(before) and before[-1] in _OF_ITS_OWN
        is_elsewhere = bool(after) and after[0] in _NOT_BACKWARDS
        is_pair = before[-1:] == ["and"] and {*before} & _AHEAD
        returns = bool(before) and before[-1] in _RETURNS
        return "" if is_noun or is_elsewhere or is_pair or returns else "back"
    return ""


def _is_meanwhile(given: Given, token: Token) -> bool:
    """Whether a part only says what goes on: "while going forward, ..."."""
    part = [one.text for one in given.tokens if one.part == token.part]
    return part[0] in ("while", "and") and "while" in part[:2] and bool(_GOING & {*part})


def _is_no_side(given: Given, token: Token, before: list[str], after: list[str]) -> bool:
    """Whether a side is that of a limb, or one of a pair: "from left to right", "left and right"."""
    near = {*given.texts(token.place + 2, token.place + 5)}
    is_swept = "from" in before or ("to" in after and near & {"left", "right"})
    is_pair = after[:1] == ["and"] and after[1:] in (["left"], ["right"])
    return bool(is_swept or is_pair or (OF_A_LIMB - {"shoulder"}) & {*after} or {"face", "faces"} & {*before})


def _is_aim_of_a_limb(given: Given, token: Token) -> bool:
    """Whether a limb is what another one goes to: "lifts the left foot up to his right knee"."""
    before = given.texts(token.place - 6, token.place)
    before = before[:-1] if before[-1:] and before[-1] in _OF_ITS_OWN else before
    limb = [text for text in before[:-1] if text not in ("up", "over")][-1:]
    return before[-1:] == ["to"] and "from" not in before and bool(limb) and limb[0] in ARMS | LEGS


def _limbs_in_turn(given: Given) -> Iterator[tuple[int, str]]:
    """Hands or feet of both sides that are named in turn, more often than the steps change sides."""
    named: list[tuple[Token, str, bool]] = []
    for token in given.tokens:
        after = given.texts(token.place + 1, token.place + 3)
        limb = next((text for text in after if text in ARMS | LEGS), "")
        if token.text not in ("left", "right") or not limb or _is_aim_of_a_limb(given, token):
            continue
        one = (token, token.text, limb in ARMS)
        if not named or named[-1][1:] != one[1:]:
            named.append(one)
    slots = [
        [frozenset(i for i, (_, side, is_hand) in enumerate(named) if moves_limb(step, side, is_hand=is_hand))] * _MANY
        for step in given.steps
    ]
    late = out_of_order(len(named), slots)
    if late is None or {"after", "before", "with"} & {token.text for token in given.tokens}:
        return
    token, side, is_hand = named[late]
    yield token.clause, f"that the {side} {'hand' if is_hand else 'leg'} comes then is not shown"
