"""The activities of a TOML file: labels, and sentences that describe each.

[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
walking = "a person walks around"
"""

from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.motion.empty_scene import NOBODY, says_nobody
from mmweaver.motion.language.sentence_parser import parse_sentence

MAX_LABELS, MAX_SENTENCES = 1000, 1000


def activities_of(content: dict[str, Any], file: Path, *, with_nobody: bool = False) -> dict[str, tuple[str, ...]]:
    """The sentences of each label in the order of the file, all of them validated by parsing.

    Args:
        content: Content of the TOML file.
        file: The file, for error messages.
        with_nobody: Whether a label may stand for an empty scene, whose sentence becomes NOBODY.

    Returns:
        Sentences by label.

    Raises:
        InputError: If there are fewer than two labels, or a sentence is not understood.
    """
    table = content.get("activities")
    if not isinstance(table, dict) or len(table) < 2:
        raise InputError(f'{file} needs a table [activities] of two or more lines such as: waving = ["a person waves"]')
    if len(table) > MAX_LABELS:
        raise InputError(f"{file} has {len(table)} labels; at most {MAX_LABELS} are possible")
    sentences: dict[str, tuple[str, ...]] = {}
    for label, given in table.items():
        said = [given] if isinstance(given, str) else given
        is_list = isinstance(said, list) and said and all(isinstance(one, str) for one in said)
        if not is_list or len(said) > MAX_SENTENCES:
            raise InputError(f"{file}, {label}: give a sentence or a list of 1 to {MAX_SENTENCES}")
        if with_nobody:
            said = [NOBODY if says_nobody(one) else one for one in said]
        if NOBODY in said and with_nobody:
            if len(set(said)) > 1:
                raise InputError(f"{file}, {label}: {NOBODY!r} is an empty place; give it a label of its own")
            sentences[label] = (NOBODY,)
            continue
        for one in said:
            if says_nobody(one):
                raise InputError(f"{file}, {label}: {one!r} is an empty place; say here what a person does")
            try:
                parse_sentence(one)
            except InputError as error:
                raise InputError(f"{file}, {label}: {error}") from None
        sentences[label] = tuple(said)
    return sentences
