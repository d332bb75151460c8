"""The parsed sentence: steps one after the other, each a body activity and possibly a hand activity over it."""

from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, Literal

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.motion.language.places import Place

HOPPING = ("hop", "hop_one_leg")  # on the spot unless a way is named
FALLING_ON = "falling_on"  # Step.style of a stumble that ends in a fall


class Side(StrEnum):
    """A side of the picture, as the viewer sees it; of turns and bends the person's own."""

    LEFT = "left"
    RIGHT = "right"


class Way(StrEnum):
    """A way that the body goes: as it faces, seen from the radar, back the way it came, or to a seat."""

    FORWARDS = "forwards"
    BACKWARDS = "backwards"
    TOWARDS = "towards"
    AWAY = "away"
    BACK = "back"
    SEAT = "seat"


class Shape(StrEnum):
    """The shape of a path that leads nowhere: round, to and fro, half a turn, on the spot."""

    CIRCLE = "circle"
    PACING = "pacing"
    AROUND = "around"
    SPOT = "spot"


Direction = Side | Way | Shape
Hand = Literal["left", "right", "both", ""]
Foot = Literal["left", "right", ""]
_DIRECTIONS: dict[str, Direction] = {value: value for kind in (Side, Way, Shape) for value in kind}


def direction_of(name: str) -> Direction:
    """The direction of a name, such as "left" or "circle".

    >>> direction_of("away") is Way.AWAY
    True
    """
    return _DIRECTIONS[name]


@dataclass(frozen=True, kw_only=True)
class Action:
    """What body and hands do; hands, feet and styles of lying are the person's own left and right."""

    lower: str = "stand"  # key of a body activity
    upper: str = ""  # key of a hand activity, overlaid
    hand: Hand = ""  # "": chosen by the seed
    foot: Foot = ""  # the leg that moves
    other_hand: "Step | None" = None  # what the other hand does meanwhile: a hand activity, its hand and count
    # How it is done: back, front, left, right (lying, falling), ahead (arms held out, walking), knee (of one knee),
    # held, released (bending), high, up, down, under, side, wide, jog, frontlunge, FALLING_ON
    style: str = ""
    on_feet: bool = False  # the sentence says "stands"


@dataclass(frozen=True, kw_only=True)
class Path:
    """Where the body goes or turns, and how far."""

    direction: Direction | None = None
    arc_deg: float = 0.0  # bend of the path, to the person's left where positive
    turn_deg: float = 0.0  # of a turn, to the person's left where positive; 0: by the direction
    either_side: bool = False  # bend or turn go to a side that the seed chooses
    distance_m: float = 0.0  # how far a walk goes, where the sentence says so
    route_m: tuple[tuple[float, float], ...] = ()  # the corners (x, y) of a path that is given


@dataclass(frozen=True, kw_only=True)
class Target:
    """What a step goes to, sits on or looks at."""

    seat: str = ""  # the word of the sentence: sofa, chair, ...
    target: str = ""  # the Landmark.kind to go to: door, table, ...
    place: Place | None = None  # where it is done, or the walk goes
    facing: str = ""  # left | right | towards | away | down | a Landmark.kind | ""


@dataclass(frozen=True, kw_only=True)
class Repetition:
    """How often, how long and how fast."""

    count: int = 0  # repetitions; 0: as many as the time allows
    several: bool = False  # more than once, where there is no count: "does squats"
    seconds: float = 0.0  # the duration that the sentence gives
    speed: Literal[-1, 0, 1] = 0  # -1 slowly, 1 quickly
    pace: float = 1.0  # the person's tempo, relative to the usual one


@dataclass(frozen=True, kw_only=True)
class Step(Action, Path, Target, Repetition):
    """One step of a plan: what is done, which way, to what, how often; the words that ask for it, and its time."""

    usual_hand: str = ""  # left | right: mostly used where the sentence names none
    clause: str = ""  # the words of the sentence
    clauses: tuple[int, ...] = ()  # which of MotionPlan.clauses it carries out
    start_s: float = 0.0
    end_s: float = 0.0

    @property
    def name(self) -> str:
        """What is shown to the user.

        >>> Step(lower="sit", upper="drink").name
        'sitting and drinking'
        """
        lower = BY_KEY[self.lower].name
        if not self.upper:
            return lower
        upper = BY_KEY[self.upper].name
        if self.upper == "raise":
            upper = {"both": "raising both hands", "": "hand raise"}.get(self.hand, f"{self.hand}-hand raise")
        upper = upper if self.other_hand is None else f"{upper} and {self.other_hand.name}"
        return upper if self.lower == "stand" else f"{lower} and {upper}"

    def straight(self, direction: Direction | None = None, **changes: Any) -> "Step":
        """The step in a direction, without bends and turns, and with other changes."""
        return replace(self, direction=direction, arc_deg=0.0, turn_deg=0.0, **changes)

    @property
    def each(self) -> "tuple[Step, ...]":
        """The step, and what the other hand does."""
        return (self,) if self.other_hand is None else (self, self.other_hand)

    @property
    def arms_ahead(self) -> bool:
        """Whether arms that are held out are ahead, not to the sides; a walk has its own direction."""
        ahead = self.style == "ahead" if self.moves else self.direction == Way.FORWARDS
        return self.upper == "arms_out" and ahead

    @property
    def moves(self) -> bool:
        """Whether the position on the floor changes."""
        if self.lower in HOPPING:
            return self.direction not in (None, Shape.SPOT)
        return BY_KEY[self.lower].moves and self.direction != Shape.SPOT

    @property
    def uses_seat(self) -> bool:
        """Whether it needs a seat, bed or couch."""
        return BY_KEY[self.lower].uses_seat

    @property
    def posture(self) -> str:
        """What the body rests on at the end: feet, seat, couch (lying on furniture), knees or floor."""
        return BY_KEY[self.lower].posture


DONE, APPROXIMATED, NOT_DONE = "done", "approximated", "not done"


@dataclass(frozen=True)
class ClauseRecord:
    """What became of one clause of the sentence; `how` says what is shown unless the words do, and what is not."""

    clause: str
    status: str = DONE  # done | approximated | not done
    how: str = ""
    shown: str = ""  # all that its steps show, in their order (`step_names`); "" where it has none

    @property
    def sentence(self) -> str:
        """What became of it, as it is said to the user."""
        if self.status == NOT_DONE:
            return f"{self.clause!r} is not done: {self.how}"
        if self.how.startswith(repr(self.clause)):
            return self.how
        return f"{self.clause!r} {self.how}" if self.how.startswith("is ") else f"in {self.clause!r}, {self.how}"

    def lowered_to(self, status: str, how: str) -> "ClauseRecord":
        """The record with a worse status, or the same one with one more reason."""
        order = (DONE, APPROXIMATED, NOT_DONE)
        worse = max(self.status, status, key=order.index)
        return replace(self, status=worse, how="; ".join(dict.fromkeys(filter(None, (self.how, how)))))


@dataclass(frozen=True, kw_only=True)
class MotionPlan:
    """The steps of a sentence in temporal order; `notes` are sentences on what the parser assumed."""

    text: str
    steps: tuple[Step, ...]
    notes: tuple[str, ...] = ()
    clauses: tuple[ClauseRecord, ...] = ()
    person: DescribedPerson = field(default_factory=DescribedPerson)
    duration_s: float = 0.0  # 0 until the plan is scheduled

    def __post_init__(self) -> None:
        """Steps get the pace of people as described, by which the plan is scheduled; `people` adds the person's own."""
        if self.person.age:
            paced = (
                replace(step, pace=self.person.pace(moves=step.moves)) if step.pace == 1.0 else step
                for step in self.steps
            )
            object.__setattr__(self, "steps", tuple(paced))
