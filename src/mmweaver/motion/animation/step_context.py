"""What an activity is given to act on."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.motion.animation.root_path import Move, RootPath
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.language.plan import Step

Array = np.ndarray


@dataclass(frozen=True, kw_only=True)
class StepContext:
    """One step's part of the motion: the times asked for reach beyond the step, so that neighbours can be blended."""

    time_s: Float[Array, " n"]
    step: Step
    body: SkeletonProportions
    path: RootPath
    rng: np.random.Generator
    moves: tuple[Move, ...] = ()  # the moves of the path that belong to this step
    seat_height_m: float = 0.45
    first: bool = True  # nothing was before, so the motion is already under way at its start
    last: bool = True  # nothing comes after, so it goes on

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
        """A rate for 'slowly', no word and 'quickly', with natural variation."""
        chosen = (usual, fast, slow)[self.step.speed]
        return chosen * float(np.exp(self.rng.normal(0.0, spread / 2)))
