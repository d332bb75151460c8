"""Bending the trunk: bowing, bending down, leaning, twisting, picking up from the floor and putting down."""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    crouched,
    cycles,
    mix_arm,
    repeats,
    shift_pelvis,
    sides,
)
from mmweaver.motion.animation.library.standing import upright
from mmweaver.motion.animation.profiles import plateau
from mmweaver.motion.animation.step_context import StepContext

PerTime = np.ndarray


def bowing(context: StepContext) -> Controls:
    """The straight trunk leans forward from the hips, which move back a little; holds, and comes up."""
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    deep = float(context.rng.uniform(0.55, 0.95))
    arms = int(context.rng.integers(3))  # arms at the sides, hands on the thighs, one hand in front of the belly
    for begin, lasts in repeats(context, 2.1, 1.25, 3.2):
        down = plateau(time_s, begin, begin + lasts, 0.38 * lasts, 0.4 * lasts)
        _hinge(controls, h, down, deep)
        if arms == 1:
            controls.arm_rad[:, :, 0] += (0.55 * deep * down)[:, None]
        elif arms == 2:
            arm = np.tile([0.35, 0.25, -0.9, 1.5], (len(time_s), 1))
            mix_arm(controls, RIGHT, arm, down)
        else:
            controls.arm_rad[:, :, 0] += (0.2 * deep * down)[:, None]
    return controls


def _hinge(controls: Controls, height_m: float, down: PerTime, angle_rad: float) -> None:
    """Bends at the hips by an angle, scaled by `down` (n,); the pelvis moves back to keep the balance."""
    shift_pelvis(controls, -0.085 * height_m * np.sin(angle_rad) * down, 0.0, -0.01 * height_m * down)
    controls.pelvis_rad[:, 1] += 0.62 * angle_rad * down
    controls.spine_rad[:, 1] += 0.38 * angle_rad * down
    controls.head_rad[:, 0] += 0.1 * down
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.5 * down)


_BEYOND_S = 10.0  # longer than it takes to come up


def _spells(context: StepContext, usual_s: float, least_s: float, most_s: float) -> list[tuple[float, float]]:
    """(start, duration) of each time that the body is down, in seconds; once, all the time, where it is held.

    Who stays down at the end of a sequence is down in its last frame, unless the hands have something to do meanwhile.
    """
    if context.step.style in ("held", "released"):
        stays = context.last and context.step.style == "held" and not context.step.upper
        return [(context.start_s, context.duration_s + _BEYOND_S * stays)]
    return list(repeats(context, usual_s, least_s, most_s))


def bending(context: StepContext) -> Controls:
    """Far down with nearly straight legs, the hands towards the feet, and up again."""
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    deep = float(context.rng.uniform(1.35, 1.75))
    for begin, lasts in _spells(context, 2.3, 1.5, 3.4):
        move = 0.42 * min(lasts, context.duration_s, 3.4)
        down = plateau(time_s, begin, begin + lasts, move, move)
        _hinge(controls, h, down, deep)
        shift_pelvis(controls, 0.0, 0.0, -0.025 * h * down)
        controls.arm_rad[:, :, 0] += (0.95 * deep * down)[:, None]
    return controls


def leaning(context: StepContext) -> Controls:
    """The trunk leans to one side or back and comes up; to both sides in turn where none is named."""
    controls, time_s, h = upright(context), context.time_s, context.body.height_m
    deep = float(context.rng.uniform(0.4, 0.6))
    for k, (begin, lasts) in enumerate(_spells(context, 2.0, 1.2, 3.0)):
        move = 0.4 * min(lasts, context.duration_s, 3.0)
        down = plateau(time_s, begin, begin + lasts, move, move)
        if context.step.direction == "backwards":
            shift_pelvis(controls, 0.05 * h * down, 0.0, -0.01 * h * down)
            controls.pelvis_rad[:, 1] -= 0.15 * deep * down
            controls.spine_rad[:, 1] -= 0.7 * deep * down
            controls.head_rad[:, 0] += 0.2 * down
            continue
        left_first = context.step.direction != "right"
        right = -1.0 if left_first == (k % 2 == 0 or bool(context.step.direction)) else 1.0  # roll: right side down
        shift_pelvis(controls, 0.0, 0.035 * h * right * down, -0.006 * h * down)
        controls.pelvis_rad[:, 0] += 0.15 * deep * right * down
        controls.spine_rad[:, 0] += deep * right * down
    return controls


def twisting(context: StepContext) -> Controls:
    """The trunk turns to one side and the other over feet that stay, forearms level in front."""
    controls, time_s = upright(context), context.time_s
    rate, end_s = cycles(context, context.tempo(0.3, 0.45, 0.7), 0.25, 0.9)
    on = plateau(time_s, context.start_s, end_s, 0.5, 0.5)
    yaw = on * np.sin(2 * np.pi * rate * (time_s - context.start_s))
    wide = float(context.rng.uniform(0.65, 0.9))
    controls.pelvis_rad[:, 2] += 0.35 * wide * yaw
    controls.spine_rad[:, 2] += wide * yaw
    for side in (LEFT, RIGHT):
        mix_arm(controls, side, np.tile([0.35, 0.3, 0.5, 1.5], (len(time_s), 1)), on)
    return controls


def picking_up(context: StepContext) -> Controls:
    """Knees and hips bend, the hand reaches the floor in front of the feet and brings something up to the belly."""
    controls, time_s = upright(context), context.time_s
    arms = sides(context)
    hold_s = 0.0
    for begin, lasts in repeats(context, 2.3, 1.6, 3.4):
        down = plateau(time_s, begin, begin + 0.92 * lasts, 0.44 * lasts, 0.44 * lasts)
        _to_the_floor(controls, context, down, arms)
        hold_s = begin + 0.5 * lasts
    carried = plateau(time_s, hold_s, context.end_s + 0.2, 0.7, 0.5)
    _hold(controls, context, carried, arms)
    return controls


def putting_down(context: StepContext) -> Controls:
    """Something held in front of the body is put on the floor, and the body comes up without it."""
    controls, time_s = upright(context), context.time_s
    arms = sides(context)
    hold_s = context.end_s
    for begin, lasts in repeats(context, 2.3, 1.6, 3.4):
        _to_the_floor(controls, context, plateau(time_s, begin, begin + lasts, 0.44 * lasts, 0.44 * lasts), arms)
        hold_s = begin + 0.5 * lasts
    _hold(controls, context, plateau(time_s, context.start_s - 0.4, hold_s, 0.5, 0.7), arms)
    return controls


def _to_the_floor(controls: Controls, context: StepContext, down: PerTime, arms: tuple[int, ...]) -> None:
    """Down until the hands are near the floor, more by the knees or more by the back, as the seed decides."""
    depth = float(context.rng.uniform(0.72, 0.95))
    crouched(controls, context.body, depth * down, lean_rad=1.5 / depth)
    for side in (LEFT, RIGHT):
        if side in arms:
            controls.arm_rad[:, side, 0] += 1.5 * down
            controls.arm_rad[:, side, 1] -= 0.1 * down
        else:
            controls.arm_rad[:, side, 0] += 0.5 * down
            controls.arm_rad[:, side, 3] += 0.6 * down
    if len(arms) == 1:
        controls.spine_rad[:, 0] += (0.12 if arms[0] == RIGHT else -0.12) * down


def _hold(controls: Controls, context: StepContext, share: PerTime, arms: tuple[int, ...]) -> None:
    """Forearms level in front of the belly, once the trunk is upright."""
    up = share * np.clip(1 - 0.8 * controls.pelvis_rad[:, 1], 0, 1)
    for side in arms:
        controls.arm_rad[:, side, 3] += 1.25 * up
        controls.arm_rad[:, side, 0] += 0.12 * up
