"""Features of one window of a point-cloud recording: speeds, extents, travel and periodicity of moving points.

Only moving points count here; nearly stationary bodies are covered by body_features. Features are invariant to the
placement of room and radar and to left-right reflection. nan means too few points.
"""

import itertools

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PointCloud
from mmweaver.recognition.body_features import BANDS_HZ, Row, band_shares
from mmweaver.recognition.point_recordings import PointRecording, is_moving

SPEED_EDGES_MPS = (0.1, 0.9, 1.5, 2.2, 3.2, 99.0)  # of one, two, three, four and five, and more bins of 0.615 m/s
SEGMENTS = 4
FEWEST = 3  # points for a spread
UNPREDICTABLE = {"up", "uneven"}  # words in names of features that are excluded by default


def window_features(window: PointRecording) -> Row:
    """Named features of one window."""
    cloud = window.cloud
    moving = is_moving(cloud)
    points = _Moving(cloud, moving, window)
    row: Row = {}
    row.update(_speeds(points))
    row.update(_duty(points))
    row.update(_places(points))
    row.update(_travel(points))
    row.update(_couplings(points))
    row.update(_rhythm(points))
    return row


def moving_points(window: PointRecording) -> float:
    """The mean number of moving points a frame."""
    return float(is_moving(window.cloud).sum() / window.num_frames)


class _Moving:
    """The moving points of a window as columns."""

    def __init__(self, cloud: PointCloud, which: np.ndarray, window: PointRecording):
        self.num_frames, self.rate_hz = window.num_frames, window.frame_rate_hz
        self.frame = cloud.frame[which].astype(int)
        self.speed = cloud.radial_velocity_mps[which]
        self.range_m = cloud.range_m[which]
        self.across_m, self.up_m = cloud.x_m[which], cloud.z_m[which]
        self.time_s = self.frame / self.rate_hz

    def __len__(self) -> int:
        return len(self.frame)

    def per_frame(self, weight: np.ndarray | None = None) -> Float[np.ndarray, " frame"]:
        """Number of points, or sum of their weights (point,), of each frame (frame,)."""
        return np.bincount(self.frame, weight, minlength=self.num_frames).astype(float)


def _speeds(points: _Moving) -> Row:
    """Points per frame and share of moving points by velocity."""
    row: Row = {}
    total = max(len(points), 1)
    magnitude = np.abs(points.speed)
    for index, (low, high) in enumerate(itertools.pairwise(SPEED_EDGES_MPS)):
        inside = (magnitude >= low) & (magnitude < high)
        for sign, word in ((1, "away"), (-1, "near")):
            count = float((inside & (np.sign(points.speed) == sign)).sum())
            row[f"rate_{word}_{index}"] = float(np.log1p(10 * count / points.num_frames))
            row[f"share_{word}_{index}"] = count / total
    row["rate"] = float(np.log1p(10 * len(points) / points.num_frames))
    row["speed_mean"] = float(magnitude.mean()) if len(points) else np.nan
    row["speed_90"] = float(np.quantile(magnitude, 0.9)) if len(points) else np.nan
    row["velocity_mean"] = float(points.speed.mean()) if len(points) else np.nan
    row["balance"] = float(abs(np.sign(points.speed).sum()) / total)
    return row


def _duty(points: _Moving) -> Row:
    """Share of frames with motion, in either or both directions, and duration of bursts."""
    away, near = points.per_frame((points.speed > 0) * 1.0), points.per_frame((points.speed < 0) * 1.0)
    fast = points.per_frame((np.abs(points.speed) > SPEED_EDGES_MPS[2]) * 1.0)
    count = away + near
    row = {
        "frames_moving": float((count > 0).mean()),
        "frames_both": float(((away > 0) & (near > 0)).mean()),
        "frames_fast": float((fast > 0).mean()),
        "both_of_moving": float(((away > 0) & (near > 0)).sum() / max((count > 0).sum(), 1)),
        "fast_of_moving": float((fast > 0).sum() / max((count > 0).sum(), 1)),
        "count_90": float(np.quantile(count, 0.9)),
        "count_uneven": float(count.std() / max(count.mean(), 1e-9)) if len(points) else np.nan,
    }
    for word, signal in (("moving", count), ("away", away), ("near", near), ("fast", fast)):
        runs, longest = _runs(signal > 0)
        row[f"bursts_{word}"] = float(runs)
        row[f"burst_length_{word}"] = longest / points.rate_hz
    return row


def _runs(on: np.ndarray) -> tuple[int, float]:
    """Number of runs of True (gaps of one frame closed) and their mean length in frames."""
    closed = on.copy()
    closed[1:-1] |= on[:-2] & on[2:]
    starts = int(closed[0]) + int(((~closed[:-1]) & closed[1:]).sum())
    return starts, float(closed.sum() / starts) if starts else 0.0


def _places(points: _Moving) -> Row:
    """Spread in range, cross-range and height of all, slow and fast moving points."""
    row: Row = {}
    magnitude = np.abs(points.speed)
    groups = {
        "all": magnitude > 0,
        "slow": magnitude < SPEED_EDGES_MPS[1],
        "quick": magnitude >= SPEED_EDGES_MPS[1],
        "fast": magnitude >= SPEED_EDGES_MPS[2],
    }
    axes = {"range": points.range_m, "across": points.across_m, "up": points.up_m}
    for word, of in groups.items():
        for axis, value in axes.items():
            there = value[of]
            enough = len(there) >= FEWEST
            row[f"{axis}_std_{word}"] = float(there.std()) if enough else np.nan
            low, high = np.quantile(there, [0.1, 0.9]) if enough else (np.nan, np.nan)
            row[f"{axis}_span_{word}"] = float(high - low)
    for axis, value in axes.items():  # position of fast points relative to slow ones
        slow, quick = value[groups["slow"]], value[groups["quick"]]
        both = len(slow) >= FEWEST and len(quick) >= FEWEST
        gap_m = float(quick.mean() - slow.mean()) if both else np.nan
        row[f"{axis}_quick_less_slow"] = abs(gap_m) if axis == "across" else gap_m
        row[f"{axis}_within_frame"] = _within_frame(points, value)
    row["up_mean"] = float(points.up_m.mean()) if len(points) else np.nan
    row["up_median_fast"] = float(np.median(points.up_m[groups["fast"]])) if groups["fast"].sum() >= FEWEST else np.nan
    return row


def _within_frame(points: _Moving, value: np.ndarray) -> float:
    """Pooled standard deviation within frames of two points or more."""
    count = points.per_frame()
    mean = points.per_frame(value) / np.maximum(count, 1)
    deviation = (value - mean[points.frame]) ** 2
    several = count[points.frame] >= 2
    free = float(several.sum() - (count >= 2).sum())
    return float(np.sqrt(deviation[several].sum() / free)) if free >= 2 else np.nan


def _travel(points: _Moving) -> Row:
    """Locomotion: range over time, and its consistency with the measured velocity."""
    row: Row = {"drift_mps": np.nan, "drift_left_m": np.nan, "travel_m": np.nan, "drift_less_velocity": np.nan}
    if len(points) >= 2 * FEWEST and np.ptp(points.time_s) > 0:
        slope, start = np.polyfit(points.time_s, points.range_m, 1)
        row["drift_mps"] = float(abs(slope))
        row["drift_left_m"] = float((points.range_m - start - slope * points.time_s).std())
        row["drift_less_velocity"] = float(abs(points.speed.mean() - slope))
    which = np.minimum(points.frame * SEGMENTS // points.num_frames, SEGMENTS - 1)
    middles, speeds = [], []
    for segment in range(SEGMENTS):
        inside = which == segment
        if inside.sum() >= 2:
            middles.append(float(np.median(points.range_m[inside])))
            speeds.append(float(points.speed[inside].mean()))
    row["travel_m"] = max(middles) - min(middles) if len(middles) > 1 else np.nan
    row["one_way"] = abs(float(np.mean(np.sign(speeds)))) if speeds else np.nan
    return row


def _couplings(points: _Moving) -> Row:
    """Correlations of velocity with height, range and cross-range."""
    row: Row = {}
    magnitude = np.abs(points.speed)
    aside = np.abs(points.across_m - np.median(points.across_m)) if len(points) else points.across_m
    pairs = {
        "velocity_up": (points.speed, points.up_m), "velocity_range": (points.speed, points.range_m),
        "speed_up": (magnitude, points.up_m), "speed_range": (magnitude, points.range_m),
        "speed_aside": (magnitude, aside),
    }  # fmt: skip
    for name, (one, other) in pairs.items():
        row[name] = _correlation(one, other)
    away, near = points.speed > 0, points.speed < 0
    for axis, value in {"range": points.range_m, "up": points.up_m}.items():
        both = away.sum() >= FEWEST and near.sum() >= FEWEST
        row[f"{axis}_away_less_near"] = float(value[away].mean() - value[near].mean()) if both else np.nan
    return row


def _correlation(one: np.ndarray, other: np.ndarray) -> float:
    if len(one) < 2 * FEWEST or one.std() < 1e-9 or other.std() < 1e-9:
        return np.nan
    return float(np.corrcoef(one, other)[0, 1])


def _rhythm(points: _Moving) -> Row:
    """Band powers and strongest frequency of three time series."""
    row: Row = {}
    signals = {
        "momentum": points.per_frame(points.speed),
        "count": points.per_frame(),
        "effort": points.per_frame(points.speed**2),
    }
    for word, signal in signals.items():
        centred = signal - signal.mean()
        power = np.abs(np.fft.rfft(centred * np.hanning(len(signal)), 4 * len(signal))) ** 2
        frequency = np.fft.rfftfreq(4 * len(signal), 1 / points.rate_hz)
        row.update(band_shares(power, frequency, word))
        inside = (frequency >= BANDS_HZ[0][0]) & (frequency < BANDS_HZ[-1][1])
        known = power[inside].sum() > 0
        row[f"{word}_top_hz"] = float(frequency[inside][np.argmax(power[inside])]) if known else np.nan
        row[f"{word}_regular"] = _regularity(centred, points.rate_hz)
    return row


def _regularity(signal: np.ndarray, rate_hz: float) -> float:
    """The highest autocorrelation at a lag of a quarter to one and a quarter seconds."""
    power = float(signal @ signal)
    if power <= 0:
        return np.nan
    first, last = round(0.25 * rate_hz), min(round(1.25 * rate_hz), len(signal) - 2)
    values = [float(signal[lag:] @ signal[:-lag]) / power for lag in range(first, last + 1)]
    return max(values) if values else np.nan
