"""Registers activities of programs and plug-ins: name, verbs, and the function that animates them."""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from mmweaver.core.errors import InputError
from mmweaver.core.registry import load_plugin, plugins
from mmweaver.motion.animation.library.activity_registry import GESTURES, POSTURES
from mmweaver.motion.language.activities import ACTIVITY_OF_LEMMA, BY_KEY, CLEARANCE_M, Activity
from mmweaver.motion.language.spelling import forget_known_words
from mmweaver.motion.language.suggestions import forget_suggestions
from mmweaver.motion.language.words import word_of

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
