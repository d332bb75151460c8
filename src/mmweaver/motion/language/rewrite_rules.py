"""Rewrites sentences into words that the grammar knows; the rows are in `rewrite_rules.toml`."""

import re
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA
from mmweaver.motion.language.described_person import BUILDS, PERSON_NOUNS

Replacement = str | Callable[[re.Match[str]], str]
_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
_PARTS = {"builds": BUILDS, "people": PERSON_NOUNS, **_TABLE["parts"]}

_ADJECTIVES = r"(?:(?:quick|fast|hard|strong|short|straight|powerful|sharp) )*"
_NUMBER = r"(?:(one|two|three|four|five|six|some|several|a few|\d+) )?"
_PUNCH = (
    rf"(?:(?:an?|the|another|his|her) )?{_NUMBER}{_ADJECTIVES}(?:(left|right)(?:[- ]hand(?:ed)?)? )?{_ADJECTIVES}"
    r"(jab|cross|hook|uppercut)(?:s|es)?\b"
)
_ANY_PUNCH = re.sub(r"\((?!\?)", "(?:", _PUNCH)
_NEXT = r"(?: ?, ?(?:and |then |and then )?|,? (?:and then|and|then|followed by) | ?- ?| ?/ ?| )"
_PUNCHES = re.compile(
    r"(?:\b(?P<lands>throws?|throwing|lands?|landing|delivers?|punch(?:es|ing)?(?: with)?) "
    r"|\b(?P<does>(?:does|do|doing|performs?|performing|makes?|making|practi[cs]es|boxes|boxing)(?: with|:| -)?) ?|\b)"
    rf"(?P<list>{_ANY_PUNCH}(?:{_NEXT}{_ANY_PUNCH})*)(?: (?:combination|combo|sequence))?"
)
_TOKENS = {"jab": "jab", "cross": "cross_punch", "hook": "hook_punch", "uppercut": "uppercut"}
_FEW = {"some": "3", "several": "3", "a few": "3"}


@cache
def _rules(stage: str) -> list[tuple[re.Pattern[str], Replacement]]:
    """Compiled on first use: most sentences never need the last stage."""
    rows = [(re.compile(expand_parts(pattern, _PARTS), re.IGNORECASE), to) for pattern, to in _TABLE["rules"][stage]]
    if stage != "phrases":
        return rows
    return [(_PUNCHES, _punch_tokens), *((pattern, _participle_rule(to) or to) for pattern, to in rows)]


def expand_parts(pattern: str, parts: Mapping[str, str]) -> str:
    """Expands the parts that a pattern names in angle brackets, recursively."""
    return re.sub(r"(?<!P)<([a-z_]+)>", lambda name: expand_parts(parts[name[1]], parts), pattern)


def rewritten(text: str, stage: str) -> str:
    """Applies the rules of a stage to a sentence.

    Args:
        text: The sentence; in lower case for "phrases".
        stage: "first" (before anything else), "phrases" (each becomes one token) or "last" (if a sentence is not
            understood otherwise).

    >>> rewritten("a person walks forward with a limp on the right leg", "first")
    'a person limps forward with the right leg'
    """
    for pattern, replacement in _rules(stage):
        text = " ".join(pattern.sub(replacement, text).split())
    return text


def words_of_phrases() -> set[str]:
    """The words, and stems of words, in the patterns of phrases."""
    patterns = " ".join(expand_parts(pattern, _PARTS) for pattern, _ in _TABLE["rules"]["phrases"])
    return set(re.findall("[a-z]+", re.sub(r"\\[a-z]|\(\?[:=!<]*", " ", patterns)))


def _participle_rule(replacement: str) -> Replacement | None:
    """The token of a hand activity ends in "ing" if the first word did."""
    token = next(iter(replacement.split()), "")
    lower, upper = ACTIVITY_OF_LEMMA.get(token, ("", ""))
    if lower or not upper:
        return None

    def replaced(found: re.Match[str]) -> str:
        words = found.expand(replacement)
        return words.replace(token, f"{token}ing", 1) if re.match(r"[a-z]+ing\b", found[0]) else words

    return replaced


def _punch_tokens(found: re.Match[str]) -> str:
    """One token for each punch of a list, with its hand and number: "a jab, a cross and a hook".

    A cross or hook without a verb of punching, and without a jab or uppercut, is not a punch.
    """
    punches = [punch.groups() for punch in re.finditer(_PUNCH, found["list"])]
    names = {name for _, _, name in punches}
    sure = found["lands"] or names & {"jab", "uppercut"} or (found["does"] and (len(punches) > 1 or punches[0][1]))
    if not sure and not (found["does"] and names == {"hook"}):
        return found[0]
    ends = "s" if found["lands"] or found["does"] or re.search(r"[bkst]s$|crosses$", found["list"]) else ""
    tokens = []
    for number, hand, name in punches:
        times = f" {_FEW.get(number, number)} times" if number and number != "one" else ""
        tokens.append(f"{_TOKENS[name]}{ends}{f' with the {hand} hand' if hand else ''}{times}")
    return f" {' , then '.join(tokens)} "
