"""The function that animates each activity, by the activity's key in `motion/language/activities.py`."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mmweaver.core.registry import Registry
from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.library import (
    arm_gestures,
    bending,
    boxing,
    cycling,
    dancing,
    floor_exercises,
    forward_roll,
    gait,
    gestures,
    hand_activities,
    household,
    jumping,
    legs,
    on_furniture,
    on_the_floor,
    pointing_and_nodding,
    rehabilitation,
    sitting,
    standing,
    tennis,
    throwing_and_carrying,
    turned_kicks,
    uneven_gait,
    yoga,
)  # fmt: skip
from mmweaver.motion.animation.step_context import StepContext

POSTURES: Registry[Callable[[StepContext], Controls]] = Registry(
    "movement",
    [
        ("stand", standing.standing),
        ("walk", gait.walking),
        ("jog", gait.jogging),
        ("sidestep", uneven_gait.sidestepping),
        ("limp", uneven_gait.limping),
        ("stagger", uneven_gait.staggering),
        ("march", legs.marching),
        ("turn", gait.turning),
        ("stumble", uneven_gait.stumbling),
        ("sit", sitting.sitting),
        ("sit_down", sitting.sitting_down),
        ("stand_up", sitting.standing_up),
        ("squat", jumping.squatting),
        ("crouch", legs.crouching),
        ("lunge", legs.lunging),
        ("jump", jumping.jumping),
        ("leap", jumping.leaping),
        ("hop", jumping.hopping),
        ("hop_one_leg", legs.hopping_on_one_leg),
        ("jumping_jacks", jumping.jumping_jacks),
        ("one_leg", legs.on_one_leg),
        ("kick", legs.kicking),
        ("stomp", legs.stamping),
        ("raise_leg", legs.raising_leg),
        ("bow", bending.bowing),
        ("bend", bending.bending),
        ("lean", bending.leaning),
        ("twist", bending.twisting),
        ("pick_up", bending.picking_up),
        ("put_down", bending.putting_down),
        ("dance", dancing.dancing),
        ("kneel_down", on_the_floor.kneeling_down),
        ("kneel", on_the_floor.kneeling),
        ("kneel_up", on_the_floor.rising_from_knees),
        ("lie_down", on_the_floor.lying_down),
        ("fall", on_the_floor.falling),
        ("lie", on_the_floor.lying),
        ("get_up", on_the_floor.getting_up),
        ("side_lunge", rehabilitation.side_lunging),
        ("limb_extension", rehabilitation.limb_extension),
        ("push_ups", floor_exercises.push_ups),
        ("sit_ups", floor_exercises.sit_ups),
        ("crawl", floor_exercises.crawling),
        ("pedal", cycling.pedalling),
        ("roundhouse", turned_kicks.roundhouse),
        ("side_kick", turned_kicks.side_kick),
        ("walking_lunge", uneven_gait.walking_lunges),
        ("forward_roll", forward_roll.rolling_forward),
        ("hula_hoop", dancing.hula_hooping),
        ("roll_over", on_the_floor.rolling_over),
        ("roll_in_bed", on_furniture.rolling_in_bed),
        ("lie_on_seat", on_furniture.lying_on_seat),
        ("recline", on_furniture.reclining),
        ("sit_up", on_furniture.sitting_up),
        ("fall_off", on_furniture.falling_off),
        ("stairs", legs.stepping_up_and_down),
        ("tree_pose", yoga.tree_pose),
        ("warrior_pose", yoga.warrior_pose),
        ("downward_dog", yoga.downward_dog),
        ("plank", floor_exercises.plank),
    ],
)
GESTURES: Registry[Callable[[StepContext, Controls], Controls]] = Registry(
    "gesture",
    [
        ("wave", gestures.waving),
        ("clap", gestures.clapping),
        ("raise", gestures.raising),
        ("arms_out", pointing_and_nodding.arms_out),
        ("drink", gestures.drinking),
        ("eat", hand_activities.eating),
        ("type", hand_activities.typing),
        ("read", hand_activities.reading),
        ("phone", hand_activities.phoning),
        ("text", hand_activities.texting),
        ("brush_teeth", hand_activities.brushing_teeth),
        ("comb", hand_activities.combing),
        ("wipe", hand_activities.wiping),
        ("write", hand_activities.writing),
        ("stir", hand_activities.stirring),
        ("knock", hand_activities.knocking),
        ("open_door", hand_activities.opening_door),
        ("guitar", hand_activities.playing_guitar),
        ("violin", hand_activities.playing_violin),
        ("point", pointing_and_nodding.pointing),
        ("nod", pointing_and_nodding.nodding),
        ("shake_head", pointing_and_nodding.shaking_head),
        ("look_around", pointing_and_nodding.looking_around),
        ("cross_arms", pointing_and_nodding.crossing_arms),
        ("hips", pointing_and_nodding.hands_on_hips),
        ("shrug", pointing_and_nodding.shrugging),
        ("stretch", pointing_and_nodding.stretching),
        ("arm_circles", pointing_and_nodding.circling_arms),
        ("punch", gestures.punching),
        ("throw", throwing_and_carrying.throwing),
        ("push", throwing_and_carrying.pushing),
        ("pull", throwing_and_carrying.pulling),
        ("carry", throwing_and_carrying.carrying),
        ("reach", throwing_and_carrying.reaching),
        ("golf", throwing_and_carrying.golf_swing),
        ("raise_hold", arm_gestures.raising_and_holding),
        ("lower_arm", arm_gestures.lowering),
        ("push_hand", arm_gestures.pushing_hand),
        ("pull_hand", arm_gestures.pulling_hand),
        ("draw_circle", arm_gestures.drawing_circle),
        ("draw_z", arm_gestures.drawing_z),
        ("yawn", arm_gestures.yawning),
        ("knock_elbow", arm_gestures.knocking_from_elbow),
        ("arm_extension", rehabilitation.arm_extension),
        ("hands_up", rehabilitation.hands_up),
        ("sweep", household.sweeping),
        ("vacuum", household.vacuuming),
        ("jacket_off", household.taking_jacket_off),
        ("cough", household.coughing),
        ("breathe", household.breathing_deeply),
        ("swipe", arm_gestures.swiping),
        ("count_fingers", hand_activities.counting_on_fingers),
        ("tremble", household.trembling),
        ("cradle", throwing_and_carrying.cradling),
        ("jab", boxing.jab),
        ("cross", boxing.cross),
        ("hook", boxing.hook),
        ("uppercut", boxing.uppercut),
        ("forehand", tennis.forehand),
        ("backhand", tennis.backhand),
        ("tennis_serve", tennis.serving),
    ],
)


def perform(context: StepContext) -> Controls:
    """The Controls of one step at all times of its context."""
    with np.errstate(all="raise", under="ignore"):
        posture = POSTURES[context.step.lower](context)
        if not context.step.upper:
            return posture
        controls = GESTURES[context.step.upper](context, posture.copy())
        return controls if context.step.other_hand is None else _with_other_arm(context, controls, posture)


def _with_other_arm(context: StepContext, controls: Controls, posture: Controls) -> Controls:
    """The controls with the arm of what the other hand does; head and trunk go with the first activity alone."""
    step, second = context.step, context.step.other_hand
    assert second is not None
    other = replace(
        second,
        lower=step.lower,
        start_s=step.start_s,
        end_s=step.end_s,
        pace=step.pace,
        speed=second.speed or step.speed,
    )
    alone = GESTURES[second.upper](replace(context, step=other), posture)
    side = LEFT if second.hand == "left" else RIGHT
    controls.arm_rad[:, side] = alone.arm_rad[:, side]
    return controls
