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
SHORTEST_SPAN_M = 0.5  # of distances between people, for a slope
BODY_M = 0.6  # points of a body lie so close to their median


def fit_elevation(clouds: Sequence[PointCloud], config: RadarConfig, body_z_m: float | None) -> Finding:
    """Phase offset of the upper antennas. `body_z_m`: the true mean height of people's points over the radar."""
    title = "elevation offset"
    rows = elevation_rows(config.antenna_position_m, config.wavelength_m)
    if rows is None:
        return Finding(title=title, text="its antennas show no elevation")
    places = np.concatenate([_bodies(cloud) for cloud in clouds])
    if len(places) < FEWEST_FRAMES:
        return Finding(title=title, text=f"{len(places)} frames with {FEWEST_POINTS} points of a body or more")
    range_m, height_m = places.T
    span_m = float(np.subtract(*np.percentile(range_m, [95, 5])))
    if body_z_m is None and span_m < SHORTEST_SPAN_M:
        return Finding(
            title=title,
            text=f"people stand within {span_m:.2f} m of one distance; it takes {SHORTEST_SPAN_M:g} m, or the true"
            " height of their middle (--body-z)",
        )  # fmt: skip
    # a board below the others' row turns the other way
    phase_per_sine = 2 * np.pi * abs(rows.spacing_m) / config.wavelength_m
    if body_z_m is None:
        slope, error, height = _line(range_m, height_m)
        how = f"{len(places)} frames from {range_m.min():.1f} to {range_m.max():.1f} m; their middle at {height:+.2f} m"
    else:
        each = (height_m - body_z_m) / range_m
        slope, error = float(np.median(each)), float(each.std() / np.sqrt(_independent(each)))
        how = f"{len(places)} frames around {np.median(range_m):.2f} m, their true middle at {body_z_m:+.2f} m"
    # a wave from above reaches the upper row earlier: its phase there is -2 pi spacing sine / wavelength
    degrees, error_deg = (float(np.degrees(phase_per_sine * value)) for value in (-slope, error))
    lies = "upper" if _is_first_below(config) else "lower"
    said = f"{degrees:+.1f} degrees (+-{error_deg:.1f}), or a board tilted by {np.degrees(slope):+.1f} degrees; {how}"
    if abs(degrees) < 2 * error_deg:
        return Finding(title=title, text=f"no more than its error: {said}")
    sign = 1 if lies == "upper" else -1
    return Finding(title=title, text=said, fields={"elevation_phase_deg": round(sign * degrees, 3)})


def _bodies(cloud: PointCloud) -> np.ndarray:
    """Median range and height (frame, 2) of the points near the middle of each frame's points."""
    found = []
    range_m = np.sqrt(cloud.x_m**2 + cloud.y_m**2 + cloud.z_m**2)
    order = np.argsort(cloud.frame, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(cloud.frame[order])) + 1):
        place = np.stack([cloud.x_m[part], cloud.y_m[part]], axis=1)
        near = np.linalg.norm(place - np.median(place, axis=0), axis=1) < BODY_M if len(part) else part
        if len(part) and near.sum() >= FEWEST_POINTS:
            found.append((float(np.median(range_m[part][near])), float(cloud.z_m[part][near].mean())))
    return np.array(found).reshape(-1, 2)


def _line(range_m: np.ndarray, height_m: np.ndarray) -> tuple[float, float, float]:
    """Slope of height over range, its error, and the height at range 0."""
    design = np.column_stack([np.ones(len(range_m)), range_m])
    fitted = np.linalg.lstsq(design, height_m, rcond=None)[0]
    rest = height_m - design @ fitted
    variance = rest.var() * len(rest) / _independent(rest)
    error = np.sqrt(variance * np.linalg.inv(design.T @ design)[1, 1])
    return float(fitted[1]), float(error), float(fitted[0])


def _independent(values: np.ndarray) -> float:
    """How many independent values a slowly varying series is worth: by its correlation from one to the next."""
    rest = values - values.mean()
    correlation = float((rest[1:] * rest[:-1]).mean() / max(rest.var(), 1e-30)) if len(rest) > 1 else 0.0
    correlation = min(max(correlation, 0.0), 0.99)
    return max(1.0, len(values) * (1 - correlation) / (1 + correlation))


def _is_first_below(config: RadarConfig) -> bool:
    """Whether the transmitters off the first one's row lie above it."""
    height_m = np.array(config.tx_position_m)[:, 2] - config.tx_position_m[0][2]
    return bool(height_m[np.abs(height_m).argmax()] > 0)
