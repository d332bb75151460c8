"""Which points of a window count: one of neighbours that firmware would group, no echoes behind somebody, no fans."""

from dataclasses import dataclass, field, replace

import numpy as np

from mmweaver.recognition.busy_places import NO_CELLS, Cells, without_busy
from mmweaver.recognition.farther_echoes import without_farther
from mmweaver.recognition.point_grouping import grouped
from mmweaver.recognition.point_recording import PointRecording
from mmweaver.recognition.radar_facts import RadarFacts


@dataclass(frozen=True, kw_only=True, eq=False)
class WindowFilter:
    """What is left out of all windows, generated and recorded, before anything is measured of them."""

    busy: Cells = field(default_factory=NO_CELLS.copy)  # in which no person moves: moving points there are left out
    facts: RadarFacts | None = None  # of the task; None: a model of before, which saw neighbours and echoes

    def without(self, cells: Cells) -> "WindowFilter":
        """Moving points in these cells do not count either."""
        return replace(self, busy=np.unique(np.concatenate([self.busy, cells]), axis=0)) if len(cells) else self

    def __call__(self, window: PointRecording) -> PointRecording:
        """The window without what does not count."""
        window = without_busy(window, self.busy)
        return window if self.facts is None else without_farther(grouped(window, self.facts))
