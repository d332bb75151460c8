"""Error message for a clause that is not understood: the most similar known activity, and where all are listed."""

from functools import lru_cache

import numpy as np

from mmweaver.motion.language.activities import BY_KEY, PARAPHRASES, words_in
from mmweaver.motion.language.described_person import PEOPLE
from mmweaver.motion.language.lexicon import (
    ARMS,
    DIRECTIONS,
    FILLERS,
    LIGHT,
    MANNERS,
    NUMBERS,
    OWN,
    PRONOUNS,
    RADAR,
    SEATS,
    SIZES,
    SPEEDS,
    TARGETS,
)
from mmweaver.motion.language.words import word_of

NEAR = 0.6  # least similarity for a suggestion
# Movements over the hands or through the air, of which none is known.
ON_HANDS = words_in("handstand handstands headstand headstands cartwheel cartwheels flip backflip backflips handspring")
_EMPTY = PRONOUNS | PEOPLE | FILLERS  # words that name no movement
_KNOWN = frozenset().union(
    _EMPTY, ARMS, DIRECTIONS, MANNERS, NUMBERS, OWN, RADAR, SEATS, SIZES, SPEEDS, TARGETS
)  # and that say where, how, with what


def not_known(clause_text: str, word: str = "") -> str:
    """One line: what was not understood, the nearest known activity, and how many more there are."""
    which = f" because of {word.replace('_', ' ')!r}" if word else ""
    if ON_HANDS & {word, *clause_text.lower().replace("_", " ").split()}:
        return (
            f"the clause {clause_text!r} cannot be shown{which}: a body upside down on stretched arms or in the air"
            " is not modelled; of such movements only a forward roll is known"
        )
    found = nearest(word if word and nearest(word) else clause_text)
    guess = f"did you mean {found[0][1]!r}? " if found and found[0][0] >= NEAR else ""
    first = [activity.name for activity in list(BY_KEY.values())[:2]]
    names = ", ".join(first) + f" and {len(BY_KEY) - 2} more"
    return (
        f"the clause {clause_text!r} names no activity that is known{which}; {guess}known are {names}, listed by"
        " 'mmweaver motions'"
    )


def nearest(clause_text: str) -> list[tuple[float, str, str]]:
    """(similarity, example sentence, activity) of the five most similar activities, best first.

    The words of the clause that name what is not known, or all where none does, are compared with the words of each
    activity: the mean, over the clause's words, of the similarity to the nearest word; 1 where one has them all.
    """
    words = clause_text.lower().replace("_", " ").split()
    asked = [word for word in words if word not in _KNOWN and not word_of(word).is_verb]
    asked = asked or [word for word in words if word not in _EMPTY and word_of(word).lemma not in LIGHT]
    vectors = [vector for word in dict.fromkeys(asked) if (vector := _vector(word)).any()]
    if not vectors:
        return []
    vocabulary, matrix, activities = _table()
    alike = np.stack([matrix @ vector for vector in vectors])  # (asked, word of an activity)
    scores = {
        key: float(alike[:, [vocabulary[word] for word in own]].max(axis=1).sum()) / len(set(asked))
        for key, own in activities.items()
    }
    best = sorted(scores, key=lambda key: -scores[key])[:5]
    return [(scores[key], BY_KEY[key].example, key) for key in best]


def _grams(word: str) -> list[str]:
    """Character n-grams (3 to 5) of a word, its ends marked."""
    marked = f"<{word}>"
    return [marked[i : i + n] for n in (3, 4, 5) for i in range(len(marked) - n + 1)]


@lru_cache(maxsize=1)
def _columns() -> dict[str, int]:
    """The column of each n-gram of the words of all activities."""
    words = {word for own in _words_of_activities().values() for word in own}
    return {gram: k for k, gram in enumerate(sorted({gram for word in words for gram in _grams(word)}))}


@lru_cache(maxsize=1)
def _words_of_activities() -> dict[str, tuple[str, ...]]:
    """The words of each activity's example and paraphrases that name what is done, or with what."""
    texts = {key: " ".join((activity.example, *PARAPHRASES.get(key, ()))) for key, activity in BY_KEY.items()}
    return {
        key: tuple(dict.fromkeys(w for w in text.lower().split() if w not in _EMPTY)) for key, text in texts.items()
    }


@lru_cache(maxsize=1)
def _table() -> tuple[dict[str, int], np.ndarray, dict[str, tuple[str, ...]]]:
    """The row of each word, their vectors (word, n-gram), and the words of each activity."""
    activities = {key: words for key, words in _words_of_activities().items() if words}
    vocabulary = {word: k for k, word in enumerate(sorted({word for own in activities.values() for word in own}))}
    return vocabulary, np.stack([_vector(word) for word in vocabulary]), activities


def _vector(word: str) -> np.ndarray:
    """Which known n-grams a word has, (n-gram,); of length 1 where it has only known ones."""
    vector = np.zeros(len(_columns()))
    grams = set(_grams(word))
    for gram in grams & _columns().keys():
        vector[_columns()[gram]] = 1.0
    return vector / len(grams) ** 0.5


def forget_suggestions() -> None:
    """For when an activity was added."""
    for kept in (_columns, _words_of_activities, _table):
        kept.cache_clear()
