"""Features of one window of a point-cloud recording: speeds, extents, travel and rhythm of moving and static points.

They are invariant to the placement of room and radar and to left-right reflection. nan means too few points.
"""

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording, is_moving

SPEED_EDGES_MPS = (0.1, 0.9, 1.5, 2.2, 3.2, 99.0)  # of one, two, three, four and five, and more bins of 0.615 m/s
BANDS_HZ = ((0.3, 0.8), (0.8, 1.3), (1.3, 1.8), (1.8, 2.3), (2.3, 3.3), (3.3, 5.3), (5.3, 10.0))
SEGMENTS = 4
FEWEST = 3  # minimum number of points for a spread, or for a position
UNPREDICTABLE = {"up", "uneven"}  # words in names of features that are excluded by default
CELL_M, FARTHEST_M = 0.05, 6.0  # range cells of static points
FIXED, SELDOM = 0.9, 0.03  # shares of frames from which a cell belongs to the room, and up to which it is ignored
REACH_M = 0.7  # extent of a body around its centre
BODY_SEGMENTS = 8

Row = dict[str, Any]  # numbers by name


def window_features(window: PointRecording) -> Row:
    """Named features of the moving points of one window."""
    points = replace(window, cloud=window.cloud.select(is_moving(window.cloud)))
    return {
        **_speeds(points),
        **_duty(points),
        **_places(points),
        **_travel(points),
        **_couplings(points.cloud),
        **_rhythm(points),
    }


def moving_points(window: PointRecording) -> float:
    """The mean number of moving points per frame."""
    return float(is_moving(window.cloud).sum() / window.num_frames)


def mean_of(values: np.ndarray) -> float:
    """Mean value, nan without values."""
    return float(values.mean()) if len(values) else np.nan


def correlation(one: np.ndarray, other: np.ndarray) -> float:
    """Correlation coefficient, nan where one does not vary."""
    if one.std() < 1e-9 or other.std() < 1e-9:
        return np.nan
    return float(np.corrcoef(one, other)[0, 1])


def _per_frame(points: PointRecording, weight: np.ndarray | None = None) -> Float[np.ndarray, " frame"]:
    """Number of points, or sum of their weights (point,), of each frame."""
    return np.bincount(points.cloud.frame, weight, minlength=points.num_frames).astype(float)


# moving points ------------------------------------------------------------------------------------------------------
def _speeds(points: PointRecording) -> Row:
    """Points per frame and share of moving points by velocity."""
    row: Row = {}
    velocity = points.cloud.radial_velocity_mps
    speed, total = np.abs(velocity), max(len(velocity), 1)
    for index, (low, high) in enumerate(itertools.pairwise(SPEED_EDGES_MPS)):
        inside = (speed >= low) & (speed < high)
        for sign, word in ((1, "away"), (-1, "near")):
            count = float((inside & (np.sign(velocity) == sign)).sum())
            row[f"rate_{word}_{index}"] = np.log1p(10 * count / points.num_frames)
            row[f"share_{word}_{index}"] = count / total
    row["rate"] = np.log1p(10 * len(velocity) / points.num_frames)
    row["speed_mean"] = mean_of(speed)
    row["speed_90"] = np.quantile(speed, 0.9) if len(speed) else np.nan
    row["velocity_mean"] = mean_of(velocity)
    row["balance"] = abs(np.sign(velocity).sum()) / total
    return row


def _duty(points: PointRecording) -> Row:
    """Share of frames with motion, in either or both directions, and duration of bursts."""
    velocity = points.cloud.radial_velocity_mps
    away, near, fast = (
        _per_frame(points, which * 1.0) for which in (velocity > 0, velocity < 0, np.abs(velocity) > SPEED_EDGES_MPS[2])
    )
    count = away + near
    both, moving = (away > 0) & (near > 0), max((count > 0).sum(), 1)
    row = {
        "frames_moving": (count > 0).mean(),
        "frames_both": both.mean(),
        "frames_fast": (fast > 0).mean(),
        "both_of_moving": both.sum() / moving,
        "fast_of_moving": (fast > 0).sum() / moving,
        "count_90": np.quantile(count, 0.9),
        "count_uneven": count.std() / max(count.mean(), 1e-9) if len(velocity) else np.nan,
    }
    for word, signal in (("moving", count), ("away", away), ("near", near), ("fast", fast)):
        closed = signal > 0
        closed[1:-1] |= closed[:-2] & closed[2:]  # gaps of one frame
        bursts = int(closed[0]) + int((~closed[:-1] & closed[1:]).sum())
        row[f"bursts_{word}"] = bursts
        row[f"burst_length_{word}"] = float(closed.sum() / bursts) / points.frame_rate_hz if bursts else 0.0
    return row


def _places(points: PointRecording) -> Row:
    """Spread in range, cross-range and height of all, slow and fast moving points."""
    row: Row = {}
    cloud = points.cloud
    speed = np.abs(cloud.radial_velocity_mps)
    groups = {
        "all": speed > 0,
        "slow": speed < SPEED_EDGES_MPS[1],
        "quick": speed >= SPEED_EDGES_MPS[1],
        "fast": speed >= SPEED_EDGES_MPS[2],
    }
    axes = {"range": cloud.range_m, "across": cloud.x_m, "up": cloud.z_m}
    for word, which in groups.items():
        for axis, value in axes.items():
            there = value[which]
            low, high = np.quantile(there, [0.1, 0.9]) if len(there) >= FEWEST else (np.nan, np.nan)
            row[f"{axis}_std_{word}"] = there.std() if len(there) >= FEWEST else np.nan
            row[f"{axis}_span_{word}"] = high - low
    for axis, value in axes.items():  # position of fast points relative to slow ones
        gap_m = _difference(value[groups["quick"]], value[groups["slow"]])
        row[f"{axis}_quick_less_slow"] = abs(gap_m) if axis == "across" else gap_m
        row[f"{axis}_within_frame"] = _within_frame(points, value)
    row["up_mean"] = mean_of(cloud.z_m)
    fast_m = cloud.z_m[groups["fast"]]
    row["up_median_fast"] = np.median(fast_m) if len(fast_m) >= FEWEST else np.nan
    return row


def _difference(one: np.ndarray, other: np.ndarray) -> float:
    """Difference of the means, nan with too few values."""
    return float(one.mean() - other.mean()) if min(len(one), len(other)) >= FEWEST else np.nan


def _within_frame(points: PointRecording, value: np.ndarray) -> float:
    """Pooled standard deviation within frames of two points or more."""
    count, frame = _per_frame(points), points.cloud.frame
    mean = _per_frame(points, value) / np.maximum(count, 1)
    deviation = (value - mean[frame]) ** 2
    several = count[frame] >= 2
    free = float(several.sum() - (count >= 2).sum())
    return float(np.sqrt(deviation[several].sum() / free)) if free >= 2 else np.nan


def _travel(points: PointRecording) -> Row:
    """Locomotion: range over time, and its consistency with the measured velocity."""
    row: Row = {"drift_mps": np.nan, "drift_left_m": np.nan, "travel_m": np.nan, "drift_less_velocity": np.nan}
    cloud, range_m = points.cloud, points.cloud.range_m
    time_s = cloud.frame / points.frame_rate_hz
    if len(time_s) >= 2 * FEWEST and np.ptp(time_s) > 0:
        slope, start = np.polyfit(time_s, range_m, 1)
        row["drift_mps"] = abs(slope)
        row["drift_left_m"] = (range_m - start - slope * time_s).std()
        row["drift_less_velocity"] = abs(cloud.radial_velocity_mps.mean() - slope)
    segment = np.minimum(cloud.frame * SEGMENTS // points.num_frames, SEGMENTS - 1)
    inside = [segment == one for one in range(SEGMENTS) if (segment == one).sum() >= 2]
    middles = [float(np.median(range_m[one])) for one in inside]
    speeds = [float(cloud.radial_velocity_mps[one].mean()) for one in inside]
    row["travel_m"] = max(middles) - min(middles) if len(middles) > 1 else np.nan
    row["one_way"] = abs(float(np.mean(np.sign(speeds)))) if speeds else np.nan
    return row


def _couplings(cloud: PointCloud) -> Row:
    """Correlations of velocity with height, range and cross-range."""
    velocity, range_m, up_m = cloud.radial_velocity_mps, cloud.range_m, cloud.z_m
    speed = np.abs(velocity)
    aside_m = np.abs(cloud.x_m - np.median(cloud.x_m)) if len(speed) else cloud.x_m
    pairs = {
        "velocity_up": (velocity, up_m),
        "velocity_range": (velocity, range_m),
        "speed_up": (speed, up_m),
        "speed_range": (speed, range_m),
        "speed_aside": (speed, aside_m),
    }
    row = {name: correlation(*pair) if len(speed) >= 2 * FEWEST else np.nan for name, pair in pairs.items()}
    for axis, value in {"range": range_m, "up": up_m}.items():
        row[f"{axis}_away_less_near"] = _difference(value[velocity > 0], value[velocity < 0])
    return row


def _rhythm(points: PointRecording) -> Row:
    """Band powers and strongest frequency of three time series."""
    row: Row = {}
    velocity = points.cloud.radial_velocity_mps
    for word, weight in {"momentum": velocity, "count": None, "effort": velocity**2}.items():
        signal = _per_frame(points, weight)
        centred = signal - signal.mean()
        power = np.abs(np.fft.rfft(centred * np.hanning(len(signal)), 4 * len(signal))) ** 2
        frequency = np.fft.rfftfreq(4 * len(signal), 1 / points.frame_rate_hz)
        row |= _band_shares(power, frequency, word)
        inside = (frequency >= BANDS_HZ[0][0]) & (frequency < BANDS_HZ[-1][1])
        known = power[inside].sum() > 0
        row[f"{word}_top_hz"] = frequency[inside][np.argmax(power[inside])] if known else np.nan
        row[f"{word}_regular"] = _regularity(centred, points.frame_rate_hz)
    return row


def _regularity(signal: np.ndarray, rate_hz: float) -> float:
    """The highest autocorrelation at a lag of a quarter to one and a quarter seconds."""
    power = float(signal @ signal)
    first, last = round(0.25 * rate_hz), min(round(1.25 * rate_hz), len(signal) - 2)
    if power <= 0 or last < first:
        return np.nan
    return max(float(signal[lag:] @ signal[:-lag]) / power for lag in range(first, last + 1))


def _band_shares(power: np.ndarray, frequency_hz: np.ndarray, word: str) -> Row:
    """Shares of the power in frequency bands; nan without power."""
    total = power[(frequency_hz >= BANDS_HZ[0][0]) & (frequency_hz < BANDS_HZ[-1][1])].sum()
    row: Row = {}
    for low, high in BANDS_HZ:
        band = (frequency_hz >= low) & (frequency_hz < high)
        row[f"{word}_{low:g}_hz"] = power[band].sum() / total if total > 0 else np.nan
    return row


# nearly stationary bodies -------------------------------------------------------------------------------------------
def body_features(window: PointRecording) -> Row:
    """Named features of nearly stationary bodies: intermittent static points, and the body's position over time.

    Slow motion has zero velocity for a radar of coarse resolution: squats look like a static spot that shifts by 20 cm
    and back, hops like one that flickers twice per second. Range cells that are nearly always occupied belong to the
    room, and so does everything beyond a body's extent from the median range of change.
    """
    cloud, frames, moves = window.cloud, window.num_frames, is_moving(window.cloud)
    num_cells = int(FARTHEST_M / CELL_M)
    cell = np.minimum((cloud.range_m / CELL_M).astype(int), num_cells - 1)
    full = np.zeros((frames, num_cells), bool)
    full[cloud.frame[~moves], cell[~moves]] = True
    share = full.mean(axis=0)
    changes = share * (1 - share) * frames * (share <= FIXED) + np.bincount(cell[moves], minlength=num_cells)
    near = np.zeros(num_cells, bool)
    if changes.sum() > 0:
        running = np.cumsum(changes)
        middle = int(np.searchsorted(running, running[-1] / 2))
        near = np.abs(np.arange(num_cells) - middle) <= REACH_M / CELL_M
    own = near & (share <= FIXED)
    moving, static = moves & near[cell], ~moves & own[cell]
    return {
        **_flicker(full[:, own & (share > SELDOM)].astype(float), float(static.sum()), window.frame_rate_hz),
        **_whereabouts(window, moving | static, "body"),
        **_whereabouts(window, static, "rest"),
        "moving_share": moving.sum() / max((moving | static).sum(), 1),
    }


def _flicker(cells: Float[np.ndarray, "frame cell"], static: float, rate_hz: float) -> Row:
    """Rhythm in which static cells, 1 where they have a point, become filled and empty, individually and jointly."""
    frames = len(cells)
    frequency_hz = np.fft.rfftfreq(4 * frames, 1 / rate_hz)
    centred = cells - cells.mean(axis=0)
    together = centred.sum(axis=1)

    def power(signal: np.ndarray) -> np.ndarray:
        return np.abs(np.fft.rfft(signal * np.hanning(frames)[:, None], 4 * frames, axis=0)) ** 2

    variance = float(centred.var(axis=0).sum()) if cells.size else 0.0
    return {
        "rest_cells": cells.shape[1],
        "rest_rate": np.log1p(static / frames),
        "rest_together": together.var() / variance if variance > 0 else np.nan,
        **_band_shares(power(centred).sum(axis=1), frequency_hz, "flicker"),
        **_band_shares(power(together[:, None])[:, 0], frequency_hz, "flicker_together"),
    }


def _whereabouts(window: PointRecording, which: Bool[np.ndarray, " point"], word: str) -> Row:
    """Changes of the body's median, nearest and farthest range and its height between segments."""
    cloud = window.cloud.select(which)
    segment = np.minimum(cloud.frame * BODY_SEGMENTS // window.num_frames, BODY_SEGMENTS - 1)
    count, range_m = np.bincount(segment, minlength=BODY_SEGMENTS), cloud.range_m
    known = np.zeros((4, 0))
    for one in np.flatnonzero(count >= FEWEST):
        own = segment == one
        low, middle, high = np.quantile(range_m[own], [0.1, 0.5, 0.9])
        known = np.column_stack([known, (middle, low, high, np.median(cloud.z_m[own]))])
    several, width = known.shape[1] > 1, known[2] - known[1]
    row: Row = {
        f"{word}_segments": known.shape[1],
        f"{word}_uneven": count.std() / max(count.mean(), 1e-9),
        f"{word}_width": np.median(width) if known.size else np.nan,
        f"{word}_width_std": width.std() if several else np.nan,
        f"{word}_way": abs(known[0, -1] - known[0, 0]) if several else np.nan,
    }
    for name, value in zip(("middle", "near", "far", "up"), known, strict=True):
        row[f"{word}_{name}_span"] = np.ptp(value) if several else np.nan
        row[f"{word}_{name}_std"] = value.std() if several else np.nan
    return row
