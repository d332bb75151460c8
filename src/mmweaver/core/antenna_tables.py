"""Antennas of a radar board: positions, gain and pattern, from a table (`presets.ANTENNAS` lists known boards) or from a virtual array."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.safe_files.regular_files import MEGABYTE
from mmweaver.core.safe_files.safe_text import read_text

Places = tuple[tuple[float, float], ...]
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


@dataclass(frozen=True, kw_only=True)
class AntennaTable:
    """Transmitters and receivers of a board by number, at (x, z) in half wavelengths.

    x points right and z up, seen from behind the board.
    """

    name: str
    tx_halfwaves: Places
    rx_halfwaves: Places
    rx_inverted: tuple[int, ...] = ()  # receivers fed from the opposite side: 180 degrees phase shift
    source: str = ""
    platforms: tuple[str, ...] = ()  # substrings by which TI's files name the board
    electrical: tuple[tuple[str, Any], ...] = ()  # fields of RadarConfig by name


def antenna_table(name: str, values: Any, source: str = "") -> AntennaTable:
    """Builds a table from the lists `tx`, `rx` and `rx_inverted` of a file.

    Args:
        name: Name of the table.
        values: Mapping with `tx` and `rx`, lists of (x, z) in half wavelengths, and optionally `rx_inverted`,
            `source`, `platforms`, fields of ELECTRICAL, and instead of a pattern `cosine_power`, the exponents of
            the power pattern in azimuth and elevation.
        source: Origin of the positions. Default: the entry `source` of `values`.

    Returns:
        The table.

    Raises:
        ValueError, KeyError, TypeError: If the lists are missing or malformed.
    """
    tx, rx = (tuple((float(x), float(z)) for x, z in values[key]) for key in ("tx", "rx"))
    electrical = {key: values[key] for key in ELECTRICAL if key in values}
    if "cosine_power" in values:
        electrical |= cosine_pattern(*map(float, values["cosine_power"]))
    if "antenna_pattern" in values:
        rows = values["antenna_pattern"]
        electrical["antenna_pattern"] = tuple((float(az), float(el), float(db)) for az, el, db in rows)
    inverted = tuple(int(one) for one in values.get("rx_inverted", []))
    return AntennaTable(
        name=name,
        tx_halfwaves=tx,
        rx_halfwaves=rx,
        rx_inverted=inverted,
        source=source or values.get("source", ""),
        platforms=tuple(values.get("platforms", [])),
        electrical=tuple(electrical.items()),
    )


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


def table_of_virtual_array(
    name: str, places: np.ndarray, num_rx: int, inverted: tuple[int, ...] = (), source: str = ""
) -> AntennaTable:
    """Factors a virtual array into transmitters and receivers.

    Args:
        name: Name of the table.
        places: Virtual antennas (tx * num_rx + rx, 2) in half wavelengths; the first transmitter is placed at 0.
        num_rx: Number of receivers.
        inverted: Receivers with a 180 degree phase shift.
        source: Origin of the positions.

    Returns:
        Table of transmitters and receivers.

    Raises:
        InputError: If the array is not the sum of transmitter and receiver positions.
    """
    if len(places) % num_rx:
        raise InputError(f"{len(places)} virtual antennas are no whole number of {num_rx} receivers")
    each = np.asarray(places, float).reshape(-1, num_rx, 2)
    tx, rx = each[:, 0] - each[0, 0], each[0]
    if not np.allclose(each, tx[:, None] + rx[None], atol=1e-6):
        raise InputError("these virtual antennas are not those of transmitters times receivers")

    def plain(rows: np.ndarray) -> Places:
        return tuple((float(x) + 0.0, float(z) + 0.0) for x, z in rows)

    return AntennaTable(name=name, tx_halfwaves=plain(tx), rx_halfwaves=plain(rx), rx_inverted=inverted, source=source)
