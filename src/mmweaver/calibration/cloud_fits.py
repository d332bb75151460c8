"""The elevation offset from point clouds of people: their height seems to change with their distance.

A phase error phi of the antennas above the others shifts the sine of every elevation by -phi wavelength / (2 pi
spacing), so a point at range r appears r times that too high. A tilted board does the same. Over several distances the
slope of height over range is the offset; at one distance it takes the true height of the people's middle.
"""

from collections.abc import Sequence

import numpy as np

from mmweaver.calibration.finding import Finding
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud
from mmweaver.core.virtual_array import elevation_rows

FEWEST_POINTS, FEWEST_FRAMES = 5, 20
STRETCH_FRAMES, BLOCKS = 40, 8  # a person stays about where they are for so many frames
NEAREST_M = 0.5
SHORTEST_SPAN_M = 0.5  # of distances between people, for a slope
SURE = 2.0  # standard errors
LARGEST_DEG = 25.0
BODY_M = 0.6  # points of a body lie so close to their median


def fit_elevation(clouds: Sequence[PointCloud], config: RadarConfig, body_z_m: float | None) -> Finding:
    """Phase offset of the upper antennas. `body_z_m`: the true mean height of people's points over the radar."""
    title = "elevation offset"
    rows = elevation_rows(config.antenna_position_m, config.wavelength_m)
    if rows is None:
        return Finding(title=title, text="its antennas show no elevation")
    bodies = [_bodies(cloud) for cloud in clouds]
    frames = sum(map(len, bodies))
    if frames < FEWEST_FRAMES:
        return Finding(title=title, text=f"{frames} frames with {FEWEST_POINTS} points of a body or more")
    stretches = [_stretches(each) for each in bodies if len(each)]
    places = np.concatenate(stretches)
    range_m = places[:, 0]
    span_m = float(np.subtract(*np.percentile(range_m, [95, 5])))
    if body_z_m is None and (span_m < SHORTEST_SPAN_M or len(places) < BLOCKS):
        return Finding(
            title=title,
            text=f"people stand within {span_m:.2f} m of one distance; it takes {SHORTEST_SPAN_M:g} m, or the true"
            " height of their middle (--body-z)",
        )  # fmt: skip
    # a board below the others' row turns the other way
    phase_per_sine = 2 * np.pi * abs(rows.spacing_m) / config.wavelength_m
    # what one recording has in common is one error: recordings are left out in turn, or parts of few
    groups = stretches if len(stretches) >= BLOCKS // 2 else np.array_split(places, min(BLOCKS, len(places)))
    others = [np.concatenate(groups[:at] + groups[at + 1 :]) for at in range(len(groups)) if len(groups) > 1]
    slope = _slope(places, body_z_m)
    error = float(np.std([_slope(each, body_z_m) for each in others]) * np.sqrt(max(len(others) - 1, 1)))
    how = f"{frames} frames from {range_m.min():.1f} to {range_m.max():.1f} m"
    if body_z_m is not None:
        how += f", their true middle at {body_z_m:+.2f} m"
    # a wave from above reaches the upper row earlier: its phase there is -2 pi spacing sine / wavelength
    degrees, error_deg = (float(np.degrees(phase_per_sine * value)) for value in (-slope, error))
    said = f"{degrees:+.1f} degrees (+-{error_deg:.1f}), or a board tilted by {np.degrees(slope):+.1f} degrees; {how}"
    if abs(degrees) < SURE * error_deg or not len(others):
        return Finding(title=title, text=f"no more than its error: {said}")
    if abs(degrees) > LARGEST_DEG:
        return Finding(title=title, text=f"too much for an error of phase; did the board stand otherwise? {said}")
    sign = 1 if _is_first_below(config) else -1
    return Finding(title=title, text=said, fields={"elevation_phase_deg": round(sign * degrees, 3)})


def _bodies(cloud: PointCloud) -> np.ndarray:
    """Median range and height (frame, 2) of the points near the middle of each frame's points."""
    found = []
    range_m = cloud.range_m
    order = np.argsort(cloud.frame, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(cloud.frame[order])) + 1):
        place = np.stack([cloud.x_m[part], cloud.y_m[part]], axis=1)
        near = np.linalg.norm(place - np.median(place, axis=0), axis=1) < BODY_M if len(part) else part
        if len(part) and near.sum() >= FEWEST_POINTS and np.median(range_m[part][near]) > NEAREST_M:
            found.append((float(np.median(range_m[part][near])), float(cloud.z_m[part][near].mean())))
    return np.array(found).reshape(-1, 2)


def _stretches(bodies: np.ndarray) -> np.ndarray:
    """Medians (stretch, 2) of range and height (frame, 2) over short times."""
    return np.array([np.median(part, axis=0) for part in np.array_split(bodies, -(-len(bodies) // STRETCH_FRAMES))])


def _slope(places: np.ndarray, body_z_m: float | None) -> float:
    """How much higher people appear a metre farther away, of places (stretch, 2)."""
    range_m, height_m = places.T
    if body_z_m is not None:
        return float(np.median((height_m - body_z_m) / range_m))
    return float(np.polyfit(range_m, height_m, 1)[0])


def _is_first_below(config: RadarConfig) -> bool:
    """Whether the transmitters off the first one's row lie above it."""
    height_m = np.array(config.tx_position_m)[:, 2] - config.tx_position_m[0][2]
    return bool(height_m[np.abs(height_m).argmax()] > 0)
