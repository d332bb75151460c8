"""Where something moves that is nobody: places in which a recording of the empty place has moving points.

Moving points there are left out of all windows, generated and recorded, so that a fan is no runner.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Int

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recording import PointRecording, is_moving

CELL_M = 0.25
LEAST_FRAMES, LEAST_SHARE = 3, 0.02  # in which something moves in a busy cell: who walks through leaves it at once
AROUND = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)

Cells = Int[np.ndarray, "cell 2"]
NO_CELLS: Cells = np.zeros((0, 2), int)


def busy_cells(empty_place: Sequence[PointRecording]) -> Cells:
    """Cells (right, ahead), in steps of CELL_M, in which and next to which something moves."""
    found = [NO_CELLS]
    for recording in empty_place:
        cloud = recording.cloud
        visits = np.unique(np.column_stack([cloud.frame, cells_of(cloud)])[is_moving(cloud)], axis=0)  # once a frame
        cells, frames = np.unique(visits[:, 1:], axis=0, return_counts=True)
        busy = cells[frames >= max(LEAST_FRAMES, LEAST_SHARE * recording.num_frames)]
        found.append(with_neighbours(busy))
    return np.unique(np.concatenate(found), axis=0)


def with_neighbours(cells: Int[np.ndarray, "own 2"]) -> Cells:
    """Cells and those next to them."""
    return np.unique((cells[:, None] + AROUND).reshape(-1, 2), axis=0)


def without_busy(window: PointRecording, cells: Cells) -> PointRecording:
    """The window without the moving points in these cells."""
    if not len(cells):
        return window
    own, width = cells_of(window.cloud) - cells.min(axis=0), np.ptp(cells, axis=0) + 1
    is_busy = np.zeros(width, bool)
    is_busy[tuple((cells - cells.min(axis=0)).T)] = True
    inside = ((own >= 0) & (own < width)).all(axis=1)
    hidden = inside & is_busy[tuple(np.where(inside[:, None], own, 0).T)] & is_moving(window.cloud)
    return replace(window, cloud=window.cloud.select(~hidden))


def cells_of(cloud: PointCloud) -> Int[np.ndarray, "point 2"]:
    """The cell of each point."""
    return np.floor(np.stack([cloud.x_m, cloud.y_m], axis=1) / CELL_M).astype(int)
