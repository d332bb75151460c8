"""On the floor: push-ups, sit-ups and crawling. Down there already, as in the middle of the exercise."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.kinematics import ankle_from_foot
from mmweaver.motion.animation.library.movement_primitives import (
    cycles,
    hand_to,
    mix_arm,
    place,
    shift_foot,
    shift_pelvis,
    vary,
)
from mmweaver.motion.animation.library.on_the_floor import KNEELING_M, lying
from mmweaver.motion.animation.library.standing import ANKLE_BEHIND, STAND_STRETCH, upright
from mmweaver.motion.animation.profiles import rise
from mmweaver.motion.animation.step_context import StepContext

_UP_RAD, _DOWN_RAD = 0.32, 0.06  # of the straight body over the floor, arms stretched and bent
_ON_TOES_RAD = 1.35  # pitch of the feet
_TURNING_M = 0.3  # of a limb from the middle about which the body turns
_LIFTING_S = 0.15  # within which limbs begin and end to leave the floor
_FASTEST_TURNING_MPS = 0.35  # of limbs in a turn: before they are on the floor, people turn faster than they crawl
_STRIDE_M, _SHIN = 0.35, 0.318  # of crawling; from the knee back to the ankle, of the height


def plank(context: StepContext) -> Controls:
    """The upper position of a push-up, held."""
    return _on_hands(context, np.zeros_like(context.time_s))


def push_ups(context: StepContext) -> Controls:
    """The body stays straight from the heels to the head and goes down and up on the arms; the root is at the feet."""
    rate, end = cycles(context, context.tempo(0.35, 0.55, 0.8), 0.3, 1.1)
    until = np.minimum(context.time_s, end) if context.step.count else context.time_s  # a count ends stretched
    phase = 2 * np.pi * rate * (until - context.start_s)
    return _on_hands(context, 0.5 - 0.5 * np.cos(phase))


def _on_hands(context: StepContext, down: Float[np.ndarray, " n"]) -> Controls:
    """down (n,) = 0 arms stretched, 1 bent."""
    controls, body, h = upright(context), context.body, context.body.height_m
    depth = vary(context, 0.92, 0.05)
    slope = _UP_RAD + np.minimum(depth, 1.0) * down * (_DOWN_RAD - _UP_RAD)
    leg, pitch = 0.995 * (body.leg_m + body.hip_below_pelvis_m), np.array([_ON_TOES_RAD])
    ankle = ankle_from_foot(body, np.zeros(1), pitch)[0]
    stand = body.pelvis_height_m(STAND_STRETCH)
    ahead = ankle[0] - ANKLE_BEHIND * h + leg * np.cos(slope)
    shift_pelvis(controls, ahead, 0.0, ankle[2] + leg * np.sin(slope) - stand)
    controls.pelvis_rad[:, 1] += 0.5 * np.pi - slope
    controls.spine_rad[:] = 0.0
    controls.head_rad[:, 0] -= 0.35
    for side in (LEFT, RIGHT):
        controls.foot_rad[:, side, 1] += _ON_TOES_RAD
    controls.knee_up_rad[:] -= 1.45
    controls.knee_room[:] = 1.0
    straight = np.tile([1.57 - 0.3, 0.15, 0.0, 0.1], (len(down), 1))
    bent = np.tile([-0.25, 0.45, 0.0, 1.95], (len(down), 1))
    for side in (LEFT, RIGHT):
        mix_arm(controls, side, straight + down[:, None] * (bent - straight), np.ones_like(down))
    return controls


def sit_ups(context: StepContext) -> Controls:
    """On the back, knees bent, arms crossed on the chest: the trunk curls up until it is upright, and goes down."""
    rate, end = cycles(context, context.tempo(0.28, 0.42, 0.6), 0.25, 0.8)
    until = np.minimum(context.time_s, end) if context.step.count else context.time_s  # a count ends lying
    up = 0.5 - 0.5 * np.cos(2 * np.pi * rate * (until - context.start_s))
    controls, n = lying(context), len(up)
    rise_rad = min(vary(context, 1.2, 0.05), 1.3)
    controls.pelvis_rad[:, 1] += rise_rad * up
    controls.spine_rad[:, 1] += 0.7 * np.sin(0.5 * np.pi * up)
    controls.head_rad[:, 0] += 0.25
    shift_pelvis(controls, 0.0, 0.0, 0.012 * context.body.height_m * up)
    for side, ahead in ((LEFT, 0.13), (RIGHT, 0.105)):
        hand_to(controls, context.body, side, place(ahead, -0.05, 0.03, n), np.ones(n), (-0.1, 0.8, -1.0))
    return controls


def crawling(context: StepContext) -> Controls:
    """On hands and knees; a knee and the opposite hand go ahead together."""
    controls, body, h = upright(context), context.body, context.body.height_m
    gone_m, going = _crawled(context)
    phase = 2 * np.pi / vary(context, _STRIDE_M, 0.08) * gone_m
    stand = body.pelvis_height_m(STAND_STRETCH)
    shift_pelvis(controls, 0.0, 0.0, 0.95 * KNEELING_M * h - stand + 0.008 * h * np.cos(2 * phase))
    controls.pelvis_rad[:, 1] += 1.25
    controls.pelvis_rad[:, 2] += 0.08 * np.sin(phase)
    controls.head_rad[:, 0] -= 0.7
    controls.knee_room[:] = 1.0
    for side, sign in ((LEFT, 1.0), (RIGHT, -1.0)):
        ahead = 0.5 * _STRIDE_M * np.sin(phase) * sign
        air = rise(sign * np.cos(phase) + 0.3) * going
        shift_foot(controls, side, ahead - _SHIN * h, -0.01 * h, 0.02 * h * air)
        controls.foot_rad[:, side, 1] += 1.42
        swing = -sign * np.sin(phase)  # the opposite hand
        arm = np.tile([1.3, 0.08, 0.0, 0.15], (len(phase), 1))
        arm[:, 0] += 0.28 * swing
        arm[:, 3] += 0.35 * rise(-sign * np.cos(phase) + 0.3) * going
        mix_arm(controls, side, arm, np.ones_like(phase))
    return controls


def _crawled(context: StepContext) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """How far the limbs have carried the body, in metres, and 1 while it goes or turns; at an even pace on the spot."""
    time_s, path = context.time_s, context.path
    if not context.moves:
        return 0.15 * (time_s - context.start_s), np.ones_like(time_s)
    turning_mps = _TURNING_M * np.abs(path.facing_rad(time_s + 1e-3) - path.facing_rad(time_s - 1e-3)) / 2e-3
    speed_mps = path.speed_mps(time_s) + np.minimum(turning_mps, _FASTEST_TURNING_MPS)
    steps_m = 0.5 * (speed_mps[1:] + speed_mps[:-1]) * np.diff(time_s)
    gone_m = np.concatenate([[0.0], np.cumsum(steps_m)])
    before_m, after_m = (np.interp(time_s + lag, time_s, gone_m) for lag in (-_LIFTING_S, _LIFTING_S))
    return gone_m, rise((after_m - before_m) / (2 * _LIFTING_S) / 0.12)
