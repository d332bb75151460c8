"""How full of furniture are rooms? Studies group their rooms into thirds by it."""

from collections.abc import Sequence

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import Scene

CLUTTER = ("low", "medium", "high")
FIELD_DEG = 60.0  # to either side of straight ahead


def clutter_of(scene: Scene, config: RadarConfig) -> float:
    """Share of the floor ahead within the radar's range on which furniture stands or hangs."""
    free = scene.free_space
    x_m, y_m = np.meshgrid(free.x_m, free.y_m)
    is_near = np.hypot(x_m, y_m) < config.range_m[-1]
    is_ahead = np.abs(np.arctan2(x_m, y_m)) < np.radians(FIELD_DEG)
    return float(1 - free.is_free[is_near & is_ahead].mean())


def third_of(clutter: Sequence[float] | np.ndarray, level: str) -> np.ndarray:
    """Indices of the third of the rooms with this much clutter, emptiest first."""
    return np.array_split(np.argsort(clutter, kind="stable"), len(CLUTTER))[CLUTTER.index(level)]
