"""Standing exercises of physiotherapy: on toes and heels, hip abduction, tandem stance, functional reach, raised arms.

Angles are those that exercise sheets and norms give: heel raises and toe raises of 30 to 40 and 15 to 20 degrees, hip
abduction of 30 to 40 degrees, arms raised to shoulder height, a functional reach of 25 to 38 cm (Duncan et al., 1990).
"""

import numpy as np

from mmweaver.motion.animation.controls import LEFT, OUTWARD, RIGHT
from mmweaver.motion.animation.kinematics import ankle_from_foot
from mmweaver.motion.animation.library.legs import there_and_back
from mmweaver.motion.animation.profiles import PerTime, bump, reached
from mmweaver.motion.animation.standing import HALF_STANCE, TOES_OUT_RAD
from mmweaver.motion.animation.step_context import BOTH, StepContext, gesture, posture

FOOT_LENGTH = 0.152  # of the height
_ON_TOES_RAD, _ON_HEELS_RAD = 0.6, -0.32
_SETTLING_S = 0.8  # into a stance and out of it


def _tilt_feet(act: StepContext, pitch_rad: PerTime, *sides: int) -> None:
    """Pitches feet about ball or heel; the body goes with the ankles if both are tilted."""
    for side in sides:
        act.add(pitch_rad, side, foot_pitch=1)
    if len(sides) == len(BOTH):
        still = np.zeros(len(pitch_rad))
        ankle = ankle_from_foot(act.body, still, pitch_rad) - ankle_from_foot(act.body, still, still)
        act.pelvis(ankle[:, 0], 0.0, ankle[:, 2])


@posture("heel_raise")
def raising_heels(act: StepContext) -> None:
    """Up onto the balls of both feet and down again, the weight moving ahead over the toes."""
    up = there_and_back(act, 2.0, 0.9, 3.5)
    _tilt_feet(act, act.vary(_ON_TOES_RAD, 0.08) * up, *BOTH)
    act.pelvis(0.012 * act.height_m * up)
    act.add(up, spine_pitch=-0.03, abduction=0.06)


@posture("toe_raise")
def raising_toes(act: StepContext) -> None:
    """Toes up on both heels, the hips moving back and the trunk ahead for balance."""
    up = there_and_back(act, 2.0, 0.9, 3.5)
    _tilt_feet(act, act.vary(_ON_HEELS_RAD, 0.08) * up, *BOTH)
    act.pelvis(-0.012 * act.height_m * up)
    act.add(up, pelvis_pitch=0.1, spine_pitch=0.06, flexion=0.25)


@posture("toe_tap")
def tapping_toes(act: StepContext) -> None:
    """The forefoot of one leg goes up on its heel and taps the floor, about once a second."""
    side = act.leg_side()
    up = np.sum([span.plateau(0, 0.9, 0.4, 0.35) for span in act.in_turn(0.8, 0.4, 1.4)], axis=0)
    act.add(act.vary(-0.3, 0.08) * up, side, foot_pitch=1)
    act.move_foot(side, 0.05 * act.height_m)
    act.lean_over(1 - side, np.full_like(up, 0.4))
    act.lift_weight(side, np.full_like(up, 0.5))


@posture("leg_aside")
def abducting_a_leg(act: StepContext) -> None:
    """One straight leg moves out to the side and comes back, the trunk upright over the other."""
    side, up, leg_m = act.leg_side(), there_and_back(act, 2.4, 1.2, 4.0), act.body.leg_m
    angle, over = act.vary(0.6, 0.08) * up, reached(2.5 * up)
    act.lean_over(1 - side, over)
    act.lift_weight(side, reached(3 * up))
    act.move_foot(side, 0.0, leg_m * np.sin(angle), leg_m * (1 - np.cos(angle)))
    act.add(up, spine_roll=OUTWARD[side] * 0.08, abduction=0.2)
    act.controls.knee_out_rad[:, side] *= 1 - 0.5 * over


@posture("calf_stretch")
def stretching_a_calf(act: StepContext) -> None:
    """A long step back with the leg that is stretched, its heel down and its knee straight, the other knee bent."""
    h, side = act.height_m, act.leg_side()
    into_s = min(1.2, 0.35 * act.duration_s)
    held = act.plateau(act.start_s, act.end_s, into_s, into_s)
    act.move_foot(side, -0.3 * h * held, 0.0, 0.03 * h * bump(held))
    act.move_foot(1 - side, 0.06 * h * held)
    act.lift_weight(side, bump(held))
    act.pelvis(-0.05 * h * held, 0.0, -0.035 * h * held)
    act.add(held, side, foot_yaw=-OUTWARD[side] * TOES_OUT_RAD)
    act.add(held, pelvis_pitch=0.16, spine_pitch=0.06, flexion=0.9, elbow=0.5, abduction=0.1)
    act.bend_knees(0.3 * held)


@posture("tandem_stand")
def standing_in_tandem(act: StepContext) -> None:
    """One foot exactly before the other, heel to toe, the arms slightly out and the trunk never entirely still."""
    h, front, held = act.height_m, act.leg_side(), act.edges(_SETTLING_S, _SETTLING_S)
    for side, ahead in ((front, 0.5), (1 - front, -0.5)):
        act.move_foot(side, ahead * FOOT_LENGTH * h * held, -HALF_STANCE * h * held, 0.03 * h * bump(held))
        act.add(held, side, foot_yaw=-OUTWARD[side] * TOES_OUT_RAD)
    act.pelvis(-0.01 * h * held, 0.0, -0.012 * h * held)
    wobble = held * act.wander(0.3, 0.9)
    act.add(wobble, spine_roll=0.02)
    act.pelvis(left=0.004 * wobble)
    act.add(held, abduction=act.uniform(0.1, 0.3))
    act.bend_knees(0.2 * held)


@posture("functional_reach")
def reaching_as_far_as_possible(act: StepContext) -> None:
    """The arm level ahead, then as far forward as the body can without a step: the hips go back, the trunk over."""
    h, side = act.height_m, LEFT if act.hand == "left" else RIGHT
    for span in act.repeats(4.0, 2.4, 5.5):
        level, far = span.plateau(0, 1, 0.2, 0.2), span.plateau(0.22, 0.86, 0.24, 0.24)
        act.arm((1.5, 0.02, 0.0, 0.05), level, side)
        act.pelvis(-0.03 * h * far, 0.0, -0.01 * h * far)
        act.add(far, pelvis_pitch=0.42, spine_pitch=0.3, head_pitch=-0.4, spine_yaw=OUTWARD[1 - side] * 0.22)
        act.add(far, side, flexion=0.62)  # the arm stays level as the trunk goes over


@gesture("raise_aside")
def raising_arms_aside(act: StepContext) -> None:
    """Straight arms up at the sides to shoulder height and down, repeatedly."""
    up, top, arms = there_and_back(act, 2.4, 1.0, 4.0), act.vary(1.5, 0.04), act.named_arms
    for side in arms:
        act.arm((0.08, top, 0.1, 0.08), up, side)
        act.add(up, spine_roll=OUTWARD[side] * 0.04 * (len(arms) == 1))


@gesture("raise_ahead")
def raising_arms_ahead(act: StepContext) -> None:
    """Straight arms up in front to shoulder height and down, repeatedly."""
    up, top, arms = there_and_back(act, 2.4, 1.0, 4.0), act.vary(1.5, 0.04), act.named_arms
    for side in arms:
        act.arm((top, 0.04, 0.0, 0.08), up, side)
    act.add(up, spine_pitch=-0.03 * len(arms))


@gesture("shoulder_rolls")
def rolling_shoulders(act: StepContext) -> None:
    """The shoulders circle back, the arms hanging: the collar bones rise with arms that move a little out and ahead."""
    rate, end_s = act.cycles(0.4, 0.6, 0.9, 0.3, 1.2)
    on = act.plateau(act.start_s, end_s, 0.3, 0.3)
    phase = act.phase(rate)
    for side in act.named_arms:
        act.add(on * (1 - np.cos(phase)), side, abduction=0.17, elbow=0.16)
        act.add(on * np.sin(phase), side, flexion=-0.12)
    act.add(on * np.sin(phase), spine_pitch=-0.035)
