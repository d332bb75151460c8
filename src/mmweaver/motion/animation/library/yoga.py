"""Three standing poses of yoga, entered from standing and held."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    lean_over,
    leg_side,
    lift_weight,
    mix_arm,
    shift_foot,
    shift_pelvis,
    vary,
)
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import bump, plateau, reached
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray
PerTime = Float[Array, " n"]


def _held(context: StepContext, into_s: float) -> PerTime:
    """0 standing, 1 in the pose: entered and left within the step."""
    into_s = min(into_s, 0.35 * context.duration_s)
    return plateau(context.time_s, context.start_s, context.end_s, into_s, into_s)


def tree_pose(context: StepContext) -> Controls:
    """One foot against the other leg's knee, that knee out to the side, palms together over the head."""
    controls, body, h = upright(context), context.body, context.body.height_m
    side, held = leg_side(context), _held(context, 1.6)
    lean_over(controls, body, 1 - side, reached(2.0 * held))
    lift_weight(controls, side, reached(3.0 * held))
    shift_foot(
        controls, side, 0.02 * h * held, -vary(context, 0.052, 0.05) * h * held, vary(context, 0.24, 0.08) * h * held
    )
    controls.knee_out_rad[:, side] += 1.25 * held
    controls.foot_rad[:, side, 1] += 0.9 * held
    for arm in (LEFT, RIGHT):
        mix_arm(controls, arm, np.tile([2.75, 0.35, 0.2, 0.75], (len(held), 1)), held)
    return controls


def warrior_pose(context: StepContext) -> Controls:
    """A wide stance, one knee bent over its foot, the arms out to front and back, the face over the front hand."""
    controls, h = upright(context), context.body.height_m
    front, held = leg_side(context), _held(context, 1.4)
    back = 1 - front
    wide = vary(context, 0.26, 0.06) * h
    for side, share in ((front, 1.0), (back, 0.75)):
        shift_foot(controls, side, 0.0, share * wide * held, 0.03 * h * bump(held) * (side == front))
    controls.foot_rad[:, front, 0] += OUTWARD[front] * 1.3 * held
    shift_pelvis(controls, 0.0, OUTWARD[front] * 0.1 * h * held, -vary(context, 0.12, 0.08) * h * held)
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.8 * held)
    controls.head_rad[:, 1] += OUTWARD[front] * 1.2 * held
    for arm in (LEFT, RIGHT):
        mix_arm(controls, arm, np.tile([0.0, 1.53, 0.0, 0.08], (len(held), 1)), held)
    return controls


def downward_dog(context: StepContext) -> Controls:
    """Hands and feet on the floor, the hips high: the body is a roof."""
    controls, h = upright(context), context.body.height_m
    held = _held(context, 1.5)
    shift_pelvis(controls, 0.27 * h * held, 0.0, -0.07 * h * held)
    controls.pelvis_rad[:, 1] += 2.05 * held
    controls.spine_rad[:, 1] += 0.1 * held
    controls.head_rad[:, 0] += 0.1 * held
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.5 * bump(held))
    for side in (LEFT, RIGHT):
        controls.foot_rad[:, side, 1] += 0.35 * held
        mix_arm(controls, side, np.tile([2.75, 0.12, 0.0, 0.08], (len(held), 1)), held)
    return controls
