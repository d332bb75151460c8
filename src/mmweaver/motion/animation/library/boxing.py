"""Boxing punches by name, from the guard and back to it: jab, cross, hook and uppercut."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library.movement_primitives import (
    OUTWARD,
    hand_to,
    repeats,
    shift_pelvis,
    spline_through,
    vary,
)
from mmweaver.motion.animation.profiles import plateau, wander
from mmweaver.motion.animation.step_context import StepContext

PerTime = Float[np.ndarray, " n"]
BEGINS, THERE, BACK = 0.18, 0.52, 0.98  # shares of a punch: it leaves the guard, hits, is in the guard again
_GUARD = (0.15, 0.06, 0.11)  # of a fist: ahead, outward and up of spine3, in body heights

_ELBOW = (-0.15, 0.45, -1.0)  # where it points in the guard


@dataclass(frozen=True, kw_only=True)
class Punch:
    """The way of a fist by its places (ahead, outward, up; body heights), and what the trunk does with it."""

    on_the_way: tuple[float, float, float]
    hits: tuple[float, float, float]
    turn_rad: float  # of the trunk, with the fist
    dip: float  # of the body before it hits, in body heights
    elbow: tuple[float, float, float]  # where it points
    leads: bool  # the hand in front by default
    lasts_s: float  # usually, from guard to guard


JAB = Punch(
    on_the_way=(0.215, 0.055, 0.115), hits=(0.265, 0.04, 0.11), turn_rad=0.35, dip=0.0, elbow=(-0.1, 0.4, -1.0),
    leads=True, lasts_s=0.58,
)  # fmt: skip
CROSS = Punch(
    on_the_way=(0.21, 0.045, 0.115), hits=(0.265, 0.01, 0.11), turn_rad=0.6, dip=0.008, elbow=(-0.1, 0.45, -1.0),
    leads=False, lasts_s=0.68,
)  # fmt: skip
HOOK = Punch(
    on_the_way=(0.165, 0.15, 0.095), hits=(0.21, 0.02, 0.115), turn_rad=0.6, dip=0.01, elbow=(-0.2, 1.0, -0.15),
    leads=True, lasts_s=0.88,
)  # fmt: skip
UPPERCUT = Punch(
    on_the_way=(0.14, 0.07, -0.01), hits=(0.195, 0.02, 0.14), turn_rad=0.5, dip=0.03, elbow=(-0.4, 0.3, -1.0),
    leads=False, lasts_s=0.9,
)  # fmt: skip


def jab(context: StepContext, controls: Controls) -> Controls:
    """Straight, of the hand in front, the trunk hardly turned."""
    return _punched(context, controls, JAB)


def cross(context: StepContext, controls: Controls) -> Controls:
    """Straight, of the hand behind, the trunk turned after it."""
    return _punched(context, controls, CROSS)


def hook(context: StepContext, controls: Controls) -> Controls:
    """Around the side with a bent arm, the elbow as high as the fist."""
    return _punched(context, controls, HOOK)


def uppercut(context: StepContext, controls: Controls) -> Controls:
    """From below up to the chin, out of the knees."""
    return _punched(context, controls, UPPERCUT)


def _punched(context: StepContext, controls: Controls, punch: Punch) -> Controls:
    """One fist after the other where both punch, else the same one; the other one stays in the guard."""
    time_s, rng, n = context.time_s, context.rng, len(context.time_s)
    size, restless = min(vary(context, 0.98, 0.05), 1.02), float(rng.uniform(0.003, 0.01))
    fists = [place_of(_GUARD, n) for _ in (LEFT, RIGHT)]
    out = [np.zeros(n), np.zeros(n)]
    for fist in fists:
        fist += restless * np.stack([wander(time_s, rng, slow_hz=0.8, fast_hz=2.0) for _ in range(3)], axis=1)
    for k, (begin, lasts) in enumerate(repeats(context, punch.lasts_s, 0.9 * punch.lasts_s, 1.4)):
        side = _side(context, punch, k)
        at = [begin + share * lasts for share in (BEGINS, 0.5 * (BEGINS + THERE), THERE, 0.76, BACK)]
        middle = 0.5 * (np.array(_GUARD) + size * np.array(punch.hits))
        ways = np.array([_GUARD, punch.on_the_way, size * np.array(punch.hits), middle, _GUARD])
        for axis in range(3):
            fists[side][:, axis] += spline_through(time_s, at, (ways[:, axis] - _GUARD[axis]).tolist())
        hit = plateau(time_s, at[0], at[-1], at[2] - at[0], at[-1] - at[2])
        out[side] += hit
        _trunk(context, controls, punch, side, hit, at)
    controls.spine_rad[:, 1] += 0.08
    controls.head_rad[:, 0] += 0.1
    for side in (LEFT, RIGHT):
        hand_to(controls, context.body, side, fists[side], np.ones(n), _ELBOW)
        hand_to(controls, context.body, side, fists[side], out[side], punch.elbow)
    return controls


def place_of(where: tuple[float, float, float], n: int) -> Float[np.ndarray, "n 3"]:
    """The same place (n, 3) at all times."""
    return np.tile(np.array(where), (n, 1))


def _side(context: StepContext, punch: Punch, k: int) -> int:
    """The fist of punch k: as the sentence says, else the one that leads or follows; of several, both in turn."""
    if context.step.hand in ("left", "right"):
        return LEFT if context.step.hand == "left" else RIGHT
    in_front = RIGHT if context.step.usual_hand == "left" else LEFT
    side = in_front if punch.leads else 1 - in_front
    in_turn = context.step.hand == "both" or punch in (HOOK, UPPERCUT)
    return side if k % 2 == 0 or not in_turn else 1 - side


def _trunk(context: StepContext, controls: Controls, punch: Punch, side: int, hit: PerTime, at: list[float]) -> None:
    """The trunk turns the shoulder of the fist forward, after it has been turned back a little."""
    h, time_s = context.body.height_m, context.time_s
    wound = spline_through(time_s, [at[0] - 0.1, at[1], at[2], at[-1]], [0.0, -0.2, 1.0, 0.0])
    turn = -OUTWARD[side] * vary(context, punch.turn_rad, 0.15) * wound
    controls.spine_rad[:, 2] += 0.75 * turn
    controls.pelvis_rad[:, 2] += 0.25 * turn
    controls.head_rad[:, 1] -= turn
    low = plateau(time_s, at[0] - 0.12, at[2], at[1] - at[0] + 0.12, at[2] - at[1])
    shift_pelvis(controls, 0.02 * h * hit, 0.0, -punch.dip * h * low)
    controls.knee_room[:] = np.maximum(controls.knee_room, 0.4 * low * (punch.dip > 0))
    controls.spine_rad[:, 1] += 0.06 * hit
