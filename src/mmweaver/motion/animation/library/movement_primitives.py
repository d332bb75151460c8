"""Names that plug-ins of 0.2 import; `StepContext` has them as methods."""

from mmweaver.motion.animation.controls import mix_arm
from mmweaver.motion.animation.step_context import StepContext

__all__ = ["mix_arm", "sides"]
sides = StepContext.sides
