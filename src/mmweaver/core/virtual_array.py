"""Selection of virtual antennas for azimuth and elevation.

Antenna positions of a radar board, from a table (`presets.ANTENNAS` lists known boards) or from a virtual array.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.core.antenna_pattern import ELECTRICAL, cosine_pattern
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.shapes import AntennaPositions, PerIndex

Places = tuple[tuple[float, float], ...]


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


# Antennas closer than this share of a wavelength count as one position.
SAME_PLACE_WAVELENGTHS = 0.05


@dataclass(frozen=True, kw_only=True)
class RowPair:
    """Antennas of two horizontal rows, paired by column."""

    lower: PerIndex
    upper: PerIndex
    spacing_m: float  # vertical spacing


def azimuth_row(position_m: AntennaPositions, wavelength_m: float) -> PerIndex:
    """Selects the row of antennas that measures azimuth.

    Args:
        position_m: Virtual antennas in metres, (antenna, 3).
        wavelength_m: Wavelength in metres.

    Returns:
        Indices from left to right of the horizontal row with the largest aperture; the lowest one in a tie.

    >>> from mmweaver.core.boards import AWR1843
    >>> azimuth_row(AWR1843.antenna_position_m, AWR1843.wavelength_m).tolist()
    [0, 1, 2, 3, 8, 9, 10, 11]
    """
    widest = max(_rows(position_m, wavelength_m), key=lambda row: float(np.ptp(position_m[row, 0])))
    return widest


def elevation_rows(position_m: AntennaPositions, wavelength_m: float) -> RowPair | None:
    """Selects the two rows of antennas whose phase difference measures elevation.

    Args:
        position_m: Virtual antennas in metres, (antenna, 3).
        wavelength_m: Wavelength in metres.

    Returns:
        The rows with the most common columns (the closest in a tie); None if no column has two antennas.
    """
    rows = _rows(position_m, wavelength_m)
    pairs = [_pair(position_m, wavelength_m, low, high) for at, low in enumerate(rows) for high in rows[at + 1 :]]
    found = [pair for pair in pairs if pair is not None]
    return max(found, key=lambda pair: (len(pair.lower), -pair.spacing_m)) if found else None


def elevation_columns(position_m: AntennaPositions, wavelength_m: float) -> list[PerIndex]:
    """Selects the columns of antennas that resolve elevation.

    Args:
        position_m: Virtual antennas in metres, (antenna, 3).
        wavelength_m: Wavelength in metres.

    Returns:
        Indices from bottom to top of each of the tallest columns; empty if no two antennas share a column.

    >>> from mmweaver.core.boards import AWR1843
    >>> [column.tolist() for column in elevation_columns(AWR1843.antenna_position_m, AWR1843.wavelength_m)]
    [[2, 4], [3, 5], [8, 6], [9, 7]]
    """
    same_m = SAME_PLACE_WAVELENGTHS * wavelength_m
    order = np.lexsort((position_m[:, 2], np.round(position_m[:, 0] / same_m)))
    across_m = position_m[order, 0]
    columns = []
    for column in np.split(order, np.flatnonzero(np.diff(across_m) > same_m) + 1):
        apart = np.concatenate([[True], np.diff(position_m[column, 2]) > same_m])  # coincident antennas count once
        columns.append(column[apart])
    tallest_m = max(float(np.ptp(position_m[column, 2])) for column in columns)
    if tallest_m < same_m:
        return []
    return [column for column in columns if np.ptp(position_m[column, 2]) > tallest_m - same_m]


def has_elevation(config: RadarConfig) -> bool:
    """Whether the array measures the elevation of a single target, by the phase difference of two rows."""
    return elevation_rows(config.antenna_position_m, config.wavelength_m) is not None


def resolves_elevation(config: RadarConfig) -> bool:
    """Whether an elevation spectrum is meaningful for the array.

    Args:
        config: The radar.

    Returns:
        True if a column of three or more antennas spans at least a wavelength, a beam of about 35 degrees.
    """
    columns = elevation_columns(config.antenna_position_m, config.wavelength_m)
    place_m = config.antenna_position_m
    near_m = (1.0 - SAME_PLACE_WAVELENGTHS) * config.wavelength_m
    return any(len(column) > 2 and np.ptp(place_m[column, 2]) >= near_m for column in columns)


def azimuth_resolution_rad(config: RadarConfig) -> float:
    """Beamwidth of the azimuth row at broadside.

    Args:
        config: The radar.

    Returns:
        Wavelength / (aperture + one spacing) in radians; nan for a single column.
    """
    position_m = config.antenna_position_m
    x_m = position_m[azimuth_row(position_m, config.wavelength_m), 0]
    columns = len(np.unique(np.round(x_m / (SAME_PLACE_WAVELENGTHS * config.wavelength_m))))
    if columns < 2:
        return float("nan")
    return float(config.wavelength_m / (np.ptp(x_m) * columns / (columns - 1)))


def _rows(position_m: AntennaPositions, wavelength_m: float) -> list[PerIndex]:
    """Antennas of equal height, lowest row first, each from left to right."""
    same_m = SAME_PLACE_WAVELENGTHS * wavelength_m
    order = np.lexsort((position_m[:, 0], np.round(position_m[:, 2] / same_m)))
    height_m = position_m[order, 2]
    return np.split(order, np.flatnonzero(np.diff(height_m) > same_m) + 1)


def _pair(position_m: AntennaPositions, wavelength_m: float, low: np.ndarray, high: np.ndarray) -> RowPair | None:
    same_m = SAME_PLACE_WAVELENGTHS * wavelength_m
    near = np.abs(position_m[low, 0][:, None] - position_m[high, 0][None, :]) < same_m
    columns = [(int(low[at]), int(high[np.argmax(line)])) for at, line in enumerate(near) if line.any()]
    if not columns:
        return None
    lower, upper = (np.array(side) for side in zip(*columns, strict=True))
    return RowPair(lower=lower, upper=upper, spacing_m=float(np.mean(position_m[upper, 2] - position_m[lower, 2])))
