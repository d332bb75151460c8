"""What a sentence asks for: steps one after the other, each a movement of the whole body and perhaps of the arms."""

from dataclasses import dataclass

from mmweaver.motion.language.activities import BY_KEY

ON_THE_SPOT = ("jog", "leap")  # moving, unless the direction is "spot"


@dataclass(frozen=True, kw_only=True)
class Step:
    """One movement. Directions are the viewer's (left in the photo), hands and bends the person's own."""

    lower: str = "stand"  # key of a body activity
    upper: str = ""  # key of a hand activity, laid over the lower one
    hand: str = ""  # left | right | both | "" (as the seed has it)
    foot: str = ""  # left | right | "": the leg that acts
    direction: str = (
        ""  # left | right | towards | away | forwards | backwards | back | pacing | circle | seat | spot | around
    )
    arc_deg: float = 0.0  # how far the way bends, to the person's left where positive
    turn_deg: float = (
        0.0  # of a turn or a turning jump, to the person's left where positive; 0: as the direction has it
    )
    style: str = ""  # back | front (lying and falling) | bent (walking) | knee (of one knee)
    speed: int = 0  # -1 slowly, 0, 1 quickly
    count: int = 0  # how often; 0: as time allows
    seat: str = ""  # the word used for it: sofa, chair, ...
    target: str = ""  # the Landmark.kind to go to: door, table, ...
    facing: str = ""  # left | right | towards | away | ""
    seconds: float = 0.0  # how long, where the sentence says so
    on_feet: bool = False  # the sentence says that the person stands
    clause: str = ""  # the words that said so
    start_s: float = 0.0
    end_s: float = 0.0

    @property
    def name(self) -> str:
        """What a person would call it.

        >>> Step(lower="sit", upper="drink").name
        'sitting and drinking'
        """
        lower = BY_KEY[self.lower].name
        if not self.upper:
            return lower
        upper = BY_KEY[self.upper].name
        if self.upper == "raise":
            upper = {"both": "raising both hands", "": "hand raise"}.get(self.hand, f"{self.hand}-hand raise")
        return upper if self.lower == "stand" else f"{lower} and {upper}"

    @property
    def moves(self) -> bool:
        """Whether it goes from one place to another."""
        return BY_KEY[self.lower].moves and self.direction != "spot"

    @property
    def posture(self) -> str:
        """How it leaves the body: feet, seat, knees or floor."""
        return BY_KEY[self.lower].posture


@dataclass(frozen=True, kw_only=True)
class MotionPlan:
    """The steps of a sentence in the order of time; `notes` are sentences about what was assumed in reading it."""

    text: str
    steps: tuple[Step, ...]
    notes: tuple[str, ...] = ()
    duration_s: float = 0.0  # 0 until the plan is scheduled
