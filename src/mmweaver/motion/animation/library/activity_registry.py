"""The function that animates each activity, by the activity's key in `motion/language/activities.py`."""

import importlib
import pkgutil
from dataclasses import replace
from pathlib import Path

import numpy as np

from mmweaver.motion.animation.controls import LEFT, RIGHT, Controls
from mmweaver.motion.animation.step_context import GESTURES, POSTURES, StepContext

for _module in pkgutil.iter_modules([str(Path(__file__).parent)]):
    importlib.import_module(f"mmweaver.motion.animation.library.{_module.name}")


def perform(act: StepContext) -> Controls:
    """Animates one step: its posture, overlaid with its gesture and that of the other hand.

    Args:
        act: Times, step, body and path.

    Returns:
        Controls at all times of the context.
    """
    step = act.step
    with np.errstate(all="raise", under="ignore"):
        posture = POSTURES[step.lower](act)
        if not step.upper:
            return posture
        controls = GESTURES[step.upper](act, posture.copy())
        if step.other_hand is None:
            return controls
        # Only the arm of the second activity is added; head and trunk follow the first.
        second = replace(
            step.other_hand,
            lower=step.lower,
            start_s=step.start_s,
            end_s=step.end_s,
            pace=step.pace,
            speed=step.other_hand.speed or step.speed,
        )
        alone = GESTURES[second.upper](replace(act, step=second), posture)
        side = LEFT if second.hand == "left" else RIGHT
        controls.arm_rad[:, side] = alone.arm_rad[:, side]
        return controls
