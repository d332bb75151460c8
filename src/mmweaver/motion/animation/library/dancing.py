"""Dancing on the spot: weight from side to side on the beat, feet that step and touch, knees, hips and arms."""

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import OUTWARD, mix_arm, shift_foot, shift_pelvis, vary
from mmweaver.motion.animation.library.standing import SIDE_SIGN, upright
from mmweaver.motion.animation.profiles import bump, plateau, rise
from mmweaver.motion.animation.step_context import StepContext

Array = np.ndarray


def dancing(context: StepContext) -> Controls:
    """Step-touch: on every second beat a foot goes out and comes back while the weight is on the other one."""
    controls, time_s, rng, h = upright(context), context.time_s, context.rng, context.body.height_m
    beat_hz = context.tempo(1.4, 1.8, 2.2)
    on = np.ones_like(time_s)
    if not context.first:
        on = rise((time_s - context.start_s) / 0.5)
    if not context.last:
        on = on * rise((context.end_s - time_s) / 0.5)
    beat = beat_hz * (time_s - context.start_s)
    lead = float(rng.choice([-1.0, 1.0]))
    sway = lead * np.sin(np.pi * beat) * on  # +1: the weight is on the left
    shift_pelvis(controls, 0.0, 0.042 * h * sway, -on * h * (0.014 + 0.011 * (0.5 - 0.5 * np.cos(2 * np.pi * beat))))
    controls.knee_room[:] = np.maximum(controls.knee_room, on)
    _feet(controls, context, beat, lead, on)
    hip, chest = vary(context, 0.14), vary(context, 0.18)
    controls.pelvis_rad[:, 2] += hip * sway
    controls.spine_rad[:, 2] -= 1.6 * chest * sway
    controls.spine_rad[:, 0] -= 0.1 * sway
    controls.head_rad[:, 0] += 0.07 * on * np.cos(2 * np.pi * beat)
    controls.head_rad[:, 1] += 0.8 * chest * sway
    _arms(controls, rng, beat, sway, on)
    return controls


def _feet(
    controls: Controls, context: StepContext, beat: Float[Array, " n"], lead: float, on: Float[Array, " n"]
) -> None:
    """The free foot steps out, touches and returns within its beat."""
    h, wide, ahead = context.body.height_m, vary(context, 0.055), float(context.rng.uniform(-0.04, 0.05))
    for side in (LEFT, RIGHT):
        first = 0.0 if lead * SIDE_SIGN[side] < 0 else 1.0  # free while the weight is on the other side
        within = (beat - first) % 2.0
        free = plateau(within, 0.08, 0.96, 0.38, 0.38) * on
        lift = (bump((within - 0.06) / 0.44) + bump((within - 0.5) / 0.5)) * on
        shift_foot(controls, side, ahead * h * free, wide * h * free, 0.035 * h * lift)
        controls.contact[:, side] -= np.clip(free, 0, 1) * 0.9
        controls.foot_rad[:, side, 1] += 0.3 * lift


def _arms(
    controls: Controls, rng: np.random.Generator, beat: Float[Array, " n"], sway: Float[Array, " n"],
    on: Float[Array, " n"],
) -> None:  # fmt: skip
    """One of three styles: pumping bent arms, swinging arms, hands in the air."""
    style = int(rng.integers(3))
    size = float(rng.uniform(0.7, 1.2))
    for side in (LEFT, RIGHT):
        other = SIDE_SIGN[side] * sway
        arm = controls.arm_rad[:, side]
        if style == 0:
            arm[:, 3] += on * (1.3 + 0.25 * size * np.cos(2 * np.pi * beat))
            arm[:, 0] += on * 0.15 + 0.45 * size * other
            arm[:, 1] += 0.2 * on
        elif style == 1:
            arm[:, 1] += on * 0.25 + 0.45 * size * np.maximum(other, 0) ** 2
            arm[:, 0] += 0.4 * size * other
            arm[:, 3] += 0.5 * on
        else:
            arm[:, 0] += on * 2.1
            arm[:, 1] += on * 0.45 + 0.25 * size * other
            arm[:, 3] += on * 0.8


def hula_hooping(context: StepContext) -> Controls:
    """The hips go round and round over feet a little apart, the chest staying behind; the arms are out of the way."""
    controls, time_s, rng, h = upright(context), context.time_s, context.rng, context.body.height_m
    begin, end = context.start_s, context.end_s
    on = np.ones_like(time_s) if context.first else rise((time_s - begin) / 0.6)
    on = on if context.last else on * rise((end - time_s) / 0.6)
    turn = 2 * np.pi * context.tempo(0.9, 1.4, 1.9) * float(rng.choice([-1.0, 1.0])) * (time_s - begin)
    ahead, left = vary(context, 0.032) * np.cos(turn) * on, vary(context, 0.03) * np.sin(turn) * on
    shift_pelvis(controls, ahead * h, left * h, -0.012 * h * on)
    controls.pelvis_rad[:, 1] -= 2.2 * ahead  # the hips lead, so the pelvis tilts against its way
    controls.pelvis_rad[:, 0] += 2.2 * left
    controls.spine_rad[:, 1] -= 2.6 * ahead  # and the chest stays over the feet
    controls.spine_rad[:, 0] += 2.6 * left
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.5 * on)
    out = float(rng.uniform(0.6, 1.1))
    for side in (LEFT, RIGHT):
        shift_foot(controls, side, 0.0, 0.03 * h, 0.0)
        arm = np.tile([0.35, out, -0.3, 1.5], (len(time_s), 1))
        arm[:, 0] += 0.1 * np.cos(turn + 0.5 * OUTWARD[side])
        mix_arm(controls, side, arm, on)
    return controls
