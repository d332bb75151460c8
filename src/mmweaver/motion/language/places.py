"""Places of activities: 'near the window', 'behind the sofa', 'in the corner', 'two metres away', 'on the left'."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.described_person import PEOPLE
from mmweaver.motion.language.lexicon import NUMBERS, RADAR, TARGETS
from mmweaver.motion.language.rewrite_rules import expand_parts

MARK = "place_"
_TABLE = read_toml(Path(__file__).with_suffix(".toml"))
_PARTS = {
    "object": "|".join(sorted((word for word in TARGETS if word != "wall"), key=len, reverse=True)),
    "radar": "|".join(RADAR),
    "numbers": "|".join(word for word, value in NUMBERS.items() if value < 13),
    "people": "|".join(sorted(PEOPLE)),
    **_TABLE["parts"],
}
_WHOM, _WHOSE, _AIMED, _FACED, _ACTS_THERE, _ROOM = (
    re.compile(expand_parts(pattern, _PARTS)) for pattern in _TABLE["patterns"].values() if isinstance(pattern, str)
)
_THERE, _AWAY_FROM_IT, _PATTERNS = (
    [(re.compile(expand_parts(pattern, _PARTS)), relation) for pattern, relation in _TABLE["patterns"][group]]
    for group in ("there", "away", "at")
)
AIM = "aim_"  # token of a faced object: a Landmark.kind follows


@dataclass(frozen=True)
class Place:
    """A place in a sentence, for the planner to find in the room."""

    # near | behind | front | leftof | rightof | in | against | between | under | outside | range | left | right
    # | middle | far | close
    relation: str
    landmark: str = ""  # Landmark.kind that it is relative to; wall, corner: of the room
    other: str = ""  # second object of "between"
    is_end: bool = False  # "middle" is the destination of a walk
    distance_m: float = 0.0  # of "range"
    also: "Place | None" = None  # additional constraint: 'two metres away on the left'

    def together_with(self, other: "Place") -> "Place":
        """The intersection of two places, the one at a landmark first."""
        one, more = (other, self) if other.landmark and not self.landmark else (self, other)
        return replace(one, also=more if one.also is None else one.also.together_with(more))

    @property
    def is_goal(self) -> bool:
        """Whether a walk goes to this place instead of beginning there."""
        return bool(self.landmark) or self.is_end or self.relation == "outside"

    @property
    def words(self) -> str:
        """The place as worded in messages."""
        if self.also is not None:
            return f"{replace(self, also=None).words}, {self.also.words}"
        if self.relation == "range":
            return f"{self.distance_m:g} m from the radar"
        if self.relation == "between":
            same = self.landmark == self.other
            return f"between two {self.landmark}s" if same else f"between the {self.landmark} and the {self.other}"
        if self.landmark == "door" and self.relation == "in":
            return "in the doorway"
        relation = {"front": "in front of", "leftof": "left of", "rightof": "right of"}.get(
            self.relation, self.relation
        )
        if self.landmark:
            return f"{relation} the {self.landmark}"
        return {
            "middle": "in the middle",
            "far": "in the background",
            "close": "close to the radar",
            "outside": "outside",
        }.get(self.relation, f"on the {self.relation}")


def mark_places(text: str) -> str:
    """Replaces each place, and each object faced or pointed at, by a token.

    Args:
        text: The sentence in lower case.
    """
    text = _WHOM.sub(lambda found: f"{found[1]} {AIM}{found[2]} ", text)
    text = _WHOSE.sub(lambda found: f"{found[1]} {MARK}{found['side'] or found.lastgroup} ", text)
    for pattern in (_AIMED, _FACED):
        text = pattern.sub(lambda found: f"{found[1]} {AIM}{TARGETS[found[2]]} ", text)
    for pattern, token in _THERE:
        text = pattern.sub(lambda found, token=token: f"{found['goes']} {_side_tokens(found, token)} ", text)
    for pattern, relation in _AWAY_FROM_IT:
        text = pattern.sub(lambda found, relation=relation: _unless_acted_there(found, relation), text)
    for pattern, relation in _PATTERNS:
        text = pattern.sub(lambda found, relation=relation: f" {_token(found, relation)} ", text)
    return text


def _side_tokens(found: re.Match[str], token: str) -> str:
    side = found.groupdict().get("side")
    return f"{MARK}{token} {MARK}{side}" if side else MARK + token


def _unless_acted_there(found: re.Match[str], relation: str) -> str:
    """Token of a place outside the room; the words unchanged if something is only directed there."""
    if _ACTS_THERE.search(found.string[: found.start()]):
        return found[0]
    kind = TARGETS.get(found["object"], "")
    return f" {MARK}{relation}_{kind} " if kind else f" {MARK}{relation} "


def _token(found: re.Match[str], relation: str) -> str:
    groups = found.groupdict()
    if relation == "range":
        number = groups["number"]
        value = 1.0 if number in ("a", "an") else 0.5 if number == "half a" else float(NUMBERS.get(number, 0) or number)
        return f"{MARK}range_{round(100 * (value + 0.5 * bool(groups['half'])))}"
    if relation == "side":
        return MARK + groups["object"]
    if relation == "between":
        other = groups.get("other") or groups["object"]
        return f"{MARK}between_{TARGETS[groups['object']]}_{TARGETS[other]}"
    return f"{MARK}{relation}_{TARGETS[groups['object']]}" if "object" in groups else MARK + relation


def place_of(token: str) -> Place:
    """The place that a token of `mark_places` stands for.

    Args:
        token: The token.

    >>> place_of("place_behind_couch").words, place_of("place_range_250").distance_m
    ('behind the couch', 2.5)
    """
    relation, _, rest = token.removeprefix(MARK).partition("_")
    if relation == "range":
        return Place(relation, distance_m=int(rest) / 100)
    if relation == "middle":
        return Place(relation, is_end=rest == "go")
    landmark, _, other = rest.partition("_")
    return Place(relation, landmark, other=other)


def room_of(text: str) -> str:
    """The kind of room named in a sentence, or ""."""
    found = _ROOM.search(text.lower())
    return found[1] if found else ""
