"""Final state of a motion, from which the next can begin: position, heading, posture and seat."""

from dataclasses import dataclass

from mmweaver.motion.animation.carry_over import ControlsState
from mmweaver.motion.language.plan import Foot
from mmweaver.motion.planning.seating import Sitting


@dataclass(frozen=True, kw_only=True)
class BodyState:
    """Final state of a body, in the radar's frame.

    Attributes:
        position_m: Position (x, y) of the root in metres.
        heading_rad: Heading, from +x towards +y.
        posture: feet, seat, knees or floor.
        style: Side on which a lying body rests: back or front.
        foot: Knee on which a body kneels, if on one.
        sitting: The seat that is used, or directly behind.
        controls: Pose parameters with their derivatives.
    """

    position_m: tuple[float, float]
    heading_rad: float
    posture: str = "feet"
    style: str = ""
    foot: Foot = ""
    sitting: Sitting | None = None
    controls: ControlsState | None = None
