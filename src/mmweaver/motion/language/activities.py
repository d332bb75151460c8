"""The activities of body and hands: one record per activity, in `activities.toml`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mmweaver.core.safe_files.safe_text import read_toml


@dataclass(frozen=True, kw_only=True)
class Activity:
    """One activity. A body activity moves legs and trunk, a hand activity is overlaid on one."""

    key: str
    name: str  # as in "walking and waving"
    example: str
    shown: str = ""  # description of a step if the name is too short, with {hand}, {arm}, {leg}, {foot}
    least_s: float  # shortest time in which it can be shown
    natural_s: float
    once: bool = False  # takes its natural time; spare time goes to other steps
    counted_s: tuple[float, float, float] | None = None  # of one repetition: minimum, natural; extra at start and end
    clearance_m: float = 0.5  # free floor around the body
    moves: bool = False  # changes the position on the floor
    hands: bool = False
    posture: str = "feet"  # support of the body at its end: feet | seat | couch | knees | floor
    uses_seat: bool = False  # needs a seat, bed or couch


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
