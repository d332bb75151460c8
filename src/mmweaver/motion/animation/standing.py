"""Standing: the pose from which every other activity starts and to which it returns.

It is at rest: sway, breathing and tremor are added to all poses by `motion.physiology`.
"""

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT, Controls
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions

if TYPE_CHECKING:
    from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
STAND_STRETCH = 0.9955  # of the legs' length
ANKLE_BEHIND = 0.022  # of the height: the pelvis is slightly in front of the ankles
HALF_STANCE = 0.056  # of the height: from the midline to a foot
TOES_OUT_RAD = 0.12
UNUSED = (74, 16)  # random numbers before the first arm, and between the arms
ARM_HANGING = (-0.02, 0.13, 0.0, 0.22)  # flexion, abduction, twist, elbow


def home_feet(
    body: SkeletonProportions,
    position_m: Float[Array, "n 2"],
    heading_rad: Float[Array, " n"],
    half_stance: float = HALF_STANCE,
) -> Float[Array, "n 2 3"]:
    """Positions of both feet of a standing body, flat on the floor.

    Args:
        body: Bone lengths.
        position_m: Root (x, y) in metres, (n, 2).
        heading_rad: Heading (n,) from +x towards +y.
        half_stance: Distance of a foot from the midline as a share of the height.

    Returns:
        Metres, (n, 2, 3), left foot first.
    """
    aside = np.array(OUTWARD) * half_stance * body.height_m
    behind = -ANKLE_BEHIND * body.height_m
    cos, sin = np.cos(heading_rad)[:, None], np.sin(heading_rad)[:, None]
    x = position_m[:, :1] + behind * cos - aside * sin
    y = position_m[:, 1:] + behind * sin + aside * cos
    return np.stack([x, y, np.zeros_like(x)], axis=-1)


def upright(context: "StepContext") -> Controls:
    """Controls of a body standing at the root, arms hanging.

    Args:
        context: Step with times, body, path and random stream.
    """
    body, time_s, rng = context.body, context.time_s, context.rng
    n = len(time_s)
    position, heading = context.path.position_m(time_s), context.path.facing_rad(time_s)
    pelvis = np.zeros((n, 3))
    pelvis[:, :2] = position
    pelvis[:, 2] = body.pelvis_height_m(STAND_STRETCH)
    foot_rad = np.zeros((n, 2, 2))
    foot_rad[:, :, 0] = heading[:, None] + np.array(OUTWARD) * TOES_OUT_RAD
    controls = Controls(
        pelvis_m=pelvis,
        heading_rad=heading,
        pelvis_rad=np.zeros((n, 3)),
        spine_rad=np.zeros((n, 3)),
        head_rad=np.zeros((n, 2)),
        arm_rad=np.tile(np.array(ARM_HANGING), (n, 2, 1)),
        foot_m=home_feet(body, position, heading),
        foot_rad=foot_rad,
        knee_out_rad=np.full((n, 2), 0.05),
        knee_up_rad=np.zeros(n),
        roll_over_rad=np.zeros(n),
        knee_room=np.zeros(n),
        contact=np.ones((n, 2)),
    )
    rng.random(UNUSED[0])  # the numbers of an earlier sway, so that activities keep those that they sample
    for side in (LEFT, RIGHT):
        controls.arm_rad[:, side, 3] += 0.03 * rng.normal()
        rng.random(UNUSED[1] * (side == LEFT))
    return controls
