"""What the function of an activity gets as input."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.habits import Habits
from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.plan import Step

Array = np.ndarray


STOOL_HEIGHT_M = 0.45  # of a seat where the scene has none


@dataclass(frozen=True, kw_only=True)
class PlacedStep:
    """A step of a plan with its moves over the floor and the height of the seat that it uses."""

    step: Step
    moves: tuple[Move, ...] = ()
    seat_height_m: float = STOOL_HEIGHT_M


@dataclass(frozen=True, kw_only=True)
class StepContext:
    """One step of the motion. `time_s` covers the whole motion, so that neighbouring steps can be blended."""

    time_s: Float[Array, " n"]
    step: Step
    body: SkeletonProportions
    path: RootPath
    rng: np.random.Generator
    moves: tuple[Move, ...] = ()  # the moves of the path that belong to this step
    seat_height_m: float = STOOL_HEIGHT_M
    first: bool = True  # no step before: the motion is already under way at its start
    habits: Habits = field(default_factory=Habits)
    last: bool = True  # no step after: the motion continues at its end
    arms_before: bool = False  # the step before holds the arms as this one does
    arms_after: bool = False  # the step after holds the arms as this one does

    @property
    def start_s(self) -> float:
        return self.step.start_s

    @property
    def end_s(self) -> float:
        return self.step.end_s

    @property
    def duration_s(self) -> float:
        return self.step.end_s - self.step.start_s

    def tempo(self, slow: float, usual: float, fast: float, spread: float = 0.1) -> float:
        """A sampled rate: `slow` for 'slowly', `fast` for 'quickly', else `usual`; log-normal with `spread`."""
        chosen = (usual, fast, slow)[self.step.speed] * self.step.pace
        return chosen * float(np.exp(self.rng.normal(0.0, spread / 2)))
