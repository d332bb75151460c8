"""The activities of a set, as a TOML file names them.

[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
walking = ["a person walks around"]
"""

from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.sentence import parse

MAX_LABELS, MAX_SENTENCES = 1000, 1000


@dataclass(frozen=True, kw_only=True)
class ActivityList:
    """Labels in the order of the file, with the sentences of each."""

    sentences: dict[str, tuple[str, ...]]

    @property
    def labels(self) -> tuple[str, ...]:
        """All labels; their place is the number that a data set holds."""
        return tuple(self.sentences)


def read_activities(file: Path) -> ActivityList:
    """Reads and parses all sentences.

    Raises InputError for a file that is none, or a sentence that is not understood.
    """
    content = read_toml(file)
    table = content.get("activities")
    if not isinstance(table, dict) or len(table) < 2:
        raise InputError(f'{file} needs a table [activities] of two or more lines such as: waving = ["a person waves"]')
    sentences: dict[str, tuple[str, ...]] = {}
    if len(table) > MAX_LABELS:
        raise InputError(f"{file} has {len(table)} labels; at most {MAX_LABELS} are possible")
    for label, given in table.items():
        said = [given] if isinstance(given, str) else given
        is_list = isinstance(said, list) and said and all(isinstance(one, str) for one in said)
        if not is_list or len(said) > MAX_SENTENCES:
            raise InputError(f"{file}, {label}: give a sentence or a list of 1 to {MAX_SENTENCES}")
        for one in said:
            try:
                parse(one)
            except InputError as error:
                raise InputError(f"{file}, {label}: {error}") from None
        sentences[label] = tuple(said)
    return ActivityList(sentences=sentences)
