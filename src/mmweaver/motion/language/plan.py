"""The parsed sentence: consecutive steps, each a body activity with an optional hand activity."""

from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any, Literal

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.motion.language.places import Place

HOPPING = ("hop", "hop_one_leg")  # on the spot unless a direction is named
# Usual speeds in m/s of walks by `Step.style`; with an aid those of elderly people.
STYLED_MPS = {
    "tandem": (0.28, 0.36),
    "cane": (0.55, 0.75),
    "rollator": (0.6, 0.8),
    "crutches": (0.6, 0.8),
    "pushing": (0.6, 0.8),
}
FALLS = ("fall", "collapse", "slip")  # from the feet to the floor
FALLS_OFF = ("fall_off", "fall_out_of_bed")
FALLING_ON = "falling_on"  # Step.style of a stumble that ends in a fall


class Side(StrEnum):
    """A side of the picture, as the viewer sees it; for turns and bends the person's own."""

    LEFT = "left"
    RIGHT = "right"


class Way(StrEnum):
    """A direction of motion: relative to the body, to the radar, back to the origin, or to a seat."""

    FORWARDS = "forwards"
    BACKWARDS = "backwards"
    TOWARDS = "towards"
    AWAY = "away"
    BACK = "back"
    SEAT = "seat"


class Shape(StrEnum):
    """The shape of a path without destination: round, to and fro, half a turn, on the spot."""

    CIRCLE = "circle"
    PACING = "pacing"
    AROUND = "around"
    SPOT = "spot"


Direction = Side | Way | Shape
Hand = Literal["left", "right", "both", ""]
Foot = Literal["left", "right", ""]
_DIRECTIONS: dict[str, Direction] = {value: value for kind in (Side, Way, Shape) for value in kind}


def direction_of(name: str) -> Direction:
    """The direction with a name, such as "left" or "circle".

    >>> direction_of("away") is Way.AWAY
    True
    """
    return _DIRECTIONS[name]


@dataclass(frozen=True, kw_only=True)
class Action:
    """Activities of body and hands; hands, feet and styles of lying are the person's own left and right."""

    lower: str = "stand"  # key of a body activity
    upper: str = ""  # key of a hand activity, overlaid
    hand: Hand = ""  # "": chosen by the seed
    foot: Foot = ""  # the leg that moves
    other_hand: "Step | None" = None  # simultaneous activity of the other hand, with its hand and count
    # Manner: back, front, left, right (lying, falling), ahead (arms held out, walking), knee (one knee),
    # held, released (bending), high, up, down, under, side, wide, jog, frontlunge, FALLING_ON
    style: str = ""
    on_feet: bool = False  # the sentence contains "stands"


@dataclass(frozen=True, kw_only=True)
class Path:
    """Path or turn of the body."""

    direction: Direction | None = None
    arc_deg: float = 0.0  # bend of the path, positive to the person's left
    turn_deg: float = 0.0  # of a turn, positive to the person's left; 0: from the direction
    either_side: bool = False  # the seed chooses the side of bend or turn
    distance_m: float = 0.0  # length of a walk, if stated
    route_m: tuple[tuple[float, float], ...] = ()  # corners (x, y) of a prescribed path


@dataclass(frozen=True, kw_only=True)
class Target:
    """Destination, seat or viewing target of a step."""

    seat: str = ""  # word of the sentence: sofa, chair, ...
    target: str = ""  # Landmark.kind of the destination: door, table, ...
    place: Place | None = None  # place of the activity, or destination of the walk
    facing: str = ""  # left | right | towards | away | down | a Landmark.kind | ""


@dataclass(frozen=True, kw_only=True)
class Repetition:
    """Count, duration and speed."""

    count: int = 0  # repetitions; 0: as many as the time allows
    several: bool = False  # plural without a count: "does squats"
    seconds: float = 0.0  # duration stated by the sentence
    speed: Literal[-1, 0, 1] = 0  # -1 slowly, 1 quickly
    pace: float = 1.0  # the person's tempo, relative to the usual one
    speed_mps: float = 0.0  # speed over the floor, if stated
    steps_hz: float = 0.0  # steps per second, if stated


@dataclass(frozen=True, kw_only=True)
class Step(Action, Path, Target, Repetition):
    """One step of a plan: activity, path, target and repetition, with the words that ask for it and its time."""

    usual_hand: str = ""  # preferred hand if none is named: left | right
    clause: str = ""  # the words of the sentence
    clauses: tuple[int, ...] = ()  # indices of the MotionPlan.clauses that it realizes
    start_s: float = 0.0
    end_s: float = 0.0

    @property
    def name(self) -> str:
        """Name shown to the user.

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
        """The step in a direction, without bends and turns.

        Args:
            direction: New direction.
            **changes: Other fields to replace.
        """
        return replace(self, direction=direction, arc_deg=0.0, turn_deg=0.0, **changes)

    @property
    def each(self) -> "tuple[Step, ...]":
        """The step, followed by the activity of the other hand if there is one."""
        return (self,) if self.other_hand is None else (self, self.other_hand)

    @property
    def arms_ahead(self) -> bool:
        """Whether outstretched arms point ahead instead of to the sides; a walk has its own direction."""
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
        """Support of the body at the end: feet, seat, couch (lying on furniture), knees or floor."""
        return BY_KEY[self.lower].posture


DONE, APPROXIMATED, NOT_DONE = "done", "approximated", "not done"


@dataclass(frozen=True)
class ClauseRecord:
    """Outcome of one clause of the sentence.

    Attributes:
        clause: Words of the clause.
        status: done, approximated or not done.
        how: What is shown instead unless the words state it, and what is not shown.
        shown: Description of its steps in order (`step_names`); "" without steps.
        facts: What was measured of each of its steps on the joints; none before that.
    """

    clause: str
    status: str = DONE
    how: str = ""
    shown: str = ""
    facts: tuple[dict[str, object], ...] = ()

    @property
    def sentence(self) -> str:
        """The outcome as reported to the user."""
        if self.status == NOT_DONE:
            return f"{self.clause!r} is not done: {self.how}"
        if self.how.startswith(repr(self.clause)):
            return self.how
        return f"{self.clause!r} {self.how}" if self.how.startswith("is ") else f"in {self.clause!r}, {self.how}"

    def lowered_to(self, status: str, how: str) -> "ClauseRecord":
        """The record with a worse status, or the same status with one more reason.

        Args:
            status: done, approximated or not done; ignored if better than the present one.
            how: The reason.
        """
        order = (DONE, APPROXIMATED, NOT_DONE)
        worse = max(self.status, status, key=order.index)
        return replace(self, status=worse, how="; ".join(dict.fromkeys(filter(None, (self.how, how)))))


@dataclass(frozen=True, kw_only=True)
class MotionPlan:
    """The parsed sentence.

    Attributes:
        text: The sentence.
        steps: Steps in temporal order.
        notes: Sentences on what the parser assumed.
        clauses: Outcome of each clause.
        person: Traits of the person in the sentence.
        duration_s: Duration in seconds; 0 until the plan is scheduled.
    """

    text: str
    steps: tuple[Step, ...]
    notes: tuple[str, ...] = ()
    clauses: tuple[ClauseRecord, ...] = ()
    person: DescribedPerson = field(default_factory=DescribedPerson)
    duration_s: float = 0.0

    def __post_init__(self) -> None:
        """Sets the pace of the described person, by which the plan is scheduled; `people` adds the individual pace."""
        if self.person.age:
            paced = (
                replace(step, pace=self.person.pace(moves=step.moves)) if step.pace == 1.0 else step
                for step in self.steps
            )
            object.__setattr__(self, "steps", tuple(paced))
