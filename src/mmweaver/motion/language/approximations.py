"""Movements shown as similar ones: tried if a sentence is not understood, and reported as approximated.

The rows are in `approximations.toml`.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.rewrite_rules import expand_parts

_ALWAYS, _IN_PART = ("instead_of_another", "always"), ("in_part",)
MARK = "approx_"
_IN_TURN = "in turn"  # the fourth column of a row
_THESE = "THESE"  # placeholder in the report for the words replaced


@dataclass(frozen=True)
class Approximation:
    """A pattern of the sentence, the replacement that is acted out, and how it is reported."""

    pattern: str
    instead: str
    how: str
    always: bool = False  # applied even if the sentence would be understood, but wrongly
    in_part: bool = False  # only if a sentence may be parsed in part
    in_turn: bool = False  # two movements instead of one, shown one after the other


_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
APPROXIMATIONS = tuple(
    Approximation(pattern, instead, how, always=group in _ALWAYS, in_part=group in _IN_PART, in_turn=_IN_TURN in more)
    for group, rows in _TABLE["rows"].items()
    for pattern, instead, how, *more in rows
)
_LINK = re.compile(r"[,.;]|\b(?:and|then|while|before|after)\b")
_HELD = re.compile(r"<(\d+)>(?: +for (\d+(?:\.\d+)?) seconds\b)?")


@cache
def _pattern(number: int) -> re.Pattern[str]:
    """Compiled on first use: most sentences need few of them, and all take 0.1 s of CPU time."""
    return re.compile(expand_parts(APPROXIMATIONS[number].pattern, _TABLE["parts"]))


def _is_adjective(found: re.Match[str]) -> bool:
    """Whether a participle between an article and a noun describes that noun: "carries a sleeping child"."""
    before, after = found.string[: found.start()].rstrip(), found.string[found.end() :]
    is_described = re.match(r" (?!and\b|then\b|while\b|with\b|in\b|on\b|for\b|at\b)[a-z]", after) is not None
    follows_article = re.search(r"\b(?:an?|the|his|her|their)$", before) is not None
    return re.fullmatch("[a-z]+ing", found[0]) is not None and is_described and follows_article


def apply_approximations(
    text: str,
    *,
    only_always: bool = False,
    in_part: bool = False,
    is_understood: Callable[[str], bool] = lambda part: False,
) -> str:
    """Replaces unknown movements by similar known ones, each followed by a token that identifies the row.

    Args:
        text: The sentence.
        only_always: Applies only the rows marked `always`.
        in_part: Applies also the rows marked `in_part`.
        is_understood: Tells whether a part between two connectives is understood; nothing is replaced in such parts.

    Returns:
        The sentence with replacements; `text` itself if there are none.
    """
    folded = text.lower()
    held: list[str] = []  # replacements, kept out of the text until all patterns have been tried
    for number, one in enumerate(APPROXIMATIONS):
        if (only_always and not one.always) or (one.in_part and not in_part):
            continue

        def hold(found: re.Match[str], number: int = number, one: Approximation = one) -> str:
            if _is_adjective(found) or (not one.always and is_understood(_part_around(found))):
                return found[0]
            words = "_".join(re.findall("[a-z]+", found[0]) if _THESE in one.how else ())
            at_once = "while " if _says_what_is_done_meanwhile(found, one.instead) else ""
            held.append(f"{at_once}{_filled(found, one.instead)} {MARK}{words}_{number}")
            return f" <{len(held) - 1}> "

        folded = _pattern(number).sub(hold, folded)
    return " ".join(_HELD.sub(lambda found: _in_turn(held[int(found[1])], found[2]), folded).split()) if held else text


def _says_what_is_done_meanwhile(found: re.Match[str], instead: str) -> bool:
    """Whether a participle after a comma is replaced by one movement: "walks about, rubbing the hands"."""
    follows = found.string[: found.start()].rstrip().endswith(",")
    return (
        follows
        and re.match("[a-z]+ing\\b", found[0]) is not None
        and re.fullmatch(r"[a-z]+s\b[^,]*", instead) is not None
    )


def _in_turn(replacement: str, seconds: str | None) -> str:
    """A replacement, each of whose movements takes an equal share of the stated seconds, if any."""
    if not seconds:
        return replacement
    words, _, mark = replacement.rpartition(f" {MARK}")
    parts = re.split(", ", words.strip(" ,"))
    lasting = ", ".join(f"{part} for {float(seconds) / len(parts):.4g} seconds" for part in parts)
    return f"{', ' if words.lstrip().startswith(',') else ''}{lasting} {MARK}{mark} "


def _part_around(found: re.Match[str]) -> str:
    """The words between the two connectives around a match, which may itself hold connectives; "" if it does."""
    text = found.string
    starts = [link.end() for link in _LINK.finditer(text) if link.end() <= found.start() + 1]
    ends = [link.start() for link in _LINK.finditer(text) if link.start() >= found.end() - 1]
    part = text[starts[-1] if starts else 0 : ends[0] if ends else len(text)]
    return "" if _LINK.search(part) or _HELD.search(part) else part.strip()


def _filled(found: re.Match[str], instead: str) -> str:
    """The replacement with the groups of the match in it."""
    return re.sub(r"\\(\d)", lambda group: found[int(group[1])] or "", instead)


def approximation_of(token: str) -> tuple[str, bool]:
    """Report of an approximation.

    Args:
        token: Token of `apply_approximations`.

    Returns:
        What is shown instead, and whether movements are shown one after the other.
    """
    words, _, number = token.removeprefix(MARK).rpartition("_")
    one = APPROXIMATIONS[int(number)]
    return one.how.replace(_THESE, repr(words.replace("_", " "))), one.in_turn
