"""Features of nearly stationary bodies: static points that come and go, and the position of the body over time.

Slow motion has zero velocity for a radar of coarse resolution: squats look like a static spot that shifts by 20 cm and
back, hops like one that flickers twice per second. Range cells that are nearly always occupied count as the room.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from mmweaver.core.records import PointCloud
from mmweaver.recognition.point_recordings import PointRecording, is_moving

CELL_M = 0.05
FARTHEST_M = 6.0
FIXED = 0.9  # share of frames from which a cell counts as the room
SELDOM = 0.03
REACH_M = 0.7  # extent of a body about its centre
SEGMENTS = 8
FEWEST = 3  # points for a position
BANDS_HZ = ((0.3, 0.8), (0.8, 1.3), (1.3, 1.8), (1.8, 2.3), (2.3, 3.3), (3.3, 5.3), (5.3, 10.0))

Row = dict[str, float]


@dataclass(frozen=True, kw_only=True)
class BodyPoints:
    """Points of the body in a window: moving ones, and static ones that do not belong to the room."""

    window: PointRecording
    range_m: Float[np.ndarray, " point"]
    is_moving: Bool[np.ndarray, " point"]
    is_static: Bool[np.ndarray, " point"]
    cells: Float[np.ndarray, "frame cell"]  # 1 where a cell of the body has a static point

    @property
    def cloud(self) -> PointCloud:
        return self.window.cloud


def body_points(window: PointRecording) -> BodyPoints:
    """Removes the room, then everything beyond a body's extent from the median range of change."""
    cloud, frames = window.cloud, window.num_frames
    range_m = cloud.range_m
    moves = is_moving(cloud)
    cell = np.minimum((range_m / CELL_M).astype(int), int(FARTHEST_M / CELL_M) - 1)
    full = np.zeros((frames, int(FARTHEST_M / CELL_M)), bool)
    full[cloud.frame[~moves], cell[~moves]] = True
    share = full.mean(axis=0)
    changes = share * (1 - share) * frames * (share <= FIXED) + np.bincount(cell[moves], minlength=len(share))
    near = np.zeros(len(share), bool)
    if changes.sum() > 0:
        running = np.cumsum(changes)
        middle = int(np.searchsorted(running, running[-1] / 2))
        near = np.abs(np.arange(len(share)) - middle) <= REACH_M / CELL_M
    own = near & (share <= FIXED)
    kept = own & (share > SELDOM)
    return BodyPoints(
        window=window, range_m=range_m, is_moving=moves & near[cell], is_static=~moves & own[cell],
        cells=full[:, kept].astype(float),
    )  # fmt: skip


def body_features(window: PointRecording) -> Row:
    """Named features of one window; nan means too few points."""
    points = body_points(window)
    row = _flicker(points)
    row.update(_whereabouts(points, points.is_moving | points.is_static, "body"))
    row.update(_whereabouts(points, points.is_static, "rest"))
    row["moving_share"] = float(points.is_moving.sum() / max((points.is_moving | points.is_static).sum(), 1))
    return row


def band_shares(power: np.ndarray, frequency_hz: np.ndarray, word: str) -> Row:
    """Shares of the power in frequency bands; nan without power."""
    inside = (frequency_hz >= BANDS_HZ[0][0]) & (frequency_hz < BANDS_HZ[-1][1])
    total = power[inside].sum()
    row: Row = {}
    for low, high in BANDS_HZ:
        band = (frequency_hz >= low) & (frequency_hz < high)
        row[f"{word}_{low:g}_hz"] = float(power[band].sum() / total) if total > 0 else np.nan
    return row


def _flicker(points: BodyPoints) -> Row:
    """Rhythm in which static cells fill and empty, individually and jointly."""
    cells, frames = points.cells, points.window.num_frames
    frequency_hz = np.fft.rfftfreq(4 * frames, 1 / points.window.frame_rate_hz)
    centred = cells - cells.mean(axis=0)
    together = centred.sum(axis=1)

    def power(signal: np.ndarray) -> np.ndarray:
        return np.abs(np.fft.rfft(signal * np.hanning(frames)[:, None], 4 * frames, axis=0)) ** 2

    variance = float(centred.var(axis=0).sum()) if cells.size else 0.0
    return {
        "rest_cells": float(cells.shape[1]),
        "rest_rate": float(np.log1p(points.is_static.sum() / frames)),
        "rest_together": float(together.var() / variance) if variance > 0 else np.nan,
        **band_shares(power(centred).sum(axis=1), frequency_hz, "flicker"),
        **band_shares(power(together[:, None])[:, 0], frequency_hz, "flicker_together"),
    }


def _whereabouts(points: BodyPoints, which: np.ndarray, word: str) -> Row:
    """Changes of the body's median, nearest and farthest range and its height between segments."""
    frames = points.window.num_frames
    frame = points.cloud.frame.astype(int)
    segment = np.minimum(frame * SEGMENTS // frames, SEGMENTS - 1)
    count = np.bincount(segment[which], minlength=SEGMENTS)
    places = np.full((4, SEGMENTS), np.nan)
    for one in np.flatnonzero(count >= FEWEST):
        own = which & (segment == one)
        low, middle, high = np.quantile(points.range_m[own], [0.1, 0.5, 0.9])
        places[:, one] = middle, low, high, np.median(points.cloud.z_m[own])
    known = places[:, count >= FEWEST]
    several = known.shape[1] > 1
    row: Row = {
        f"{word}_segments": float(known.shape[1]),
        f"{word}_uneven": float(count.std() / max(count.mean(), 1e-9)),
        f"{word}_width": float(np.median(known[2] - known[1])) if known.size else np.nan,
        f"{word}_width_std": float((known[2] - known[1]).std()) if several else np.nan,
        f"{word}_way": float(abs(known[0, -1] - known[0, 0])) if several else np.nan,
    }
    for name, value in zip(("middle", "near", "far", "up"), known, strict=True):
        row[f"{word}_{name}_span"] = float(np.ptp(value)) if several else np.nan
        row[f"{word}_{name}_std"] = float(value.std()) if several else np.nan
    return row
