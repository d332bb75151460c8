"""Which points of a window count: one of neighbours that firmware would group, no multipath, no fans."""

from dataclasses import dataclass, field, replace

import numpy as np

from mmweaver.recognition.background_mask import NO_CELLS, Cells, without_motion_in
from mmweaver.recognition.point_recordings import PointRecording, index_runs, is_moving
from mmweaver.recognition.quantisation import Quantisation, group_neighbours

AT_ONCE_S = 0.15
GROUP_M = 0.8  # from a point, within which others are of the same group
APART_M, BEHIND_M = 1.0, 0.6  # least distance and difference in range between a person and an echo
FEWEST, SHARE = 2, 0.5  # of points of the nearer group, in all and relative to those of the farther


@dataclass(frozen=True, kw_only=True, eq=False)
class WindowFilter:
    """What is left out of all windows, generated and recorded, before anything is measured of them."""

    busy: Cells = field(default_factory=NO_CELLS.copy)  # moving points in these cells are left out
    radar: Quantisation | None = None  # of the task; None: a model of before 0.3, which saw neighbours and echoes

    def without(self, cells: Cells) -> "WindowFilter":
        """Moving points in these cells do not count either."""
        return replace(self, busy=np.unique(np.concatenate([self.busy, cells]), axis=0)) if len(cells) else self

    def __call__(self, window: PointRecording) -> PointRecording:
        """The window without what does not count."""
        window = without_motion_in(window, self.busy)
        return window if self.radar is None else without_multipath(group_neighbours(window, self.radar))


def without_multipath(window: PointRecording) -> PointRecording:
    """The window without moving points behind a nearer group that moves at the same time.

    Multipath of a person over a wall or another body is always longer than the direct path, so of two groups that move
    at once the nearer is the person.
    """
    cloud = window.cloud
    moving = np.flatnonzero(is_moving(cloud))
    frame, range_m = cloud.frame[moving], cloud.range_m[moving]
    place_m = np.stack([cloud.x_m, cloud.y_m], axis=1)[moving]
    lag = max(int(AT_ONCE_S * window.frame_rate_hz), 1)
    one, other = index_runs(np.searchsorted(frame, frame - lag), np.searchsorted(frame, frame + lag, side="right"))
    apart_m = np.hypot(*(place_m[one] - place_m[other]).T)
    group = np.bincount(one, apart_m < GROUP_M, minlength=len(frame))
    nearer = np.bincount(one, (apart_m > APART_M) & (range_m[other] < range_m[one] - BEHIND_M), minlength=len(frame))
    hidden = moving[(nearer >= FEWEST) & (nearer >= SHARE * group)]
    kept = np.ones(len(cloud.frame), bool)
    kept[hidden] = False
    return replace(window, cloud=cloud.select(kept)) if len(hidden) else window
