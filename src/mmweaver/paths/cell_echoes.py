"""Mean echoes that stand for resolution cells, each of which becomes one scatterer of unknown phase."""

from dataclasses import dataclass

from torch import Tensor

from mmweaver.paths.mean_echoes import MeanEchoes


@dataclass(frozen=True, kw_only=True)
class CellEchoes(MeanEchoes):
    """Echoes of cells; a cell has the same number in all frames, and so the same phase."""

    cell: Tensor  # (..., echo) int64
