"""Clauses that nothing else reads, tried last: with their known words alone, or as a movement of the limb they name.

What is acted out then is the nearest that the library has, and the clause's record says that nothing else is shown.
"""

import re
from dataclasses import replace

from mmweaver.core.errors import InputError
from mmweaver.motion.language.activities import words_in
from mmweaver.motion.language.clause_parser import parse_clause
from mmweaver.motion.language.clauses import Clause
from mmweaver.motion.language.left_out import is_odd, shown
from mmweaver.motion.language.lexicon import ARMS
from mmweaver.motion.language.parsed_clause import ParsedClause
from mmweaver.motion.language.plan import Step
from mmweaver.motion.language.words import Word

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
    """What a clause is shown as that is not understood; None where it names no known movement and no limb."""
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
    step, how = _of_a_limb(clause)
    if step is None:
        return None
    rough = ParsedClause(clause.link, clause.text, number=clause.number, words=list(clause.words), form="s")
    rough.steps, rough.forms = [replace(step, clause=clause.text, clauses=(clause.number,))], ["s"]
    rough.approximations.append(how)
    return rough


def _of_a_limb(clause: Clause) -> tuple[Step | None, str]:
    """The step that stands for what arms, legs or hands do in a clause, and how that is said."""
    texts, side = {word.text for word in clause.words}, _side_of(clause.words)
    raises = any(word.lemma in _RAISING for word in clause.words)
    hand = side or ("both" if texts & _TWO else "")
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


def _side_of(words: list[Word]) -> str:
    sides = {word.text for word in words} & {"left", "right"}
    return "both" if len(sides) == 2 else next(iter(sides), "")
