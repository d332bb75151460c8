"""Cells with persistent motion that is not the subject, such as a fan or a curtain. Moving points in them are ignored.

They are known from a recording of the empty room or, without labels, from many recordings: cells with motion in
nearly all of them that continues while people walk at least 1.2 m away. A person who exercises at one place in all
recordings causes motion there, too; therefore a cell counts only if people walk elsewhere in some recordings at the
same time. Walking is a range that changes by a metre as the velocities say: neither noise nor a person's multipath,
which is on the spot with its person, does that.
"""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Int
from scipy.ndimage import find_objects, label

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording, is_moving
from mmweaver.recognition.quantisation import Quantisation, group_neighbours

CELL_M = 0.25
MIN_FRAMES, MIN_SHARE = 3.0, 0.02  # frames of the empty room with motion in a cell; a passer-by leaves it at once
AROUND = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
FEWEST, WALKERS = 10, 3  # minimum number of recordings, and of recordings in which a person walks elsewhere
WALKING_SHARE = 0.15  # minimum share of the latter
NEARLY_ALL, IN_FRAMES = 0.9, 0.05  # of the recordings; of a recording's frames
APART_M, WALKED_M = 1.2, 1.0  # of a walker: distance from the cell, and change of range
STRETCH_S, GOES_ON, MOSTLY = 0.5, 0.5, 0.8  # length and share of the intervals with a walker; share of recordings
COURSE_S, COURSE_SHARE = 3.0, 0.6  # of a walk: length, and minimum share of its frames with points
RELATED, FOLLOWS = 0.9, (0.6, 1.6)  # correlation and slope of range over integrated velocity

Cells = Int[np.ndarray, "_ 2"]  # right, ahead, in steps of CELL_M
NO_CELLS: Cells = np.zeros((0, 2), int)


def background_cells(empty_place: Sequence[PointRecording]) -> Cells:
    """Cells with motion in recordings of the empty room, and their neighbours."""
    found = [_moving_cells(one, max(MIN_FRAMES, MIN_SHARE * one.num_frames)) for one in empty_place]
    return _dilated(np.concatenate([NO_CELLS, *found]))


def persistent_motion_cells(recordings: Sequence[PointRecording], radar: Quantisation | None = None) -> Cells:
    """Cells with persistent motion that is certainly not the subject, and their neighbours; none if unsure.

    Args:
        recordings: Ten or more, in some of which a person walks; labels are not used.
        radar: How the radar groups neighbours: flanks of static echoes move unless they are grouped. By default
            recordings are used as they are.

    Returns:
        Cells (cell, 2), right and ahead in steps of CELL_M.
    """
    if len(recordings) < FEWEST:
        return NO_CELLS
    if radar is not None:
        recordings = [group_neighbours(recording, radar) for recording in recordings]
    found = [_moving_cells(one, max(IN_FRAMES * one.num_frames, 1.0)) for one in recordings]
    cells, count = np.unique(np.concatenate(found), axis=0, return_counts=True)
    cells = cells[count >= NEARLY_ALL * len(recordings)]
    goes_on = np.array([_goes_on(recording, cells) for recording in recordings])  # nan without a walker
    walks = np.isfinite(goes_on).sum(axis=0)
    often = (np.nan_to_num(goes_on) >= GOES_ON).sum(axis=0) >= MOSTLY * np.maximum(walks, 1)
    return _dilated(cells[(walks >= max(WALKERS, WALKING_SHARE * len(recordings))) & often])


def moves_inside(window: PointRecording, cells: Cells) -> Bool[np.ndarray, " point"]:
    """Mask (point,) of the moving points in some cells.

    Args:
        window: Points of one window.
        cells: Cells (cell, 2) in steps of CELL_M.
    """
    return is_moving(window.cloud) & _inside(_cells_of(window.cloud), cells)


def left_out_lines(cells: Cells) -> list[str]:
    """One line of text about each group of adjacent cells."""
    if not len(cells):
        return []
    first = cells.min(axis=0)
    held = np.zeros(np.ptp(cells, axis=0) + 1, bool)
    held[tuple((cells - first).T)] = True
    lines: list[str] = []
    for right, ahead in find_objects(label(held, np.ones((3, 3)))[0]):
        middle = first + np.array([right.start + right.stop, ahead.start + ahead.stop]) / 2
        right_m, ahead_m = (middle * CELL_M).round(1)
        where = f"{ahead_m:g} m ahead and {abs(right_m):g} m to the {'left' if right_m < 0 else 'right'}"
        lines.append(
            f"something moves all the time {where}, also while people walk elsewhere at the same time: it is left out"
        )
    return lines


def _cells_of(cloud: PointCloud) -> Int[np.ndarray, "point 2"]:
    return np.floor(np.stack([cloud.x_m, cloud.y_m], axis=1) / CELL_M).astype(int)


def _dilated(cells: Cells) -> Cells:
    return np.unique((cells[:, None] + AROUND).reshape(-1, 2), axis=0)


def _inside(cell: Int[np.ndarray, "point 2"], places: Cells) -> Bool[np.ndarray, " point"]:
    return (cell[:, None] == places).all(axis=2).any(axis=1)


def _moving_cells(recording: PointRecording, min_frames: float) -> Cells:
    """Cells with motion in at least `min_frames` frames."""
    cloud = recording.cloud.select(is_moving(recording.cloud))
    visits = np.unique(np.column_stack([cloud.frame, _cells_of(cloud)]), axis=0)
    cells, frames = np.unique(visits[:, 1:], axis=0, return_counts=True)
    return cells[frames >= min_frames]


def _goes_on(recording: PointRecording, candidates: Cells) -> np.ndarray:
    """For each cell the share of the intervals with a walker elsewhere in which it moves; nan without a walker."""
    cloud = recording.cloud.select(is_moving(recording.cloud))
    stretch, cell = cloud.frame // max(round(STRETCH_S * recording.frame_rate_hz), 1), _cells_of(cloud)
    point_m = np.stack([cloud.x_m, cloud.y_m], axis=1)
    persistent = _inside(cell, _dilated(candidates))
    shares = np.full(len(candidates), np.nan)
    for number, candidate in enumerate(candidates):
        elsewhere = (np.hypot(*(point_m - (candidate + 0.5) * CELL_M).T) > APART_M) & ~persistent
        walks = np.flatnonzero(elsewhere)[_walks(cloud.select(elsewhere), recording.frame_rate_hz)]
        if len(walks):
            around = np.abs(cell - candidate).max(axis=1) <= 1
            shares[number] = np.isin(np.unique(stretch[walks]), stretch[around]).mean()
    return shares


def _walks(cloud: PointCloud, frame_rate_hz: float) -> Bool[np.ndarray, " point"]:
    """Mask (point,) of the points in courses of COURSE_S in which somebody walks."""
    long = max(round(COURSE_S * frame_rate_hz), 2)
    found = np.zeros(len(cloud.frame), bool)
    for course in np.unique(cloud.frame // long):
        own = np.flatnonzero(cloud.frame // long == course)
        frames, first, count = np.unique(cloud.frame[own], return_index=True, return_counts=True)
        if len(frames) < COURSE_SHARE * long:
            continue
        range_m, velocity = (
            np.add.reduceat(values[own], first) / count for values in (cloud.range_m, cloud.radial_velocity_mps)
        )
        step_s = np.diff(frames) / frame_rate_hz
        way_m = np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2 * step_s)])
        if min(np.ptp(way_m), np.ptp(range_m)) >= WALKED_M:
            slope = np.polyfit(way_m, range_m, 1)[0]
            found[own] = np.corrcoef(way_m, range_m)[0, 1] >= RELATED and FOLLOWS[0] <= slope <= FOLLOWS[1]
    return found
