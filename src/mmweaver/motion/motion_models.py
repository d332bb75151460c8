"""Motion models turn a sentence into moving joints, for sentences that the library does not cover.

A model is a callable that follows `MotionModel`. `--motion-model` names it: a MotionGPT checkpoint, an entry point of
the group mmweaver.motion_models, or "module:attribute" of a module that is installed or lies in the current folder.
"""

import importlib
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.registry import load_plugin, plugins
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_placement import facing_of

GROUP = "mmweaver.motion_models"
Place = tuple[float, float]
_GOES_M = 0.3  # displacement of the pelvis that defines its direction


@dataclass(frozen=True, kw_only=True)
class MotionTask:
    """Input of a motion model.

    Attributes:
        sentence: What the person does.
        start_m: Position (x, y) of the pelvis at time 0, in the radar's frame; None if unconstrained.
        path_m: Corners (x, y) that the pelvis passes, from the start on; empty if unconstrained.
        seconds: Duration; None for the model's natural one.
        seed: Seed of the model's random choices.
    """

    sentence: str
    start_m: Place | None = None
    path_m: tuple[Place, ...] = ()
    seconds: float | None = None
    seed: int = 0


@runtime_checkable
class MotionModel(Protocol):
    """A motion model: 22 joints in SMPL order at a constant rate, in metres, z up; anywhere on its floor.

    A model that follows `path_m` returns the motion in those coordinates; one that does not may ignore it and reports
    that in the clip's notes. It raises InputError for tasks that it cannot perform.
    """

    def __call__(self, task: MotionTask) -> MotionClip: ...


def load_motion_model(name: str) -> MotionModel:
    """Loads a motion model by name.

    Args:
        name: Entry point, "module:attribute", or anything else for a MotionGPT checkpoint.

    Raises:
        InputError: If there is no such model.
    """
    found = plugins(GROUP)
    if name in found:
        return load_plugin(found[name])
    module, colon, attribute = name.partition(":")
    if colon and all(part.isidentifier() for part in (*module.split("."), attribute)):
        return _imported(module, attribute)
    return partial(_run_motiongpt, name)


def clip_of(model: MotionModel, task: MotionTask) -> MotionClip:
    """Runs a model and validates its result.

    Args:
        model: The motion model.
        task: Sentence, start, path and duration.

    Returns:
        The clip, with joints in metres, (frame, 22, 3).

    Raises:
        InputError: If the result is not a finite motion of 22 joints at a rate of up to 1000 Hz.
    """
    clip = model(task)
    joints = getattr(clip, "joints_m", None)
    if not (isinstance(joints, np.ndarray) and joints.ndim == 3 and joints.shape[1:] == (22, 3) and len(joints) > 1):
        raise InputError("the motion model gave no joints of shape (frame, 22, 3); it must return a MotionClip")
    if not (np.isfinite(joints).all() and 0 < clip.fps <= 1000):
        raise InputError("the motion model gave joints that are not finite, or a rate outside 0 to 1000 Hz")
    return clip


def heading_of(path_m: tuple[Place, ...], clip: MotionClip) -> float | None:
    """Initial heading with which the clip's motion starts along a path.

    A body that moves sideways or backwards (a cartwheel) does not face its direction of motion; one that stays in place
    faces along the path.

    Args:
        path_m: Corners (x, y) of the path in metres.
        clip: Motion with z up.

    Returns:
        Heading in radians, from +x towards +y; None without a path.
    """
    if len(path_m) < 2:
        return None
    gap = np.subtract(path_m[1], path_m[0])
    along_rad = float(np.arctan2(gap[1], gap[0]))
    gone_m = clip.joints_m[:, 0, :2] - clip.joints_m[0, 0, :2]
    far = np.flatnonzero(np.hypot(*gone_m.T) > _GOES_M)
    if not len(far):
        return along_rad
    x, y = gone_m[far[0]]
    return along_rad + facing_of(clip.joints_m[0]) - float(np.arctan2(y, x))


def _imported(module: str, attribute: str) -> MotionModel:
    here = str(Path.cwd())
    if here not in sys.path:  # not on the path of an installed command, unlike python -m
        sys.path.append(here)  # last, to shadow no installed module; kept for later imports of the model
    try:
        model = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError) as error:
        raise InputError(f"the motion model {module}:{attribute} cannot be imported ({error})") from None
    if not callable(model):
        raise InputError(f"the motion model {module}:{attribute} is no callable; see docs/extend.md")
    return model


def _run_motiongpt(name: str, task: MotionTask) -> MotionClip:
    """Runs MotionGPT, which ignores start and path; the placement in the room applies them as far as possible."""
    from dataclasses import replace

    from mmweaver.motion.motiongpt.motiongpt import MotionGPT

    clip = MotionGPT.load(name).generate(task.sentence, seconds=task.seconds, seed=task.seed)
    if task.path_m:
        clip = replace(clip, notes=(*clip.notes, "MotionGPT knows no path: only the start and its direction are kept"))
    return clip
