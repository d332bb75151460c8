"""Where the antennas of a radar board are: of a table (`presets.ANTENNAS` has known boards), or of a virtual array."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError

Places = tuple[tuple[float, float], ...]


@dataclass(frozen=True, kw_only=True)
class AntennaTable:
    """Transmitters and receivers of a board, in the order of their numbers, at (x, z) in half wavelengths.

    x to the right and z up as seen from behind the board.
    """

    name: str
    tx_halfwaves: Places
    rx_halfwaves: Places
    rx_inverted: tuple[int, ...] = ()  # fed from the other side: their phase is turned by 180 degrees
    source: str = ""
    platforms: tuple[str, ...] = ()  # parts of the names that TI's files have for it


def antenna_table(name: str, values: Any, source: str = "") -> AntennaTable:
    """A table of the lists `tx`, `rx` and `rx_inverted` of a file. Raises ValueError, KeyError or TypeError."""
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
    """The table of a virtual array.

    Args:
        name: Name of the table.
        places: Virtual antennas (tx * num_rx + rx, 2) in half wavelengths; the first transmitter is put at 0.
        num_rx: Number of receivers.
        inverted: Receivers that are fed from the other side.
        source: Where the places come from.

    Returns:
        Transmitters and receivers.

    Raises:
        InputError: where no transmitters and receivers give such an array.
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
