"""Final state of a motion, from which the next can begin: position, heading, posture and seat."""

from dataclasses import dataclass

from mmweaver.motion.animation.carry_over import ControlsState
from mmweaver.motion.language.plan import Foot
from mmweaver.motion.planning.seating import Sitting


@dataclass(frozen=True, kw_only=True)
class BodyState:
    """Position (x, y) of a body's root in metres, its heading and its posture, in the radar's frame."""

    position_m: tuple[float, float]
    heading_rad: float  # from +x towards +y
    posture: str = "feet"  # feet | seat | knees | floor
    style: str = ""  # of lying: back | front
    foot: Foot = ""  # of kneeling on one knee
    sitting: Sitting | None = None  # the seat that is used, or that is right behind
    controls: ControlsState | None = None  # how the body moves there
