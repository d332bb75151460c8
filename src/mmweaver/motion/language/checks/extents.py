"""How far, how high, how widely and with how much of the body, against the steps, which have one size each."""

import re
from collections.abc import Iterator

from mmweaver.motion.language.accounts import alike
from mmweaver.motion.language.checks.given import Given, Token
from mmweaver.motion.language.mentions import goes_to_and_fro
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import ACTIVITY_OF_LEMMA, words_in

_SLIGHTLY = re.compile(r"\b(?:slightly|somewhat|(?<!for )a (?:little )?bit(?! of)|a little(?! (?:[a-z]+ )?step))\b")
# Shown as one size of the trunk, a limb or the knees.
_OF_ONE_SIZE = words_in("bend lean squat crouch raise raise_hold raise_leg arms_out")
_SIDE_TO_SIDE = re.compile(r"\b(?:from )?side to side\b|\bfrom one side to the other\b")
_TO_THE_GROUND = re.compile(r"\b(?:to|towards?|for|on|off|from|at) (?:the )?(?:ground|floor)\b")
_INTO_THE_AIR = re.compile(r"\b(?:into|in|to|towards?|for|at) the (?:air|sky|ceiling)\b")
_NEAR_THE_GROUND = words_in("bend bow squat crouch kneel kneel_down lunge pick_up put_down sit")
_ON_FEET = words_in("walk jog sidestep limp stagger crawl leap stumble")
_WHOLE_BODY = re.compile(r"\b(?:whole|entire) body\b")
_ONE_ARM = re.compile(
    r"\b(?<!left )(?<!right )(?<!both )(?:arm|hand) (?:is |held |stretched )*(?:out|outstretched|extended|ahead)\b"
)

_ACROSS = re.compile(r"\bacross (?:the|his|her|their|its) (?:body|chest|torso|front)\b")
_CROSSING = words_in("swipe cross_arms stretch hook forehand backhand golf")
_BEHIND = re.compile(r"\bbehind (?:him|her|them|it)(?:self|selves)?\b")
_BETWEEN = re.compile(r"\bin[- ]between\b")
_IN_FRONT = re.compile(r"\bin front of (?:him|her|them|it|(?:his|her|their|the) (?:body|chest|face))(?:self|selves)?\b")
_TO_THE_BACK = words_in("open_door sit sit_down lean fall")


def extents_not_shown(given: Given) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said) for sizes, heights and ways about that the steps do not have."""
    for check in (
        _slightly, _side_to_side, _heights, _around, _whole_body, _one_arm, _across, _behind, _between, _in_front,
    ):  # fmt: skip
        yield from check(given)


def _slightly(given: Given) -> Iterator[tuple[int, str]]:
    """ "Bends slightly": shown as far as any other bend."""
    for found, token in given.matches(_SLIGHTLY):
        own = [] if token.clause in given.otherwise else given.of_clause(token.clause)
        if own and all((step.upper or step.lower) in _OF_ONE_SIZE and not step.arc_deg for step in own):
            yield token.clause, f"{found[0]!r} is not shown"


def _side_to_side(given: Given) -> Iterator[tuple[int, str]]:
    """ "Waves while stepping side to side": it is the movement named last that goes to both sides."""
    for found, token in given.matches(_SIDE_TO_SIDE):
        meant = [(key, step) for key, step in _of_the_verb_before(given, token) if key in (step.lower, step.upper)]
        alone = [goes_to_and_fro(step, key) for key, step in meant]
        if alone and not any(alone):
            yield token.clause, f"{found[0]!r} is not shown"


def _heights(given: Given) -> Iterator[tuple[int, str]]:
    """A reach is at the height of a table, or up where the clause says so."""
    for pattern, is_low in ((_TO_THE_GROUND, True), (_INTO_THE_AIR, False)):
        for found, token in given.matches(pattern):
            own = given.of_clause(token.clause)
            reaches = [step for step in own if step.upper == "reach"]
            low = any(step.lower in _NEAR_THE_GROUND or step.posture != "feet" for step in own)
            high = any(step.style == "high" for step in own)
            if reaches and not (low if is_low else high):
                yield token.clause, f"{found[0]!r} is not shown"


def _around(given: Given) -> Iterator[tuple[int, str]]:
    """ "Stumbles around" goes about, and is no single stumble."""
    for token in given.tokens:
        before = given.tokens[token.place - 1] if token.place else token
        is_about = token.text == "around" and before.word.is_activity and before.word.form != "base"
        if not is_about:
            continue
        meant = [step for key, step in _of_the_verb_before(given, token) if key == step.lower in _ON_FEET]
        if meant and not any(step.direction or step.arc_deg or step.target or step.place for step in meant):
            yield token.clause, "'around' is not shown"


def _whole_body(given: Given) -> Iterator[tuple[int, str]]:
    """ "Moves the arms and then the whole body": a movement of the hands alone is none of the body."""
    for found, token in given.matches(_WHOLE_BODY):
        own = given.own(token)
        if own and all(step.upper and step.lower in ("stand", "sit") for step in own):
            yield token.clause, f"{found[0]!r} is not shown"


def _one_arm(given: Given) -> Iterator[tuple[int, str]]:
    """ "With an arm out": arms that are held out are two where no side is named."""
    for _found, token in given.matches(_ONE_ARM):
        if any(step.upper == "arms_out" and not step.hand for step in given.of_clause(token.clause)):
            yield token.clause, "both arms are shown, not one"


def _across(given: Given) -> Iterator[tuple[int, str]]:
    """ "Reaches across the body": arms go ahead, up or to their own side."""
    for found, token in given.matches(_ACROSS):
        own = given.of_clause(token.clause)
        if own and not any({step.lower, step.upper} & _CROSSING for step in own):
            yield token.clause, f"{found[0]!r} is not shown"


def _behind(given: Given) -> Iterator[tuple[int, str]]:
    """ "Waves at someone behind him": hands move ahead of the body, unless it turns."""
    for found, token in given.matches(_BEHIND):
        own = given.of_clause(token.clause)
        aimed = any(
            step.facing or step.moves or step.lower in _TO_THE_BACK or step.upper in _TO_THE_BACK for step in own
        )
        turned = any(
            step.lower == "turn" or step.direction in ("back", "backwards") or step.style == "back" for step in own
        )
        if own and not aimed and not turned and token.clause not in given.otherwise:
            yield token.clause, f"{found[0]!r} is not shown"


def _of_the_verb_before(given: Given, token: Token) -> Iterator[tuple[str, Step]]:
    """(activity, step) of the steps that show the verb before a word, in the same part of the sentence."""
    for other in reversed(given.tokens[: token.place]):
        if other.word.is_activity and other.word.form != "base":
            lower, upper = ACTIVITY_OF_LEMMA[other.word.lemma]
            for step in given.of_clause(other.clause):
                yield from ((key, step) for key in (step.lower, step.upper) if key and alike(upper or lower, key, step))
            return
        if other.part != token.part:
            return


def _between(given: Given) -> Iterator[tuple[int, str]]:
    """Pauses in between are shown at the end."""
    for found, token in given.matches(_BETWEEN):
        yield token.clause, f"{found[0]!r} is not shown"


def _in_front(given: Given) -> Iterator[tuple[int, str]]:
    """Arms circle at the sides."""
    for found, token in given.matches(_IN_FRONT):
        own = given.of_clause(token.clause)
        if own and all(step.upper == "arm_circles" for step in own):
            yield token.clause, f"{found[0]!r} is not shown"
