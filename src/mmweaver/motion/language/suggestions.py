"""Error message for a clause that is not understood: the most similar known activity, and where all are listed."""

from functools import lru_cache

import numpy as np

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.lexicon import FILLERS
from mmweaver.motion.language.paraphrases import PARAPHRASES

NEAR = 0.3  # least cosine similarity of character n-grams for a suggestion


def not_known(clause_text: str, word: str = "") -> str:
    """One line: what was not understood, the nearest known activity, and how many more there are."""
    which = f" because of {word.replace('_', ' ')!r}" if word else ""
    found = nearest(clause_text)
    guess = f"did you mean {found[0][1]!r}? " if found and found[0][0] > NEAR else ""
    first = [activity.name for activity in list(BY_KEY.values())[:2]]
    names = ", ".join(first) + f" and {len(BY_KEY) - 2} more"
    return (
        f"the clause {clause_text!r} names no activity that is known{which}; {guess}known are {names}, listed by"
        " 'mmweaver motions'"
    )


def nearest(clause_text: str) -> list[tuple[float, str, str]]:
    """(similarity, example sentence, activity) of the five most similar activities, best first."""
    keys, names, matrix, weight = _table()
    vector = _vector(clause_text, weight)
    if not vector.any():
        return []
    score = matrix @ (vector / np.linalg.norm(vector))
    order = np.argsort(-score, kind="stable")[:5]
    return [(float(score[k]), names[k], keys[k]) for k in order]


def _grams(text: str) -> list[str]:
    """Character n-grams (3 to 5) of every word, its ends marked."""
    found = []
    for word in text.lower().replace("_", " ").split():
        if word in FILLERS:
            continue
        marked = f"<{word}>"
        found += [marked[i : i + n] for n in (3, 4, 5) for i in range(len(marked) - n + 1)]
    return found


@lru_cache(maxsize=1)
def _table() -> tuple[list[str], list[str], np.ndarray, dict[str, tuple[int, float]]]:
    """Keys, examples, TF-IDF matrix (paraphrase, n-gram), and (column, weight) of each n-gram."""
    examples = {activity.key: activity.example for activity in BY_KEY.values()}
    texts, keys = [], []
    for key, example in examples.items():
        for text in (example, *PARAPHRASES.get(key, ())):
            texts.append(text)
            keys.append(key)
    count: dict[str, int] = {}
    for text in texts:
        for gram in set(_grams(text)):
            count[gram] = count.get(gram, 0) + 1
    weight = {gram: (k, float(np.log(len(texts) / n))) for k, (gram, n) in enumerate(sorted(count.items()))}
    matrix = np.stack([_vector(text, weight) for text in texts])
    matrix /= np.maximum(np.linalg.norm(matrix, axis=1, keepdims=True), 1e-9)
    return keys, [examples[key] for key in keys], matrix, weight


def _vector(text: str, weight: dict[str, tuple[int, float]]) -> np.ndarray:
    """TF-IDF vector of a text, (n-gram,)."""
    vector = np.zeros(len(weight))
    for gram in _grams(text):
        if gram in weight:
            column, value = weight[gram]
            vector[column] += value
    return vector


def forget_suggestions() -> None:
    """For when an activity was added."""
    _table.cache_clear()
