"""The parsed sentence: steps one after the other, each a body activity and possibly a hand activity over it."""

from dataclasses import dataclass, field, replace

from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.motion.language.places import Place

HOPPING = ("hop", "hop_one_leg")  # on the spot unless a way is named
FALLING_ON = "falling_on"  # Step.style of a stumble that ends in a fall


@dataclass(frozen=True, kw_only=True)
class Step:
    """One step. Directions are the viewer's (left in the photo), hands, feet and bends the person's own."""

    lower: str = "stand"  # key of a body activity
    upper: str = ""  # key of a hand activity, overlaid
    other_hand: "Step | None" = None  # what the other hand does meanwhile: a hand activity, its hand and count
    hand: str = ""  # left | right | both | "" (chosen by the seed)
    foot: str = ""  # left | right | "": the leg that moves
    direction: str = (
        ""  # left | right | towards | away | forwards | backwards | back | pacing | circle | seat | spot | around
    )
    arc_deg: float = 0.0  # bend of the path, to the person's left where positive
    turn_deg: float = 0.0  # of a turn, to the person's left where positive; 0: by the direction
    style: str = (
        ""  # back | front (lying and falling) | bent (walking) | ahead (arms held out, walking) | knee (of one knee)
    )
    speed: int = 0  # -1 slowly, 0, 1 quickly
    count: int = 0  # repetitions; 0: as many as the time allows
    seat: str = ""  # the word of the sentence: sofa, chair, ...
    target: str = ""  # the Landmark.kind to go to: door, table, ...
    place: Place | None = None  # where it is done, or the walk goes
    distance_m: float = 0.0  # how far a walk goes, where the sentence says so
    route_m: tuple[tuple[float, float], ...] = ()  # the corners (x, y) of a path that is given
    facing: str = ""  # left | right | towards | away | down | a Landmark.kind | ""
    seconds: float = 0.0  # the duration that the sentence gives
    pace: float = 1.0  # the person's tempo, relative to the usual one
    usual_hand: str = ""  # left | right: mostly used where the sentence names none
    on_feet: bool = False  # the sentence says "stands"
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

    @property
    def each(self) -> "tuple[Step, ...]":
        """The step, and what the other hand does."""
        return (self,) if self.other_hand is None else (self, self.other_hand)

    @property
    def arms_ahead(self) -> bool:
        """Whether arms that are held out are ahead, not to the sides; a walk has its own direction."""
        ahead = self.style == "ahead" if self.moves else self.direction == "forwards"
        return self.upper == "arms_out" and ahead

    @property
    def moves(self) -> bool:
        """Whether the position on the floor changes."""
        if self.lower in HOPPING:
            return self.direction not in ("", "spot")
        return BY_KEY[self.lower].moves and self.direction != "spot"

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
