"""Fallbacks for clauses that are not understood: dropped phrases, skipped clauses, rough parsing; all are reported."""

import re
from collections.abc import Iterator
from dataclasses import replace
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
from mmweaver.motion.language.plan import Hand, Step
from mmweaver.motion.language.words import Word

# What may be dropped: nothing, phrases of manner, whole clauses, and all but a rough reading.
EXACT, LEAVING_OUT, MISSING, ROUGH = range(4)
# Words that begin a phrase of manner.
_OPENING = words_in(
    """
    like as with without using over through across along on onto against in into by of from at for during under
    behind between near while having showing being holding looking due
    """
)
_TO_THE_END = words_in("like as without using while having showing being holding looking due")
_DIRECTIONS = words_in("left right forwards backwards forward backward in_circle towards away sideways")
# Whole-body movements, which no other may replace.
_WHOLE_BODY = MANY | NOT_HUMAN | WHOLE_BODY
_HOW = words_in("with without using by because since that which where like as if for in showing supported")
_BEFORE_HOW = words_in("and then thereby always a bit little maybe perhaps possibly quite almost kind of")
_SUBJECTS = PRONOUNS | words_in("person man woman human user guy girl boy subject figure")
_MAX_CUTS = 2


def parse_with_less(clause: Clause, *, is_first: bool) -> ParsedClause:
    """As `parse_clause`, but drops unknown phrases of manner, which the clause's record reports.

    Args:
        clause: The clause.
        is_first: Whether no previous clause has a movement.

    Raises:
        InputError: If no movement would remain.
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
    """Whether a clause that is not understood may be recorded as not done, if the others are understood.

    Not if it concerns several people or animals, negates, or names a movement of the whole body.

    Args:
        clause: The clause.
    """
    return not {word.text for word in clause.words} & (_WHOLE_BODY | NEGATIONS)


def says_more_of(missed: Clause, clause: Clause) -> bool:
    """Whether a clause only continues one that is not understood: 'the arm comes over, then goes back', 'and back'.

    Args:
        missed: The clause that is not understood.
        clause: The next clause.
    """
    verb = next((word for word in clause.words if word.is_activity or word.is_going), None)
    if verb is None:
        return True
    own_subject = {word.text for word in clause.words[: clause.words.index(verb)]} & _SUBJECTS
    limb = {word.text for word in missed.words[:4]} & (ARMS | LEGS) and not _SUBJECTS & {
        w.text for w in missed.words[:4]
    }
    return not own_subject and bool(limb or (clause.link == "and" and verb.form == "past"))


def _only_says_how(clause: Clause) -> bool:
    """Whether a clause without a known movement describes the manner of the previous one."""
    first = next((word for word in clause.words if word.text not in _BEFORE_HOW), None)
    if first is None or {word.text for word in clause.words} & _WHOLE_BODY:
        return False
    participle = not first.is_activity and first.text.endswith(("ing", "ed")) and first.text not in NOUNS_LIKE_VERBS
    return participle or first.text in _HOW or (clause.link == "while" and not any(w.is_activity for w in clause.words))


def shown(words: list[Word]) -> str:
    """Words as quoted in messages, without internal tokens."""
    texts = [re.sub(r"^(?:arc|deg)(\d+)$", r"\1 degrees", word.text) for word in words]
    return " ".join(text for text in texts if not text.startswith((MARK, PLACE))).replace("_", " ")


def is_odd(word: Word) -> bool:
    """Whether a word is unknown, or may name another movement."""
    return word.text in OTHER_MOVEMENT or word.text in NEGATIONS or (not is_known(word) and word.text[:1].isalpha())


def _cuts(words: list[Word]) -> Iterator[tuple[list[Word], list[list[Word]]]]:
    """Pairs (words kept, phrases cut) with one phrase cut, then two; each phrase has an unknown word."""
    verb = next((i for i, word in enumerate(words) if word.is_activity or word.is_going), None)
    if verb is None:
        return
    phrases = [span for span in _phrases(words, verb) if _may_go(words[span[0] : span[1]])]
    early = [(i, i + 1) for i in range(verb) if is_odd(words[i]) and words[i].text not in _OPENING]
    late = [(i, i + 1) for i in range(verb + 1, len(words)) if is_odd(words[i]) and words[i].text.endswith("ly")]
    for count in range(1, _MAX_CUTS + 1):
        for chosen in combinations((*phrases, *late, *early), count):
            gone = {i for start, end in chosen for i in range(start, end)}
            if any(words[i].text in _WHOLE_BODY for i in gone):
                continue
            kept = [word for i, word in enumerate(words) if i not in gone]
            yield kept, [words[start:end] for start, end in sorted(chosen)]


def _may_go(words: list[Word]) -> bool:
    """Whether a phrase has an unknown word, and no direction, movement or furniture."""
    directed = any(
        word.text in _DIRECTIONS and not ARMS & {w.text for w in words[i + 1 : i + 3]} for i, word in enumerate(words)
    )
    acted = words[0].text not in ("like", "as") and any(word.is_activity for word in words)
    placed = any(word.text in TARGETS or word.text in SEATS for word in words)
    return len(words) > 1 and not (directed or acted or placed) and any(is_odd(word) for word in words)


def _phrases(words: list[Word], verb: int) -> list[tuple[int, int]]:
    """Pairs (start, end) of the phrases after the verb: up to the clause's end, and up to the next opening word."""
    starts = [i for i in range(verb + 1, len(words)) if words[i].text in _OPENING]
    near = [(i, j) for i, j in pairwise([*starts, len(words)]) if words[i].text not in _TO_THE_END]
    return list(dict.fromkeys([*((start, len(words)) for start in reversed(starts)), *reversed(near)]))


_ARMS = ARMS | words_in("forearm forearms elbow elbows finger fingers knuckles")
_TWO = words_in("hands arms fists both palms forearms elbows")
_HIGH = words_in("up upwards upward above overhead air raised high sky mid-air midair higher")
_APART = words_in("out outward outwards apart sides sideways spread wide extended outstretched stretched")
_BEFORE_THE_BODY = words_in("face head chest chin mouth front near forward forwards ahead together eyes")
_HELD = words_in("hold holds holding held keep keeps keeping kept has have having remain remains rest rests")
_RAISING = ("raise", "lift")
_IN_PLACE = (*_RAISING, "face", "stand", "stay", "remain")
_OWN = r"(?:(?:the|his|her|their|its|both|one|a|left|right) )+"
_MOVES_A_LEG = re.compile(
    rf"\b(?!look|kneel|clos|bend|bent)[a-z]+(?:s|ing|ed) {_OWN}(?:legs?|foot|feet|knees?|thighs?)\b"
)
_HANDLES = re.compile(
    r"\b(?:mov|handl|manipulat|twist|plac|put|sett?|grabb?|slic|adjust|bring|hand|tak|shift|swap|straighten)"
    r"(?:e?s|ing|ed) (?:(?:an?|the|some) (?:[a-z]+ ){0,2})?(?:it|them|something|objects?|things?|items?|box)\b"
)


def read_roughly(clause: Clause) -> ParsedClause | None:
    """Approximates a clause that is not understood by its known words or its limbs.

    Args:
        clause: The clause.

    Returns:
        The approximation, with its report; None if the clause names no known movement and no limb.
    """
    unclear = [word for word in clause.words if word.lemma in _RAISING and word.form == "past"]  # "with one raised"
    dropped = [word for word in clause.words if is_odd(word) or word in unclear]
    known = [word for word in clause.words if word not in dropped]
    if dropped and any(word.is_activity for word in known):
        try:
            parsed = parse_clause(Clause(clause.link, known, clause.number))
        except InputError:
            parsed = None
        if parsed is not None and any(step.upper or step.lower != "stand" for step in parsed.steps):
            parsed.text = clause.text
            parsed.approximations.append(f"{shown(dropped)!r} is not shown")
            return parsed
    if any(word.is_activity and word.lemma not in _IN_PLACE for word in clause.words):
        return None
    step, how = _limb_step(clause)
    if step is None:
        return None
    rough = ParsedClause(clause.link, clause.text, number=clause.number, words=list(clause.words), form="s")
    rough.steps, rough.forms = [replace(step, clause=clause.text, clauses=(clause.number,))], ["s"]
    rough.approximations.append(how)
    return rough


def _limb_step(clause: Clause) -> tuple[Step | None, str]:
    """Step that stands for the action of arms, legs or hands in a clause, and its report."""
    texts, side = {word.text for word in clause.words}, _side_of(clause.words)
    raises = any(word.lemma in _RAISING for word in clause.words)
    hand: Hand = side or ("both" if texts & _TWO else "")
    if texts & _ARMS or (raises and side):
        if texts & _HIGH or raises:
            return Step(upper="raise", hand=hand), "only what the arms do is shown, as raising them"
        if texts & _APART:
            return Step(upper="arms_out", hand=hand or "both"), "only what the arms do is shown, as holding them out"
        if texts & _BEFORE_THE_BODY:
            return Step(upper="hands_up"), "only what the hands do is shown, as holding them up in front of the body"
        if texts & _HELD or "on" in texts:
            return Step(), "only that somebody stands is shown"
        return Step(upper="wave", hand=hand), "only what the arms do is shown, as waving"
    if _MOVES_A_LEG.search(clause.text):
        foot = "" if side == "both" else side
        return Step(lower="raise_leg", foot=foot), "only what the legs do is shown, as raising a leg"
    if raises:
        return Step(lower="pick_up"), "lifting it is shown as picking something up"
    if _HANDLES.search(clause.text):
        return Step(upper="reach"), "what is done with it is shown as reaching out with a hand"
    return None, ""


def _side_of(words: list[Word]) -> Hand:
    texts = {word.text for word in words}
    left, right = "left" in texts, "right" in texts
    return "both" if left and right else "left" if left else "right" if right else ""
