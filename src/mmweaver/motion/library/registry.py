"""Which function acts out which step."""

from collections.abc import Callable

import numpy as np

from mmweaver.core.registry import Registry
from mmweaver.motion.controls import Controls
from mmweaver.motion.library import gait, gestures, jumping, sitting, standing
from mmweaver.motion.stage import Stage

POSTURES: Registry[Callable[[Stage], Controls]] = Registry(
    "movement",
    [
        ("stand", standing.standing),
        ("walk", gait.walking),
        ("jog", gait.jogging),
        ("turn", gait.turning),
        ("sit", sitting.sitting),
        ("sit_down", sitting.sitting_down),
        ("stand_up", sitting.standing_up),
        ("squat", jumping.squatting),
        ("jump", jumping.jumping),
        ("jumping_jacks", jumping.jumping_jacks),
    ],
)
GESTURES: Registry[Callable[[Stage, Controls], Controls]] = Registry(
    "gesture",
    [
        ("wave", gestures.waving),
        ("clap", gestures.clapping),
        ("raise", gestures.raising),
        ("drink", gestures.drinking),
        ("punch", gestures.punching),
    ],
)


def perform(stage: Stage) -> Controls:
    """The Controls of one step over the times of its stage."""
    with np.errstate(all="raise", under="ignore"):
        controls = POSTURES[stage.step.lower](stage)
        if stage.step.upper:
            controls = GESTURES[stage.step.upper](stage, controls)
    return controls
