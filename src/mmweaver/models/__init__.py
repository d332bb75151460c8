"""The networks: encoders of room and motion, and what reads them. Names are imported when first used.

>>> from mmweaver.models import HyperNetwork
>>> sum(parameter.numel() for parameter in HyperNetwork().parameters())
14714446
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mmweaver.models.environment_encoder import EnvironmentEncoder
    from mmweaver.models.hypernetwork import HyperNetwork
    from mmweaver.models.pose_encoder import PoseEncoder
    from mmweaver.models.power_network import PowerNetwork
    from mmweaver.models.scatterer_network import WeaverNetwork

_HOME = {
    "EnvironmentEncoder": "environment_encoder",
    "HyperNetwork": "hypernetwork",
    "PoseEncoder": "pose_encoder",
    "PowerNetwork": "power_network",
    "WeaverNetwork": "scatterer_network",
}
__all__ = ["EnvironmentEncoder", "HyperNetwork", "PoseEncoder", "PowerNetwork", "WeaverNetwork"]


def __getattr__(name: str) -> Any:
    """Imports a public name from the module that defines it, at its first use."""
    if name not in _HOME:
        raise AttributeError(f"module 'mmweaver.models' has no attribute {name!r}")
    return getattr(import_module(f"mmweaver.models.{_HOME[name]}"), name)
