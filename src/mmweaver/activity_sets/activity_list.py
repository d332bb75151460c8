"""The activities of a set, as a TOML file names them (`motion.worded_activities`)."""

from dataclasses import dataclass
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.worded_activities import activities_of


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
    return ActivityList(sentences=activities_of(read_toml(file), file))
