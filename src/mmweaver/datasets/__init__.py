"""Data sets of procedural rooms and labelled sets: planning, generation, storage, and `RadarDataset`, which reads both.

Start with `dataset_plan`. `RadarDataset` and `collate` are imported at first use.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mmweaver.datasets.radar_dataset import RadarDataset, collate

__all__ = ["RadarDataset", "collate"]


def __getattr__(name: str) -> Any:
    """Imports a public name at first use."""
    if name not in __all__:
        raise AttributeError(f"module 'mmweaver.datasets' has no attribute {name!r}")
    return getattr(import_module("mmweaver.datasets.radar_dataset"), name)
