"""Pattern of one antenna as a table: cosine powers of published widths, or antenna.csv."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE
from mmweaver.core.safe_files.safe_text import read_text

Pattern = tuple[tuple[float, float, float], ...]  # azimuth and elevation in degrees, gain in dB relative to boresight
# fields of RadarConfig that a board determines
ELECTRICAL = (
    "tx_power_dbm",
    "antenna_gain_dbi",
    "noise_figure_db",
    "azimuth_beamwidth_deg",
    "elevation_beamwidth_deg",
    "antenna_pattern",
)
STEP_DEG, FLOOR_DB = 5, -25.0  # of patterns made of cosine powers


def cosine_pattern(in_azimuth: float, in_elevation: float) -> dict[str, Any]:
    """Beamwidths and pattern of an antenna whose power falls as cosine powers of azimuth and elevation.

    Args:
        in_azimuth: Exponent of the power in azimuth.
        in_elevation: Exponent in elevation.

    Returns:
        The fields of RadarConfig, with cuts of the pattern in steps of 5 degrees.
    """
    angles = np.arange(-90, 91, STEP_DEG)
    fall_db = 10 * np.log10(np.maximum(np.cos(np.radians(angles)), 1e-3))
    cuts = [np.maximum(power * fall_db, FLOOR_DB).round(3) for power in (in_azimuth, in_elevation)]
    rows = [(float(at), 0.0, float(db)) for at, db in zip(angles, cuts[0], strict=True)]
    rows += [(0.0, float(at), float(db)) for at, db in zip(angles, cuts[1], strict=True) if at]
    widths = [2 * float(np.degrees(np.arccos(0.5 ** (1 / power)))) for power in (in_azimuth, in_elevation)]
    return {
        "azimuth_beamwidth_deg": round(widths[0], 1),
        "elevation_beamwidth_deg": round(widths[1], 1),
        "antenna_pattern": tuple(rows),
    }


def read_pattern(path: Path | str) -> Pattern:
    """Reads antenna.csv: azimuth and elevation in degrees, gain in dB, one row each; a first line of words is skipped.

    Rows along azimuth 0 and elevation 0 alone are two cuts, which add up; anything else is a full grid.

    Args:
        path: The file.

    Raises:
        InputError: If a row is not three numbers, an angle is impossible, or the grid has holes.
    """
    rows = []
    for number, line in enumerate(read_text(path, max_bytes=4 * MEGABYTE).splitlines(), 1):
        words = line.replace(";", ",").split(",")
        if not line.strip() or (number == 1 and any(character.isalpha() for character in words[0])):
            continue
        try:
            azimuth, elevation, gain_db = map(float, words)
        except ValueError:
            raise InputError(f"{path}, line {number}: write azimuth, elevation, dB, three numbers") from None
        rows.append((azimuth, elevation, gain_db))
    pattern = tuple(sorted(rows))
    try:
        pattern_grid(pattern)
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
    return pattern


@lru_cache(maxsize=32)
def pattern_grid(pattern: Pattern) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A pattern as a grid.

    Args:
        pattern: Rows of azimuth, elevation and gain.

    Returns:
        Azimuths (a,) and elevations (e,) in degrees, increasing, and losses (a, e) in dB relative to the row nearest to
        boresight.

    Raises:
        ValueError: If there are no rows, an angle or a gain is impossible, or the grid has holes.
    """
    rows = np.array(pattern, float).reshape(-1, 3)
    is_possible = np.isfinite(rows).all() and (np.abs(rows) <= (180.0, 90.0, 200.0)).all()
    if not len(rows) or not is_possible:
        raise ValueError("a pattern has azimuths within 180 and elevations within 90 degrees, and gains within 200 dB")
    azimuth, elevation = np.unique(rows[:, 0]), np.unique(rows[:, 1])
    if len(np.unique(rows[:, :2], axis=0)) < len(rows):
        raise ValueError("a direction stands twice in the pattern")
    loss = np.full((len(azimuth), len(elevation)), np.nan)
    at = np.searchsorted(azimuth, rows[:, 0]), np.searchsorted(elevation, rows[:, 1])
    ahead = rows[np.hypot(rows[:, 0], rows[:, 1]).argmin(), 2]
    loss[at] = ahead - rows[:, 2]
    if ((rows[:, 0] == 0) | (rows[:, 1] == 0)).all() and 0 in azimuth and 0 in elevation:  # two cuts
        loss = loss[:, [int(np.searchsorted(elevation, 0))]] + loss[[int(np.searchsorted(azimuth, 0))]]
    if np.isnan(loss).any():
        raise ValueError("the pattern has holes: give every elevation for every azimuth, or two cuts through 0, 0")
    return azimuth, elevation, loss
