"""Error message of a clause that is not understood: the most similar known activity, and where all are listed."""

from difflib import SequenceMatcher, get_close_matches
from functools import cache

from mmweaver.motion.language.activities import BY_KEY, PARAPHRASES, words_in
from mmweaver.motion.language.described_person import PEOPLE
from mmweaver.motion.language.lexicon import ALL_WORDS, FILLERS, LIGHT, OWN, PRONOUNS
from mmweaver.motion.language.words import word_of

NEAR = 0.75  # minimum similarity of a word to one of a suggestion
# Movements over the hands or through the air, none of which is known.
ON_HANDS = words_in("handstand handstands headstand headstands cartwheel cartwheels flip backflip backflips handspring")
_EMPTY = PRONOUNS | PEOPLE | FILLERS | LIGHT  # words that name no movement


def not_known(clause_text: str, word: str = "") -> str:
    """The message about a clause that is not understood.

    Args:
        clause_text: Words of the clause.
        word: The unknown word, if there is a single one.

    Returns:
        One line: what was not understood, the nearest known activity, and how many more there are.
    """
    which = f" because of {word.replace('_', ' ')!r}" if word else ""
    if ON_HANDS & {word, *clause_text.lower().replace("_", " ").split()}:
        return (
            f"the clause {clause_text!r} cannot be shown{which}: a body upside down on stretched arms or in the air"
            " is not modelled; of such movements only a forward roll is known"
        )
    example = nearest_example(word) or nearest_example(clause_text)
    guess = f"did you mean {example!r}? " if example else ""
    first = [activity.name for activity in list(BY_KEY.values())[:2]]
    names = ", ".join(first) + f" and {len(BY_KEY) - 2} more"
    return (
        f"the clause {clause_text!r} names no activity that is known{which}; {guess}known are {names}, listed by"
        " 'mmweaver motions'"
    )


@cache
def nearest_example(clause_text: str) -> str:
    """Example of the known activity most similar to a clause.

    Args:
        clause_text: Words of the clause.

    Returns:
        Example sentence; "" if too few words are similar.
    """
    words = [word for word in clause_text.lower().replace("_", " ").split() if word not in _EMPTY | ALL_WORDS | OWN]
    asked = [word for word in words if not word_of(word).is_verb] or words
    found = dict.fromkeys(BY_KEY, 0.0)
    for word in asked:
        near = {other: SequenceMatcher(None, word, other).ratio() for other in _near(word)}
        for key, own in _words_of_activities().items():
            found[key] += max((near[other] for other in own & near.keys()), default=0.0)
    best = max(found, key=lambda key: found[key])
    return BY_KEY[best].example if asked and found[best] > NEAR * len(asked) else ""


def _near(word: str) -> list[str]:
    vocabulary = sorted(frozenset().union(*_words_of_activities().values()))
    return get_close_matches(word, vocabulary, n=5, cutoff=NEAR)


@cache
def _words_of_activities() -> dict[str, frozenset[str]]:
    """Content words of each activity's example and paraphrases."""
    texts = {key: " ".join((activity.example, *PARAPHRASES.get(key, ()))) for key, activity in BY_KEY.items()}
    return {key: words_in(text.lower()) - _EMPTY for key, text in texts.items()}


def forget_suggestions() -> None:
    """Clears the caches after an activity was added."""
    for kept in (nearest_example, _words_of_activities):
        kept.cache_clear()
