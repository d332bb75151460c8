"""Registers activities of programs and plug-ins: name, verbs, and the function that animates them.

The activities of a TOML file: labels, and sentences that describe each.

[activities]
waving = ["a person waves with the left hand", "a person waves with the right hand"]
walking = "a person walks around"
"""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.registry import load_plugin, plugins
from mmweaver.motion.animation.library.activity_registry import GESTURES, POSTURES
from mmweaver.motion.empty_floor import NOBODY, says_nobody
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, BY_KEY, CLEARANCE_M, Activity
from mmweaver.motion.language.sentence import parse_sentence
from mmweaver.motion.language.suggestions import forget_suggestions
from mmweaver.motion.language.words import forget_known_words, word_of

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


GROUP = "mmweaver.activities"


def register_activity(
    key: str, *, verbs: tuple[str, ...], perform: Callable[..., Any], hands: bool = False, **described: Any
) -> None:
    """Adds an activity; registering the same one again has no effect. See `mmweaver.weaver.register.activity`.

    Args:
        key: Key of the activity.
        verbs: Verbs in lower case that name it.
        perform: Animates it, see `animation.step_context`.
        hands: Whether it is a hand activity, overlaid on a body activity.
        **described: Other fields of `Activity`.

    Raises:
        InputError: If the key or a verb is taken by another activity, or a verb is not one lower-case word.
    """
    registry: Any = GESTURES if hands else POSTURES
    meaning = ("", key) if hands else (key, "")
    activity = Activity(key=key, hands=hands, **described)
    if BY_KEY.get(key, activity) != activity:
        raise InputError(f"there is an activity {key!r} already; choose another key")
    for verb in verbs:
        if not (verb.isalpha() and verb.islower()):
            raise InputError(f"the verb {verb!r} of activity {key!r} must be one word in lower case")
        if ACTIVITY_OF_LEMMA.get(verb, meaning) != meaning:
            raise InputError(f"the verb {verb!r} names another activity already; choose another verb than for {key!r}")
    registry.register(key, perform)
    BY_KEY[key] = activity
    CLEARANCE_M[key] = activity.clearance_m
    ACTIVITY_OF_LEMMA.update(dict.fromkeys(verbs, meaning))
    word_of.cache_clear()
    forget_known_words()
    forget_suggestions()


@lru_cache(maxsize=1)
def load_activity_plugins() -> int:
    """Loads the plug-ins of installed packages in the group mmweaver.activities, once.

    Each calls `mmweaver.weaver.register.activity`.

    Returns:
        Number of plug-ins.

    Raises:
        InputError: If one cannot be imported.
    """
    found = plugins(GROUP)
    for plugin in found.values():
        load_plugin(plugin)()
    return len(found)
