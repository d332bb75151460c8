"""Splits a sentence into clauses, each with its temporal relation to the previous one."""

import re
from dataclasses import dataclass, field

from mmweaver.motion.language.approximations import MARK
from mmweaver.motion.language.lexicon import MANY, PRONOUNS
from mmweaver.motion.language.places import MARK as PLACE
from mmweaver.motion.language.places import place_of
from mmweaver.motion.language.words import Word

STOPS = frozenset({".", ";", "!", "?", ":"})
THEN = frozenset({"then", "but"})
WHILE = frozenset({"while", "whilst", "at_once"})
SUBJECTS = PRONOUNS | MANY | {"the", "a", "person", "man", "woman", "user", "his", "her", "their"}


@dataclass
class Clause:
    """Words between two connectives.

    Attributes:
        link: Relation to the previous clause: first, then, and, comma, before, after, while.
        words: Words of the clause.
        number: Position in the sentence's own order.
    """

    link: str
    words: list[Word] = field(default_factory=list)
    number: int = 0

    @property
    def text(self) -> str:
        shown = [word.text for word in self.words if not word.text.startswith(MARK)]
        shown = [place_of(text).words if text.startswith(PLACE) else text for text in shown]
        text = " ".join(shown).replace("_", " ")
        return re.sub(r"\b(?:arc|deg)(\d+)", r"\1 degrees", text)


def split_clauses(words: list[Word]) -> list[Clause]:
    """Splits words at connectives and orders the clauses in time ("Before B, A" and "B after A" are reordered).

    Args:
        words: Words of the sentence.

    Returns:
        Clauses in temporal order, numbered in the sentence's order.
    """
    clauses = _split(words)
    for number, clause in enumerate(clauses):
        clause.number = number
    return _temporal_order(clauses)


def _split(words: list[Word]) -> list[Clause]:
    clauses = [Clause("first")]
    for i, word in enumerate(words):
        link = _link(words, i)
        if not link:
            clauses[-1].words.append(word)
        elif clauses[-1].words:
            clauses.append(Clause("after" if link == "when" else link))
        else:  # several connectives in a row: ", and then" is then; ", while" is while
            clauses[-1].link = _stronger(clauses[-1].link, link)
    if not clauses[-1].words:
        if len(clauses) > 1 and clauses[-1].link == "while":  # "... at the same time": joins the last two
            clauses[-2].link = "while" if len(clauses) > 2 else clauses[-2].link
        clauses.pop()
    return clauses


def _link(words: list[Word], i: int) -> str:
    """The connective that word `i` represents in its context, or ""."""
    text = words[i].text
    following = words[i + 1].text if i + 1 < len(words) else ""
    if text in STOPS or text in THEN:
        return "then"
    if text in WHILE:
        return "while"
    if text == "," or text == "and":
        return "comma" if text == "," else "and"
    if text in ("before", "after"):
        return text
    if text in ("until", "once", "when") and following in SUBJECTS:
        return "when" if text in ("once", "when") else "until"
    if text == "as" and (following in PRONOUNS or following in ("the", "a")):
        return "while"
    if (
        text == "to"
        and i
        and words[i + 1 : i + 2]
        and words[i + 1].form == "base"
        and (
            words[i + 1].is_activity or (words[i + 1].text == "do" and any(w.is_activity for w in words[i + 2 : i + 5]))
        )
        and words[i + 1].lemma != "face"
    ):
        return "" if any(word.lemma in _AUXILIARY for word in words[max(i - 2, 0) : i]) else "then"
    return ""


_AUXILIARY = frozenset({"start", "begin", "continue", "proceed", "about", "going", "decide", "go"})
_STRENGTH = {"first": 0, "comma": 1, "and": 2, "then": 3, "until": 4, "before": 5, "after": 5, "while": 5}


def _stronger(one: str, other: str) -> str:
    if one == "first" and other in ("then", "and", "comma"):
        return "first"
    if other == "when":  # "A, and when B, C" is in its order already; "when B, A" and "A when B" are not
        other = "after" if one == "first" else "then"
    if one == "first":
        return f"lead-{other}"
    return max(one, other, key=lambda link: _STRENGTH[link])


def _temporal_order(clauses: list[Clause]) -> list[Clause]:
    """Temporal order: leading "after A, B" is A, B; leading "before B, A" is A, B; "B after A" is A, B."""
    if len(clauses) > 1 and clauses[0].link.startswith("lead-"):
        kind = clauses[0].link.removeprefix("lead-")
        first, second, rest = clauses[0], clauses[1], clauses[2:]
        if kind == "before":
            first, second = second, first
        first.link, second.link = "first", "while" if kind == "while" else "then"
        clauses = [first, second, *rest]
    ordered: list[Clause] = []
    for clause in clauses:
        if clause.link == "after" and ordered:
            ordered[-1].link, clause.link = "then", ordered[-1].link
            ordered.insert(len(ordered) - 1, clause)
            continue
        if clause.link in ("before", "until"):
            clause.link = "then"
        ordered.append(clause)
    if ordered:
        ordered[0].link = "first"
    return ordered
