"""Aligns the words of the original sentence with the clauses after rewriting."""

import re
from collections.abc import Mapping
from difflib import SequenceMatcher
from itertools import groupby

from mmweaver.motion.language.activities import words_in
from mmweaver.motion.language.plan import ClauseRecord

TOKEN = re.compile(r"[a-z]+(?:'[a-z]+)?|\d+(?:\.\d+)?|[,.;:_]+")
SEPARATORS = words_in(", . ; : and then while before after until")
_STEM = 4  # letters compared: "twists" and "twist"
_SMALL = SEPARATORS | words_in(
    "a an the to of in on at as for from by with into this that his her their its is are was he she it they person man"
)
_PAIRS = {("back", "forth"), ("up", "down"), ("to", "fro"), ("left", "right"), ("in", "out")}
_LINKS = SEPARATORS | words_in("afterwards next finally")
Records = Mapping[int, ClauseRecord]


def clause_of_each(tokens: list[str], records: Records) -> tuple[list[int], list[bool]]:
    """Assigns each token of the original sentence to a clause.

    Args:
        tokens: Tokens of the sentence, in lower case.
        records: Record of each clause by its number.

    Returns:
        Number of the clause of each token, and whether that clause still contains it after rewriting.
    """
    words = [(word, number) for number, record in sorted(records.items()) for word in record.clause.split()]
    words = [(word, number) for word, number in words if word not in _SMALL]
    places = [i for i, token in enumerate(tokens) if token not in _SMALL]
    stems = ([tokens[i][:_STEM] for i in places], [word[:_STEM] for word, _ in words])
    found: list[int | None] = [None] * len(tokens)
    for block in SequenceMatcher(None, *stems, autojunk=False).get_matching_blocks():
        for k in range(block.size):
            found[places[block.a + k]] = words[block.b + k][1]
    last = next((number for number in found if number is not None), min(records))
    numbers = []
    for i, number in enumerate(found):
        if number is None and tokens[i] in SEPARATORS:
            number = next((other for other in found[i:] if other is not None), last)
        last = last if number is None else number
        numbers.append(last)
    kept = [number is not None for number in found]
    for number, part in _wholly_rewritten(tokens, numbers, kept, records):
        for place in part:
            numbers[place] = number
    return numbers, kept


def _wholly_rewritten(
    tokens: list[str], numbers: list[int], kept: list[bool], records: Records
) -> list[tuple[int, list[int]]]:
    """Clauses without any original word, with the positions between two links that no other clause has."""
    parts: list[list[int]] = [[]]
    for place, token in enumerate(tokens):
        if token in _LINKS:
            parts.append([])
        else:
            parts[-1].append(place)
    free = [part for part in parts if part and not any(kept[place] for place in part)]
    gone = sorted({*records} - {number for number, is_kept in zip(numbers, kept, strict=True) if is_kept})
    return list(zip(gone, free, strict=True)) if len(gone) == len(free) else []


def given_words(text: str, records: Records) -> dict[int, str]:
    """The original words of each clause, whose record may hold what they were rewritten to.

    Args:
        text: The sentence.
        records: Record of each clause by its number.

    Returns:
        Words by clause number, joined by an ellipsis if not contiguous; "" for a clause added by rewriting.
    """
    found = list(TOKEN.finditer(text.lower()))
    tokens = [one[0] for one in found]
    for i in range(1, len(tokens)):  # "for a while" and "back and forth" link nothing
        is_pair = tokens[i] == "and" and tuple(tokens[i - 1 : i + 2 : 2]) in _PAIRS
        tokens[i] = "_" if is_pair or tokens[i - 1 : i + 1] == ["a", "while"] else tokens[i]
    numbers = _part_numbers(tokens, records) or clause_of_each(tokens, records)[0]
    words = {}
    for number in records:
        parts = []
        for own, places in groupby(range(len(tokens)), key=numbers.__getitem__):
            run = [*places] if own == number else []
            while run and tokens[run[0]] in _LINKS:
                del run[0]
            while run and tokens[run[-1]] in _LINKS:
                del run[-1]
            parts += [text[found[run[0]].start() : found[run[-1]].end()]] if run else []
        words[number] = " ... ".join(parts)
    return words


def _part_numbers(tokens: list[str], records: Records) -> list[int]:
    """Clause number of each token if the sentence has as many parts between links as clauses; else []."""
    numbers, part, is_open = [], -1, False
    for token in tokens:
        if token in _LINKS:
            is_open = False
        elif not is_open:
            part, is_open = part + 1, True
        numbers.append(max(part, 0))
    return [sorted(records)[number] for number in numbers] if part + 1 == len(records) else []
