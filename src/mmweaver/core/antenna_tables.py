"""Antenna positions of a radar board, from a table (`presets.ANTENNAS` lists known boards) or from a virtual array."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError

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


def antenna_table(name: str, values: Any, source: str = "") -> AntennaTable:
    """Builds a table from the lists `tx`, `rx` and `rx_inverted` of a file.

    Args:
        name: Name of the table.
        values: Mapping with `tx` and `rx`, lists of (x, z) in half wavelengths, and optionally `rx_inverted`,
            `source` and `platforms`.
        source: Origin of the positions. Default: the entry `source` of `values`.

    Returns:
        The table.

    Raises:
        ValueError, KeyError, TypeError: If the lists are missing or malformed.
    """
    tx, rx = (tuple((float(x), float(z)) for x, z in values[key]) for key in ("tx", "rx"))
    inverted = tuple(int(one) for one in values.get("rx_inverted", []))
    return AntennaTable(
        name=name,
        tx_halfwaves=tx,
        rx_halfwaves=rx,
        rx_inverted=inverted,
        source=source or values.get("source", ""),
        platforms=tuple(values.get("platforms", [])),
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
