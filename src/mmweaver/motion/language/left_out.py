"""Phrases and clauses that are left out, and said: how something is done in ways that the library cannot show.

Tried last, where a sentence is not understood otherwise. What the person does must remain; only how, with what, on what
or looking like what may go ("walks over a beam", "stands up, using a hand as support").
"""

import re
from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import words_in
from mmweaver.motion.language.approximations import MARK
from mmweaver.motion.language.clause_parser import is_known, parse_clause
from mmweaver.motion.language.clauses import Clause
from mmweaver.motion.language.lexicon import (
    ARMS,
    LEGS,
    MANY,
    NEGATIONS,
    NOT_HUMAN,
    NOUNS_LIKE_VERBS,
    OTHER_MOVEMENT,
    PRONOUNS,
    SEATS,
    TARGETS,
    WHOLE_BODY,
)
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.places import MARK as PLACE
from mmweaver.motion.language.plan import NOT_DONE, ClauseRecord, Step
from mmweaver.motion.language.words import Word

# How much of a sentence may be left: nothing, phrases that only say how, clauses, and what only a rough reading keeps.
EXACT, LEAVING_OUT, MISSING, ROUGH = range(4)
# Words that begin a phrase which says how.
_OPENING = words_in(
    """
    like as with without using over through across along on onto against in into by of from at for during under
    behind between near while having showing being holding looking due
    """
)
_TO_THE_END = words_in("like as without using while having showing being holding looking due")
_DIRECTIONS = words_in("left right forwards backwards forward backward in_circle towards away sideways")
# Movements of the whole body that no other may stand for.
_WHOLE_BODY = MANY | NOT_HUMAN | WHOLE_BODY
_HOW = words_in("with without using by because since that which where like as if for in showing supported")
_BEFORE_HOW = words_in("and then thereby always a bit little maybe perhaps possibly quite almost kind of")
_SUBJECTS = PRONOUNS | words_in("person man woman human user guy girl boy subject figure")
_MOST_PHRASES = 2


def parse_with_less(clause: Clause, *, is_first: bool) -> ParsedClause:
    """As `parse_clause`, but what only says how is left out where it is not known, which the clause's record says.

    Raises InputError if no movement would remain; `is_first`: no clause before has one.
    """
    words = list(clause.words)  # parse_clause takes places and tokens away
    try:
        parsed = parse_clause(clause)
    except InputError:
        parsed = None
    if parsed is not None and (parsed.steps or not parsed.unknown):
        return parsed
    for kept, cut in _cuts(words):
        try:
            shorter = parse_clause(Clause(clause.link, kept, clause.number))
        except InputError:
            continue
        if any(step.upper or step.lower != "stand" for step in shorter.steps):
            shorter.text = clause.text
            for phrase in cut:
                shorter.approximations.append(f"{shown(phrase)!r} is not shown")
            return shorter
    if not is_first and _only_says_how(clause):
        parsed = ParsedClause(clause.link, clause.text, number=clause.number)
        parsed.approximations.append(f"{clause.text!r} is not shown")
        return parsed
    return parse_clause(Clause(clause.link, words, clause.number))


def may_be_missed(clause: Clause) -> bool:
    """Whether a clause that is not understood may be recorded as not done, where the others are understood.

    Not where it is about several people or animals, says what is not done, or names a movement of the whole body.
    """
    return not {word.text for word in clause.words} & (_WHOLE_BODY | NEGATIONS)


def says_more_of(missed: Clause, clause: Clause) -> bool:
    """Whether it only goes on with one that is not understood: 'the arm comes over, then goes back', 'and back'."""
    verb = next((word for word in clause.words if word.is_activity or word.is_going), None)
    if verb is None:
        return True
    own_subject = {word.text for word in clause.words[: clause.words.index(verb)]} & _SUBJECTS
    limb = {word.text for word in missed.words[:4]} & (ARMS | LEGS) and not _SUBJECTS & {
        w.text for w in missed.words[:4]
    }
    return not own_subject and bool(limb or (clause.link == "and" and verb.form == "past"))


def _only_says_how(clause: Clause) -> bool:
    """Whether a clause without a known movement is about how the one before is done."""
    first = next((word for word in clause.words if word.text not in _BEFORE_HOW), None)
    if first is None or {word.text for word in clause.words} & _WHOLE_BODY:
        return False
    participle = not first.is_activity and first.text.endswith(("ing", "ed")) and first.text not in NOUNS_LIKE_VERBS
    return participle or first.text in _HOW or (clause.link == "while" and not any(w.is_activity for w in clause.words))


def shown(words: list[Word]) -> str:
    """Words as a message names them, without tokens of their own."""
    texts = [re.sub(r"^(?:arc|deg)(\d+)$", r"\1 degrees", word.text) for word in words]
    return " ".join(text for text in texts if not text.startswith((MARK, PLACE))).replace("_", " ")


def is_odd(word: Word) -> bool:
    """Whether a word is not known, or may mean another movement."""
    return word.text in OTHER_MOVEMENT or word.text in NEGATIONS or (not is_known(word) and word.text[:1].isalpha())


def _cuts(words: list[Word]) -> Iterator[tuple[list[Word], list[list[Word]]]]:
    """(words kept, phrases cut) with one phrase cut, then two; each phrase has a word that is not known."""
    verb = next((i for i, word in enumerate(words) if word.is_activity or word.is_going), None)
    if verb is None:
        return
    phrases = [span for span in _phrases(words, verb) if _may_go(words[span[0] : span[1]])]
    early = [(i, i + 1) for i in range(verb) if is_odd(words[i]) and words[i].text not in _OPENING]
    late = [(i, i + 1) for i in range(verb + 1, len(words)) if is_odd(words[i]) and words[i].text.endswith("ly")]
    for count in range(1, _MOST_PHRASES + 1):
        for chosen in combinations((*phrases, *late, *early), count):
            gone = {i for start, end in chosen for i in range(start, end)}
            if any(words[i].text in _WHOLE_BODY for i in gone):
                continue
            kept = [word for i, word in enumerate(words) if i not in gone]
            yield kept, [words[start:end] for start, end in sorted(chosen)]


def _may_go(words: list[Word]) -> bool:
    """Whether a phrase has a word that is not known, and no direction, movement or furniture."""
    directed = any(
        word.text in _DIRECTIONS and not ARMS & {w.text for w in words[i + 1 : i + 3]} for i, word in enumerate(words)
    )
    acted = words[0].text not in ("like", "as") and any(word.is_activity for word in words)
    placed = any(word.text in TARGETS or word.text in SEATS for word in words)
    return len(words) > 1 and not (directed or acted or placed) and any(is_odd(word) for word in words)


def _phrases(words: list[Word], verb: int) -> list[tuple[int, int]]:
    """(start, end) of what each opening word after the verb begins: up to the clause's end, and up to the next one."""
    starts = [i for i in range(verb + 1, len(words)) if words[i].text in _OPENING]
    near = [(i, j) for i, j in pairwise([*starts, len(words)]) if words[i].text not in _TO_THE_END]
    return list(dict.fromkeys([*((start, len(words)) for start in reversed(starts)), *reversed(near)]))


def follows_another(first: Step, every_clause: list[ParsedClause], records: Mapping[int, ClauseRecord]) -> bool:
    """Whether the first step comes "then", or after a clause that is not shown, in words that begin it."""
    clause = next((one for one in every_clause if one.steps and one.number in first.clauses), None)
    if clause is None or clause.form == "ing" or not clause.number:
        return False
    not_shown = any(records[number].status == NOT_DONE for number in records if number < clause.number)
    return clause.link == "then" or (clause.link in ("and", "comma") and not_shown)
