"""The lexicon: words that a sentence may contain, by their function, from `lexicon.toml`."""

from pathlib import Path
from typing import Any

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.activities import words_in

_TABLE: dict[str, Any] = read_toml(Path(__file__).with_suffix(".toml"))
_WORDS = {name: words_in(words) for name, words in _TABLE.items() if isinstance(words, str)}


def _inverse(name: str) -> dict[str, str]:
    """Maps each word to its meaning, from a table of words by meaning."""
    return {word: meaning for meaning, words in _TABLE[name].items() for word in words.split()}


GOING = frozenset({"go", "move", "head", "come", "return"})  # walking if the clause gives a destination
TARGETS = _inverse("targets")  # a word for a place to go to -> one of LANDMARK_KINDS
IRREGULAR = _inverse("irregular")
DIRECTIONS = _inverse("directions")
SPEEDS = {word: int(speed) for word, speed in _inverse("speeds").items()}
BASE_VERB_SPEED = {word: int(speed) for word, speed in _inverse("speeds_of_verbs").items()}
NUMBERS: dict[str, int] = _TABLE["numbers"]
TIMES = frozenset({"once", "twice", "thrice"})
LIGHT = _WORDS["light"]
SEATS = _WORDS["seats"]
ARMS = _WORDS["arms"]
LEGS = _WORDS["legs"]
RADAR = _WORDS["radar"]
RECOVERING = _WORDS["recovering"]
BOTH = _WORDS["both"]
OWN = _WORDS["own"]
PRONOUNS = _WORDS["pronouns"]
NEGATIONS = _WORDS["negations"]
MANY = _WORDS["many"]
NOT_HUMAN = _WORDS["not_human"]
OTHER_MOVEMENT = _WORDS["other_movement"]
FILLERS = _WORDS["fillers"]
MANNERS = _WORDS["manners"]
SIZES = _WORDS["sizes"]
STEPPING = GOING | _WORDS["stepping"]
DISTANCES = _WORDS["distances"]
LEG_VERBS = _WORDS["leg_verbs"]
FLOOR_VERBS = _WORDS["floor_verbs"]
THINGS = _WORDS["things"]
BEFORE_NOUNS = _WORDS["before_nouns"]
NOUNS_LIKE_VERBS = _WORDS["nouns_like_verbs"]
OTHER_WORDS = _WORDS["other_words"]
OTHER_VERBS = _WORDS["other_verbs"]
MORE_WORDS = _WORDS["more_words"]
WHOLE_BODY = _WORDS["whole_body"]
# What the spelling correction knows in addition to verbs.
ALL_WORDS = frozenset().union(
    ARMS,
    BOTH,
    DIRECTIONS,
    FILLERS,
    MANNERS,
    MANY,
    NEGATIONS,
    NOT_HUMAN,
    NUMBERS,
    OTHER_MOVEMENT,
    RADAR,
    SEATS,
    SIZES,
    SPEEDS,
    TARGETS,
)
