"""The activities of body and hands: one record per activity, in `activities.toml`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.safe_files.safe_text import read_toml


@dataclass(frozen=True, kw_only=True)
class Activity:
    """One activity. A body activity moves legs and trunk, a hand activity is overlaid on one.

    Attributes:
        key: Key in `activities.toml`.
        name: As in "walking and waving".
        example: Sentence that names it.
        shown: Description of a step if the name is too short, with {hand}, {arm}, {leg}, {foot}.
        least_s: Minimum duration in seconds.
        natural_s: Natural duration in seconds.
        once: Whether it takes its natural time; spare time goes to other steps.
        counted_s: Minimum and natural duration of one repetition, and extra time at start and end.
        clearance_m: Free floor around the body in metres.
        moves: Whether it changes the position on the floor.
        hands: Whether it is a hand activity.
        posture: Support of the body at its end: feet, seat, couch, knees or floor.
        uses_seat: Whether it needs a seat, bed or couch.
    """

    key: str
    name: str
    example: str
    shown: str = ""
    least_s: float
    natural_s: float
    once: bool = False
    counted_s: tuple[float, float, float] | None = None
    clearance_m: float = 0.5
    moves: bool = False
    hands: bool = False
    posture: str = "feet"
    uses_seat: bool = False


def words_in(text: str) -> frozenset[str]:
    """The words of a text, as a set."""
    return frozenset(text.split())


ACTIVITY_OF_LEMMA: dict[str, tuple[str, str]] = {}  # verb -> (lower, upper) of a Step
PARAPHRASES: dict[str, tuple[str, ...]] = {}  # compared with unknown clauses for suggestions


def _activity(key: str, record: dict[str, Any], *, hands: bool) -> Activity:
    meaning = ("", key) if hands else (key, "")
    ACTIVITY_OF_LEMMA.update(dict.fromkeys(record.pop("verbs", "").split(), meaning))
    PARAPHRASES[key] = tuple(record.pop("paraphrases", ()))
    counted_s = tuple(record.pop("counted_s", ())) or None
    return Activity(key=key, hands=hands, counted_s=counted_s, **record)


_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
BODY = tuple(_activity(key, record, hands=False) for key, record in _TABLE["body"].items())
HANDS = tuple(_activity(key, record, hands=True) for key, record in _TABLE["hands"].items())
BY_KEY: dict[str, Activity] = {activity.key: activity for activity in (*BODY, *HANDS)}
CLEARANCE_M: dict[str, float] = {key: activity.clearance_m for key, activity in BY_KEY.items()}


def known() -> str:
    """Names of all activities, separated by commas, for messages.

    >>> known().count(", ") > 50
    True
    """
    return ", ".join(activity.name if activity.key != "raise" else "raising a hand" for activity in BY_KEY.values())
