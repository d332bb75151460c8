"""What a sentence asks for: steps one after the other, each a movement of the whole body and perhaps of the arms."""

from dataclasses import dataclass

LOWER = (
    "stand", "walk", "jog", "turn", "sit", "sit_down", "stand_up", "squat", "jump", "jumping_jacks",
)  # fmt: skip
UPPER = ("wave", "clap", "raise", "drink", "punch")
KNOWN = (
    "walking, jogging, turning, standing still, sitting, sitting down, standing up, drinking, waving, clapping,"
    " raising the left or right hand, punching, squatting, jumping, jumping jacks"
)


@dataclass(frozen=True, kw_only=True)
class Step:
    """One movement. Directions are the viewer's (left in the photo), hands the person's own."""

    lower: str = "stand"  # one of LOWER
    upper: str = ""  # one of UPPER, laid over the lower one
    hand: str = ""  # left | right | both | "" (as the seed has it)
    direction: str = (
        ""  # left | right | towards | away | forwards | backwards | back | pacing | circle | seat | spot | around
    )
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
        lower = _LOWER_NAMES[self.lower]
        if not self.upper:
            return lower
        upper = _UPPER_NAMES[self.upper]
        if self.upper == "raise":
            upper = {"both": "raising both hands", "": "hand raise"}.get(self.hand, f"{self.hand}-hand raise")
        return upper if self.lower == "stand" else f"{lower} and {upper}"

    @property
    def moves(self) -> bool:
        """Whether it goes from one place to another."""
        return self.lower in ("walk", "jog") and self.direction != "spot"


_LOWER_NAMES = {
    "stand": "standing", "walk": "walking", "jog": "jogging", "turn": "turning", "sit": "sitting",
    "sit_down": "sitting down", "stand_up": "standing up", "squat": "squatting", "jump": "jumping",
    "jumping_jacks": "jumping jacks",
}  # fmt: skip
_UPPER_NAMES = {"wave": "waving", "clap": "clapping", "raise": "raising", "drink": "drinking", "punch": "punching"}


@dataclass(frozen=True, kw_only=True)
class MotionPlan:
    """The steps of a sentence in the order of time; `notes` are sentences about what was assumed in reading it."""

    text: str
    steps: tuple[Step, ...]
    notes: tuple[str, ...] = ()
