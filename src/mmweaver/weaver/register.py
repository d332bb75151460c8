"""Adds methods, radars, detectors, activities and encoders to mmWeaver.

What is registered can be named wherever a built-in one can, in Python and, from a plug-in, on the command line. An
installed package offers entries without being imported first by entry points in the groups `mmweaver.models.methods`,
`mmweaver.radars`, `mmweaver.detectors`, `mmweaver.activities` and `mmweaver.encoders`. See docs/extend.md.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from torch import nn

    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.models.methods import Method
    from mmweaver.signal.detection import Detector


def method(name: str, make: "Callable[[], Method]") -> None:
    """Registers a way to make the signal: `make()` returns an object that follows `mmweaver.models.methods.Method`.

    Raises InputError for a name that is taken.
    """
    from mmweaver.models.methods import METHODS

    METHODS.register(name, make)


def radar(config: "RadarConfig") -> None:
    """Registers a radar preset under its own name. Raises InputError for a name that is taken."""
    from mmweaver.core.presets import PRESETS

    PRESETS.register(config.name, config)


def detector(name: str, detect: "Detector") -> None:
    """Registers a point detector, a function (cube, adc or None) -> PointCloud.

    One that needs ADC samples has the attribute `needs_adc = True`. Raises InputError for a name that is taken.
    """
    from mmweaver.signal.detection import DETECTORS

    DETECTORS.register(name, detect)


def encoder(name: str, make: "Callable[[], nn.Module]") -> None:
    """Registers an environment encoder for training: `make()` returns a module like `EnvironmentEncoder`.

    It takes pictures (room, 5, row, column) and returns z_env (room, 512) and a map (room, 40, row / 8, column / 8).
    Raises InputError for a name that is taken.
    """
    from mmweaver.models.environment_encoder import ENCODERS

    ENCODERS.register(name, make)


def activity(
    key: str,
    *,
    name: str,
    example: str,
    verbs: tuple[str, ...],
    perform: Callable[..., Any],
    least_s: float,
    natural_s: float,
    hands: bool = False,
    **more: Any,
) -> None:
    """Registers an activity that sentences can name by its verbs.

    `name` as in "walking", `example` a sentence with one of the verbs (base forms, one word each). `perform` is
    (StepContext) -> Controls for the whole body, or with `hands` (StepContext, Controls) -> Controls for gestures laid
    over it. `least_s` and `natural_s`: shortest and usual duration; `more` as in `Activity`. Raises InputError for a
    key or verb that is taken.
    """
    from mmweaver.motion.register_activity import register_activity

    register_activity(
        key,
        name=name,
        example=example,
        verbs=verbs,
        perform=perform,
        least_s=least_s,
        natural_s=natural_s,
        hands=hands,
        **more,
    )
