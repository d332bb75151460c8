"""Data sets of procedural rooms, and labelled sets: plan, generation, storage, and `RadarDataset`, their reader.

Read `dataset_plan` first. `RadarDataset` and `collate` are imported when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mmweaver.datasets.radar_dataset import RadarDataset, collate

__all__ = ["RadarDataset", "collate"]


def __getattr__(name: str) -> Any:
    """The public names, imported at their first use."""
    if name not in __all__:
        raise AttributeError(f"module 'mmweaver.datasets' has no attribute {name!r}")
    return getattr(import_module("mmweaver.datasets.radar_dataset"), name)
