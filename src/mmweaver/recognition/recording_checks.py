"""Checks of recordings against the radar and columns of a task, by their points alone, without labels.

Displacement follows from velocity; no point is behind the radar; velocities are multiples of the radar's step. Where
recordings contradict the task, the recogniser was trained for another board than the one that recorded.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mmweaver.recognition.guards import is_impossible
from mmweaver.recognition.point_recordings import STILL_MPS, PointRecording, is_moving
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.spatiotemporal_features import near_median

LAG_S = 0.5  # over which displacements are compared with velocities
MIN_WAY_M, FARTHEST_M = 0.1, 1.5  # displacement in that time: minimum rms, and maximum before it is another echo
FEWEST = 200  # points, and a tenth as many displacements
RELATED, OPPOSED = 0.6, -0.4  # correlations
SLOWEST, FASTEST = 0.6, 1.6  # displacements relative to the integral of velocity
BEHIND, ASIDE_RAD = 0.05, np.radians(50)
TOO_FAST, OFF_STEP, TOLERANCE = 0.005, 0.2, 0.1  # shares of moving points; of a step
HARDLY, MOSTLY = 0.01, 0.6  # shares of points at rest
GROUPED, UNGROUPED = 0.05, 0.3  # shares of points with a neighbour if the firmware does, or does not, group them
MISSING_SHARE = 0.005  # of frames
APART_M, OFTEN = 1.2, 0.25  # distance of two moving objects; share of the frames with motion
WHAT_TO_DO = {
    "cfg": "name the .cfg that the board was sent",
    "columns": "check the directions of `columns`",
    "sign": 'name the column "velocity_towards" (or "velocity", where it is named so)',
    "place": "if it is not a person (a fan, an echo), record the empty place and name it as `background`",
    "damaged": "these points are left out; check the reader of the data port",
    "missing": "windows there are left out; name `num_frames` in a .npz of which no frame is missing",
}
Lines = Iterator[tuple[str, str]]  # what is wrong; a word of WHAT_TO_DO, or what to do


def contradictions(recordings: Sequence[PointRecording], radar: Quantisation) -> list[str]:
    """Properties of recordings that are impossible if the task is right, with advice.

    Args:
        recordings: Recordings of the task; of fewer than 200 points only velocities and missing frames are checked.
        radar: Steps of range and velocity, and grouping.

    Returns:
        One line per contradiction.
    """
    damaged = [is_impossible(recording) for recording in recordings]
    found = [*_check_damaged(recordings, damaged), *_check_missing(recordings)]
    recordings = [replace(one, cloud=one.cloud.select(~mask)) for one, mask in zip(recordings, damaged, strict=True)]
    x, y, velocity = (
        np.concatenate([np.zeros(0), *(getattr(one.cloud, name) for one in recordings)])
        for name in ("x_m", "y_m", "radial_velocity_mps")
    )
    if len(x) >= FEWEST:
        found += [
            *_check_places(x, y),
            *_check_velocities(np.abs(velocity), radar),
            *_check_ways(recordings, radar),
            *_check_neighbours(recordings, radar),
            *_check_others(recordings, radar),
        ]
    return [f"{line}; {WHAT_TO_DO.get(todo, todo)}" for line, todo in found]


def _check_damaged(recordings: Sequence[PointRecording], damaged: list[np.ndarray]) -> Lines:
    if count := sum(int(mask.sum()) for mask in damaged):
        fastest = max(float(np.abs(one.cloud.radial_velocity_mps).max(initial=0.0)) for one in recordings)
        files = f"{sum(map(bool, map(np.any, damaged)))} of {len(recordings)} recordings"
        yield f"{count} points of {files} have impossible velocities, up to {fastest:,.0f} m/s", "damaged"


def _check_missing(recordings: Sequence[PointRecording]) -> Lines:
    lost = [len(one.missing) for one in recordings]
    if (total := sum(one.num_frames for one in recordings)) and sum(lost) >= MISSING_SHARE * total:
        files = f"{np.count_nonzero(lost)} of {len(recordings)} recordings"
        yield f"{sum(lost)} of {total} frames are not in the log, in {files}, up to {max(lost)} of one", "missing"


def _check_places(x_m: np.ndarray, y_m: np.ndarray) -> Lines:
    behind, aside = float((y_m < 0).mean()), float(np.median(np.abs(np.arctan2(x_m, y_m))))
    if behind > BEHIND:
        yield f"{behind:.0%} of the points lie behind the radar", "columns"
    elif aside > ASIDE_RAD:
        yield f"half of the points lie {np.degrees(aside):.0f} degrees or more aside", "columns"


def _check_velocities(speed_mps: np.ndarray, radar: Quantisation) -> Lines:
    moving = speed_mps[speed_mps > STILL_MPS]
    still = 1 - len(moving) / len(speed_mps)
    if not radar.removes_static and still < HARDLY:
        yield f"{still:.0%} of the points are at rest, but `radar` keeps static clutter", "cfg"
    if radar.removes_static and still > MOSTLY:
        yield f"{still:.0%} of the points are at rest, but `radar` removes static clutter", "cfg"
    if len(moving) < FEWEST:
        return
    step = radar.velocity_step_mps
    if (beyond := float((moving > radar.max_velocity_mps * 1.01).mean())) > TOO_FAST:
        most = f"{radar.max_velocity_mps * 1.01:.1f} m/s, the most that `radar` can measure"
        yield f"{beyond:.1%} of the moving points are faster than {most}", "cfg"
    off = np.abs(moving / step - np.round(moving / step))
    if (share := float((off > TOLERANCE).mean())) > OFF_STEP:
        yield f"{share:.0%} of the velocities are no multiples of {step:.3g} m/s, the step of `radar`", "cfg"


def _check_ways(recordings: Sequence[PointRecording], radar: Quantisation) -> Lines:
    went_m, expected_m = _ways(recordings, radar.max_velocity_mps / 2)
    if len(went_m) < FEWEST / 10 or np.sqrt(np.mean(went_m**2)) < MIN_WAY_M or not expected_m.any():
        return
    related = float(went_m @ expected_m / np.sqrt((went_m @ went_m) * (expected_m @ expected_m)))
    times = float(went_m @ expected_m / (expected_m @ expected_m))
    if related < OPPOSED:
        yield "whoever moves comes nearer where velocities say that they go away", "sign"
    elif related > RELATED and not SLOWEST < times < FASTEST:
        yield (
            f"whoever moves gets {times:.1f} times as far as velocities say",
            "check frame_rate_hz and the unit of velocities",
        )


def _ways(recordings: Sequence[PointRecording], fastest_mps: float) -> tuple[np.ndarray, np.ndarray]:
    """Changes of the mean range of moving points within LAG_S, and those predicted by their velocities, (way,)."""
    ways = [np.zeros((2, 0))]
    for recording in recordings:
        cloud, frames = near_median(recording.cloud), recording.num_frames
        lag = max(round(LAG_S * recording.frame_rate_hz), 1)
        if frames <= lag:
            continue
        count = np.bincount(cloud.frame, minlength=frames)
        mean_m, velocity = (
            np.bincount(cloud.frame, values, minlength=frames) / np.maximum(count, 1)
            for values in (cloud.range_m, cloud.radial_velocity_mps)
        )
        way = np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2)]) / recording.frame_rate_hz
        change, expected = mean_m[lag:] - mean_m[:-lag], way[lag:] - way[:-lag]
        seen = np.convolve(count > 0, np.ones(lag + 1), mode="valid") == lag + 1
        seen &= (np.abs(change) < FARTHEST_M) & (np.abs(expected) < fastest_mps * LAG_S)
        ways.append(np.stack([change[seen], expected[seen]]))
    went_m, expected_m = np.concatenate(ways, axis=1)
    return went_m, expected_m


def _check_neighbours(recordings: Sequence[PointRecording], radar: Quantisation) -> Lines:
    shares = neighbour_shares(recordings, radar)
    for share, grouped, word in zip(
        shares, (radar.groups_range, radar.groups_velocity), ("range", "velocity"), strict=True
    ):
        line = f"{share:.0%} of the points have a neighbour in {word},"
        if grouped and share > UNGROUPED:
            yield f"{line} but `radar` groups these", "cfg"
        if not grouped and share < GROUPED:
            yield f"{line} as if these were grouped, but `radar` does not", "cfg"


def neighbour_shares(recordings: Sequence[PointRecording], radar: Quantisation) -> tuple[float, float]:
    """Shares of the points with a neighbour one step farther in the same frame.

    Args:
        recordings: The recordings.
        radar: Steps of range and velocity.

    Returns:
        Shares with a neighbour in range, and in velocity.
    """
    pairs, total = np.zeros(2), 0
    for recording in recordings:
        cloud = recording.cloud
        rows = np.round(cloud.range_m / radar.range_step_m)
        steps = np.round(cloud.radial_velocity_mps / radar.velocity_step_mps)
        cells = np.unique(np.stack([cloud.frame, rows, steps], axis=1), axis=0)
        total += len(cells)
        for number, (column, other) in enumerate(((1, 2), (2, 1))):
            after = np.diff(cells[np.lexsort(cells[:, (column, other, 0)].T)], axis=0)
            pairs[number] += ((after[:, (0, other)] == 0).all(axis=1) & (after[:, column] == 1)).sum()
    in_range, in_velocity = (pairs / max(total, 1)).tolist()
    return in_range, in_velocity


def _check_others(recordings: Sequence[PointRecording], radar: Quantisation) -> Lines:
    """A person cannot be in two places."""
    apart = moving = 0
    for recording in recordings:
        cloud = recording.cloud.select(is_moving(recording.cloud))
        first = np.flatnonzero(np.diff(cloud.frame, prepend=-1))
        if len(first):
            spans = [
                np.maximum.reduceat(axis, first) - np.minimum.reduceat(axis, first) for axis in (cloud.x_m, cloud.y_m)
            ]
            apart, moving = apart + int((np.hypot(*spans) > APART_M).sum()), moving + len(first)
    if not radar.knows_place and moving >= FEWEST / 10 and apart >= OFTEN * moving:
        share = f"in {apart / moving:.0%} of the frames with motion"
        yield f"{share} something moves {APART_M:g} m or more from something else that moves", "place"
