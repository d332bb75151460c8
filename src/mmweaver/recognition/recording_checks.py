"""Do recordings fit what a task says of radar and columns? Their points alone are asked, no labels.

Whoever moves is later where the velocities say; nobody stands behind the radar; velocities are multiples of the radar's
step. Where recordings contradict the task, a recogniser has learned from another board than the one that is before it.
"""

from collections.abc import Sequence

import numpy as np

from mmweaver.recognition.point_recordings import STILL_MPS, PointRecording, is_moving
from mmweaver.recognition.quantisation import Quantisation
from mmweaver.recognition.spatiotemporal_features import near_median

LAG_S = 0.5  # over which ways are compared with velocities
LEAST_WAY_M, FARTHEST_M = 0.1, 1.5  # in that time: rms, below which nobody goes anywhere; beyond, it is another echo
FEWEST = 200  # points, and a tenth as many ways
RELATED, OPPOSED = 0.6, -0.4  # correlations
SLOWEST, FASTEST = 0.6, 1.6  # ways relative to what velocities say
BEHIND, ASIDE_RAD = 0.05, np.radians(50)
TOO_FAST, OFF_STEP, TOLERANCE = 0.005, 0.2, 0.1  # shares of moving points; of a step
HARDLY, MOSTLY = 0.01, 0.6  # shares of points at rest
GROUPED, UNGROUPED = 0.05, 0.3  # shares of points that have a neighbour where firmware does, or does not, group these
APART_M, OFTEN = 1.2, 0.25  # between two that move; share of the frames in which something moves
NAME_IT, NAME_COLUMNS = "name the .cfg that the board was sent", "check the directions of `columns`"


def contradictions(recordings: Sequence[PointRecording], radar: Quantisation) -> list[str]:
    """What recordings show that cannot be if the task is right, and what to do about it; empty: nothing."""
    clouds = [recording.cloud for recording in recordings]
    x, y, velocity = (
        np.concatenate([getattr(cloud, name) for cloud in clouds] or [np.zeros(0)])
        for name in ("x_m", "y_m", "radial_velocity_mps")
    )
    if len(x) < FEWEST:
        return []
    return [
        *_of_places(x, y), *_of_velocities(np.abs(velocity), radar), *_of_ways(recordings, radar),
        *_of_neighbours(recordings, radar), *_of_others(recordings, radar),
    ]  # fmt: skip


def _of_places(x_m: np.ndarray, y_m: np.ndarray) -> list[str]:
    behind, aside = float((y_m < 0).mean()), float(np.median(np.abs(np.arctan2(x_m, y_m))))
    if behind > BEHIND:
        return [f"{behind:.0%} of the points lie behind the radar; {NAME_COLUMNS}"]
    if aside > ASIDE_RAD:
        return [f"half of the points lie {np.degrees(aside):.0f} degrees or more aside; {NAME_COLUMNS}"]
    return []


def _of_velocities(speed_mps: np.ndarray, radar: Quantisation) -> list[str]:
    moving = speed_mps[speed_mps > STILL_MPS]
    still, found = 1 - len(moving) / len(speed_mps), []
    if not radar.removes_static and still < HARDLY:
        found.append(f"{still:.0%} of the points are at rest, but `radar` keeps static clutter; {NAME_IT}")
    if radar.removes_static and still > MOSTLY:
        found.append(f"{still:.0%} of the points are at rest, but `radar` removes static clutter; {NAME_IT}")
    if len(moving) < FEWEST:
        return found
    highest, step = radar.max_velocity_mps * 1.01, radar.velocity_step_mps
    if (beyond := float((moving > highest).mean())) > TOO_FAST:
        found.append(f"{beyond:.1%} of the moving points are faster than {highest:.1f} m/s, the most that `radar` can"
                     f" measure; {NAME_IT}")  # fmt: skip
    off = np.abs(moving / step - np.round(moving / step))
    if (share := float((off > TOLERANCE).mean())) > OFF_STEP:
        found.append(f"{share:.0%} of the velocities are no multiples of {step:.3g} m/s, the step of `radar`;"
                     f" {NAME_IT}")  # fmt: skip
    return found


def _of_ways(recordings: Sequence[PointRecording], radar: Quantisation) -> list[str]:
    went_m, said_m = _ways(recordings, radar.max_velocity_mps / 2)
    if len(went_m) < FEWEST / 10 or np.sqrt(np.mean(went_m**2)) < LEAST_WAY_M or not said_m.any():
        return []
    related = float(went_m @ said_m / np.sqrt((went_m @ went_m) * (said_m @ said_m)))
    times = float(went_m @ said_m / (said_m @ said_m))
    if related < OPPOSED:
        return ['whoever moves comes nearer where velocities say that they go away; name the column "velocity_towards"'
                ' (or "velocity", where it is named so)']  # fmt: skip
    if related > RELATED and not SLOWEST < times < FASTEST:
        return [f"whoever moves gets {times:.1f} times as far as velocities say; check frame_rate_hz and the unit of"
                " velocities"]  # fmt: skip
    return []


def _ways(recordings: Sequence[PointRecording], fastest_mps: float) -> tuple[np.ndarray, np.ndarray]:
    """Changes of the mean range of moving points within LAG_S, and those that their velocities say, (way,)."""
    went, said = [np.zeros(0)], [np.zeros(0)]
    for recording in recordings:
        cloud, frames = near_median(recording.cloud), recording.num_frames
        lag = max(round(LAG_S * recording.frame_rate_hz), 1)
        if frames <= lag:
            continue
        count = np.bincount(cloud.frame, minlength=frames)
        range_m = cloud.range_m
        mean_m, velocity = (
            np.bincount(cloud.frame, values, minlength=frames) / np.maximum(count, 1)
            for values in (range_m, cloud.radial_velocity_mps)
        )
        way = np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2)]) / recording.frame_rate_hz
        change, expected = mean_m[lag:] - mean_m[:-lag], way[lag:] - way[:-lag]
        seen = np.convolve(count > 0, np.ones(lag + 1), mode="valid") == lag + 1
        seen &= (np.abs(change) < FARTHEST_M) & (np.abs(expected) < fastest_mps * LAG_S)
        went.append(change[seen])
        said.append(expected[seen])
    return np.concatenate(went), np.concatenate(said)


def _of_neighbours(recordings: Sequence[PointRecording], radar: Quantisation) -> list[str]:
    found: list[str] = []
    in_range, in_velocity = neighbour_shares(recordings, radar)
    for share, grouped, word in (
        (in_range, radar.groups_range, "range"), (in_velocity, radar.groups_velocity, "velocity"),
    ):  # fmt: skip
        if grouped and share > UNGROUPED:
            found.append(f"{share:.0%} of the points have a neighbour in {word}, but `radar` groups these; {NAME_IT}")
        if not grouped and share < GROUPED:
            found.append(f"{share:.0%} of the points have a neighbour in {word}, as if these were grouped, but `radar`"
                         f" does not; {NAME_IT}")  # fmt: skip
    return found


def neighbour_shares(recordings: Sequence[PointRecording], radar: Quantisation) -> tuple[float, float]:
    """Shares of the points with another one a range step, and a velocity step, farther on in the same frame."""
    shares, cells = [], []
    for recording in recordings:
        cloud = recording.cloud
        range_m = cloud.range_m
        step = np.round(cloud.radial_velocity_mps / radar.velocity_step_mps)
        cells.append(np.unique(np.stack([cloud.frame, np.round(range_m / radar.range_step_m), step], axis=1), axis=0))
    for column in (1, 2):
        pairs = total = 0
        for own in cells:
            others = [one for one in range(3) if one != column]
            order = np.lexsort([own[:, column], *(own[:, one] for one in others)])
            after = np.diff(own[order], axis=0)
            pairs += int(((after[:, others] == 0).all(axis=1) & (after[:, column] == 1)).sum())
            total += len(own)
        shares.append(pairs / max(total, 1))
    return shares[0], shares[1]


def _of_others(recordings: Sequence[PointRecording], radar: Quantisation) -> list[str]:
    """Who moves cannot be in two places."""
    apart = moving = 0
    for recording in recordings:
        cloud = recording.cloud.select(is_moving(recording.cloud))
        frames, first = np.unique(cloud.frame, return_index=True)
        if len(frames):
            spans = [
                np.maximum.reduceat(axis, first) - np.minimum.reduceat(axis, first) for axis in (cloud.x_m, cloud.y_m)
            ]
            apart, moving = apart + int((np.hypot(*spans) > APART_M).sum()), moving + len(frames)
    if radar.knows_place or moving < FEWEST / 10 or apart < OFTEN * moving:
        return []
    share = (
        f"in {apart / moving:.0%} of the frames with motion something moves {APART_M:g} m or more from something else"
    )
    what = "that moves; if it is nobody (a fan, an echo), record the empty place and name it as `background`"
    return [f"{share} {what}"]
