"""Adds methods, radars, detectors, activities and encoders to mmWeaver.

Registered entries can be named wherever a built-in one can, in Python and, from a plug-in, on the command line. An
installed package provides entries without an import by entry points in the groups `mmweaver.models.methods`,
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
    """Registers a method from scene and people to the signal.

    Args:
        name: Name of the method.
        make: Returns an object that follows `mmweaver.models.methods.Method`.

    Raises:
        InputError: If the name is taken.
    """
    from mmweaver.models.methods import METHODS

    METHODS.register(name, make)


def radar(config: "RadarConfig") -> None:
    """Registers a radar preset under its own name.

    Args:
        config: The radar.

    Raises:
        InputError: If the name is taken.
    """
    from mmweaver.core.boards import PRESETS

    PRESETS.register(config.name, config)


def detector(name: str, detect: "Detector") -> None:
    """Registers a point detector.

    Args:
        name: Name of the detector.
        detect: Function (cube, adc or None) -> PointCloud; with an attribute `needs_adc = True` if it requires samples.

    Raises:
        InputError: If the name is taken.
    """
    from mmweaver.signal.detection import DETECTORS

    DETECTORS.register(name, detect)


def encoder(name: str, make: "Callable[[], nn.Module]") -> None:
    """Registers an environment encoder for training.

    Args:
        name: Name of the encoder.
        make: Returns a module like `EnvironmentEncoder`: from pictures (room, 5, row, column) to z_env (room, 512) and
            a map (room, 40, row / 8, column / 8).

    Raises:
        InputError: If the name is taken.
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

    Args:
        key: Key of the activity.
        name: Noun form, as in "walking".
        example: Sentence with one of the verbs.
        verbs: Base forms, one word each.
        perform: (StepContext) -> Controls for the whole body, or with `hands` (StepContext, Controls) -> Controls for
            gestures on top of another activity.
        least_s: Shortest duration in seconds.
        natural_s: Typical duration in seconds.
        hands: Whether it is a gesture.
        **more: Further fields of `Activity`.

    Raises:
        InputError: If the key or a verb is taken.
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
