"""Places of constant movement: something moves there in nearly all recordings, also while somebody walks elsewhere.

A fan, say, where there is no recording of the empty place. Whoever exercises at one place in all recordings moves there
as well; so a place counts only where people walk in some recordings, 1.2 m or more from it, and it goes on moving.
Labels are not asked.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Int
from scipy.ndimage import find_objects, label

from mmweaver.recognition.busy_places import CELL_M, NO_CELLS, Cells, cells_of, with_neighbours
from mmweaver.recognition.point_grouping import grouped
from mmweaver.recognition.point_recording import PointRecording, is_moving
from mmweaver.recognition.radar_facts import RadarFacts

FEWEST, WALKERS = 10, 3  # recordings; of these, recordings in which somebody walks elsewhere
WALKING_SHARE = 0.15  # of the recordings, as well
NEARLY_ALL, IN_FRAMES = 0.9, 0.05  # of the recordings; of a recording's frames
APART_M, WALKED_M = 1.2, 1.0  # of whoever walks: from the place, and in range (from the 10th to the 90th percentile)
STRETCH_S, GOES_ON, MOSTLY = 0.5, 0.5, 0.8  # shares of the stretches in which somebody walks, and of such recordings


def constant_movers(recordings: Sequence[PointRecording], facts: RadarFacts | None = None) -> Cells:
    """Cells (right, ahead), and those around, in which something moves that is certainly nobody; none if unsure.

    `facts` of the radar say how neighbours are grouped: flanks of static echoes move, if these are not.
    """
    if len(recordings) < FEWEST:
        return NO_CELLS
    if facts is not None:
        recordings = [grouped(recording, facts) for recording in recordings]
    candidates = _always_busy(recordings)
    if not len(candidates):
        return NO_CELLS
    goes_on = np.array([_goes_on(recording, candidates) for recording in recordings])  # nan: nobody walks
    walks = np.isfinite(goes_on)
    enough = walks.sum(axis=0) >= max(WALKERS, WALKING_SHARE * len(recordings))
    often = (np.where(walks, goes_on, 0) >= GOES_ON).sum(axis=0) >= MOSTLY * np.maximum(walks.sum(axis=0), 1)
    return with_neighbours(candidates[enough & often])


def places_m(cells: Cells) -> list[tuple[float, float]]:
    """Middles (right, ahead) in m of the places that cells which touch make up."""
    if not len(cells):
        return []
    first = cells.min(axis=0)
    held = np.zeros(np.ptp(cells, axis=0) + 1, bool)
    held[tuple((cells - first).T)] = True
    found: list[tuple[float, float]] = []
    for right, ahead in find_objects(label(held, np.ones((3, 3)))[0]):
        middle = first + np.array([right.start + right.stop, ahead.start + ahead.stop]) / 2
        right_m, ahead_m = (middle * CELL_M).round(1).tolist()
        found.append((right_m, ahead_m))
    return found


def left_out_line(place_m: tuple[float, float]) -> str:
    """What is said of a place that is left out."""
    right_m, ahead_m = place_m
    where = f"{ahead_m:g} m ahead and {abs(right_m):g} m to the {'left' if right_m < 0 else 'right'}"
    return f"something moves all the time {where}, also while people walk elsewhere: it is nobody and left out"


def _always_busy(recordings: Sequence[PointRecording]) -> Int[np.ndarray, "cell 2"]:
    """Cells in which something moves in some frames of nearly all recordings."""
    found = [NO_CELLS]
    for recording in recordings:
        cloud = recording.cloud
        visits = np.unique(np.column_stack([cloud.frame, cells_of(cloud)])[is_moving(cloud)], axis=0)
        cells, frames = np.unique(visits[:, 1:], axis=0, return_counts=True)
        found.append(cells[frames >= max(IN_FRAMES * recording.num_frames, 1)])
    cells, count = np.unique(np.concatenate(found), axis=0, return_counts=True)
    return cells[count >= NEARLY_ALL * len(recordings)]


def _goes_on(recording: PointRecording, candidates: Int[np.ndarray, "cell 2"]) -> np.ndarray:
    """For each cell the share of the stretches with somebody who walks elsewhere in which it moves; nan: nobody."""
    cloud = recording.cloud.select(is_moving(recording.cloud))
    length = max(round(STRETCH_S * recording.frame_rate_hz), 1)
    stretch, cell = cloud.frame // length, cells_of(cloud)
    point_m = np.stack([cloud.x_m, cloud.y_m], axis=1)
    constant = _inside(cell, with_neighbours(candidates))
    shares = np.full(len(candidates), np.nan)
    for number, candidate in enumerate(candidates):
        apart = np.hypot(*(point_m - (candidate + 0.5) * CELL_M).T) > APART_M
        walker = apart & ~constant
        if walker.sum() < 2 or np.ptp(np.quantile(cloud.range_m[walker], [0.1, 0.9])) < WALKED_M:
            continue
        around = np.abs(cell - candidate).max(axis=1) <= 1
        while_walking = np.unique(stretch[walker])
        shares[number] = np.isin(while_walking, stretch[around]).mean()
    return shares


def _inside(cell: Int[np.ndarray, "point 2"], places: Cells) -> Bool[np.ndarray, " point"]:
    return (cell[:, None] == places).all(axis=2).any(axis=1)
