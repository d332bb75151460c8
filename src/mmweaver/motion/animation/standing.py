"""Standing: the pose from which every other activity starts and to which it returns, with sway and breathing."""

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT, Controls
from mmweaver.motion.animation.profiles import wander
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions

if TYPE_CHECKING:
    from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
STAND_STRETCH = 0.9955  # of the legs' length
ANKLE_BEHIND = 0.022  # of the height: the pelvis is slightly in front of the ankles
HALF_STANCE = 0.056  # of the height: from the midline to a foot
TOES_OUT_RAD = 0.12
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
    """Controls of a body standing at the root, arms hanging, with sway and breathing.

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
    _sway(controls, time_s, rng)
    return controls


def _sway(controls: Controls, time_s: Float[Array, " n"], rng: np.random.Generator) -> None:
    """Quiet standing: millimetres at the pelvis, half a degree in the trunk, a breath every three to five seconds."""
    controls.pelvis_m[:, 0] += 0.004 * wander(time_s, rng, slow_hz=0.15, fast_hz=0.6)
    controls.pelvis_m[:, 1] += 0.004 * wander(time_s, rng, slow_hz=0.15, fast_hz=0.6)
    for axis in range(3):
        controls.spine_rad[:, axis] += 0.012 * wander(time_s, rng, slow_hz=0.15, fast_hz=0.7)
    breath = np.sin(2 * np.pi * rng.uniform(0.2, 0.33) * time_s + rng.uniform(0, 2 * np.pi))
    controls.spine_rad[:, 1] -= 0.012 * breath
    controls.head_rad[:, 0] += 0.012 * breath + 0.02 * wander(time_s, rng, slow_hz=0.1, fast_hz=0.5)
    controls.head_rad[:, 1] += 0.03 * wander(time_s, rng, slow_hz=0.1, fast_hz=0.5)
    for side in (LEFT, RIGHT):
        controls.arm_rad[:, side, 0] += 0.025 * wander(time_s, rng, slow_hz=0.2, fast_hz=0.8) - 0.01 * breath
        controls.arm_rad[:, side, 1] += 0.012 * wander(time_s, rng, slow_hz=0.2, fast_hz=0.8)
        controls.arm_rad[:, side, 3] += 0.03 * rng.normal()
