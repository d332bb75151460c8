"""Which function acts out which step."""

from collections.abc import Callable

import numpy as np

from mmweaver.core.registry import Registry
from mmweaver.motion.controls import Controls
from mmweaver.motion.library import (
    bending,
    dancing,
    floor,
    gait,
    gestures,
    hand_work,
    jumping,
    legs,
    signs,
    sitting,
    standing,
    strength,
    uneven_gait,
)  # fmt: skip
from mmweaver.motion.stage import Stage

POSTURES: Registry[Callable[[Stage], Controls]] = Registry(
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
        ("pick_up", bending.picking_up),
        ("put_down", bending.putting_down),
        ("dance", dancing.dancing),
        ("kneel_down", floor.kneeling_down),
        ("kneel", floor.kneeling),
        ("kneel_up", floor.rising_from_knees),
        ("lie_down", floor.lying_down),
        ("fall", floor.falling),
        ("lie", floor.lying),
        ("get_up", floor.getting_up),
    ],
)
GESTURES: Registry[Callable[[Stage, Controls], Controls]] = Registry(
    "gesture",
    [
        ("wave", gestures.waving),
        ("clap", gestures.clapping),
        ("raise", gestures.raising),
        ("arms_out", signs.arms_out),
        ("drink", gestures.drinking),
        ("eat", hand_work.eating),
        ("type", hand_work.typing),
        ("read", hand_work.reading),
        ("phone", hand_work.phoning),
        ("text", hand_work.texting),
        ("brush_teeth", hand_work.brushing_teeth),
        ("comb", hand_work.combing),
        ("wipe", hand_work.wiping),
        ("write", hand_work.writing),
        ("stir", hand_work.stirring),
        ("knock", hand_work.knocking),
        ("open_door", hand_work.opening_door),
        ("guitar", hand_work.playing_guitar),
        ("violin", hand_work.playing_violin),
        ("point", signs.pointing),
        ("nod", signs.nodding),
        ("shake_head", signs.shaking_head),
        ("look_around", signs.looking_around),
        ("cross_arms", signs.crossing_arms),
        ("hips", signs.hands_on_hips),
        ("shrug", signs.shrugging),
        ("stretch", signs.stretching),
        ("arm_circles", signs.circling_arms),
        ("punch", gestures.punching),
        ("throw", strength.throwing),
        ("push", strength.pushing),
        ("pull", strength.pulling),
        ("carry", strength.carrying),
        ("reach", strength.reaching),
        ("golf", strength.golf_swing),
    ],
)


def perform(stage: Stage) -> Controls:
    """The Controls of one step over the times of its stage."""
    with np.errstate(all="raise", under="ignore"):
        controls = POSTURES[stage.step.lower](stage)
        if stage.step.upper:
            controls = GESTURES[stage.step.upper](stage, controls)
    return controls
