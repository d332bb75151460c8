"""Participles whose movement is shown after the one that they go with: "walks forward dribbling a ball"."""

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.verbs import words_in
from mmweaver.motion.language.words import word_of

_TOKEN = re.compile(r"[a-z]+|[,;]")
# An "ing" after one of these is a noun, the main verb, or what follows in time.
_NOT_MEANWHILE = words_in(
    """
    a an the is are was were be been being and or then after before of for to by from in into on with without like if
    his her their its this that start starts started starting begin begins began beginning stop stops stopped stopping
    keep keeps kept keeping continue continues continued continuing finish finishes finished resume resumes go goes
    """
)
_BE = words_in("is are was were")
_NO_PARTICIPLES = words_in("during string spring nothing something anything swing bring thing being sling facing")
_LINKING = words_in("while whilst as when and")
_IN_TURN = words_in("turn stand stumble fall stand_up sit_down get_up pick_up put_down open_door")


def shown_in_turn(
    every_clause: Sequence[ParsedClause], own_words: dict[int, str], steps: Sequence[Step]
) -> Iterator[tuple[int, str]]:
    """(number of the clause, what is said of it) for participles whose step comes after that of the verb before.

    `own_words`: the sentence's own words of each clause by its number.
    """
    links = {parsed.number: parsed.link for parsed in every_clause}
    last = max(links, default=0)
    for before, step in pairwise([step for step in steps if step.clauses]):
        earlier, number = max(before.clauses), min(step.clauses)
        dances = _turns_in_a_dance(before, step)
        if not (dances or _could_be_at_once(before, step)):
            continue
        tokens, tokens_before = (_TOKEN.findall(own_words.get(n, "").lower()) for n in (number, earlier))
        if dances:
            is_linked = links.get(number, "") in ("and", "comma", "while")
            said = earlier == number or (is_linked and (step.lower == "turn" or _begins_with_participle(tokens)))
        elif earlier == number:
            said = _has_participle(tokens)
        else:
            said = _begins_with_participle(tokens) and _goes_with(links.get(number, ""), tokens_before, number == last)
        if said:
            yield number, f"{before.name} and {step.name} are shown one after the other"


def _turns_in_a_dance(before: Step, step: Step) -> bool:
    """Whether somebody dances and turns or walks, which is one movement unless "then" stands between."""
    pair = (before, step) if before.lower == "dance" else (step, before)
    return pair[0].lower == "dance" and (pair[1].lower == "turn" or pair[1].moves)


def _could_be_at_once(before: Step, step: Step) -> bool:
    """Whether a movement may be meant during the one before: it is on the spot, and ends in the same posture."""
    on_the_spot = bool(step.upper) or not (step.moves or step.lower in _IN_TURN)
    acts = before.lower != "stand" or bool(before.upper)
    ends = BY_KEY[before.lower].once or before.lower in _IN_TURN
    return on_the_spot and acts and not ends and before.posture == step.posture and before.lower != step.lower


def _has_participle(tokens: list[str]) -> bool:
    """Whether a participle follows a verb in the same clause."""
    verbs = [i for i, token in enumerate(tokens) if word_of(token).is_verb]
    return any(
        _is_participle(token) and tokens[i - 1] not in _NOT_MEANWHILE
        for i, token in enumerate(tokens)
        if verbs and i > verbs[0]
    )


def _begins_with_participle(tokens: list[str]) -> bool:
    while tokens and tokens[0] in _LINKING:
        tokens = tokens[1:]
    return bool(tokens) and _is_participle(tokens[0])


def _goes_with(link: str, before: list[str], is_last: bool) -> bool:
    """Whether a clause that begins with a participle describes the clause before, by their link."""
    progressive = bool(_BE & {*before}) or _begins_with_participle(before)
    if link == "and":  # "dances waving the arms and kicking", not "is walking and kicking"
        return not progressive and _has_participle(before)
    return link == "while" or (link == "comma" and (is_last or not progressive))


def _is_participle(token: str) -> bool:
    return token.endswith("ing") and len(token) > 4 and token not in _NO_PARTICIPLES
