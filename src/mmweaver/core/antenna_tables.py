"""The antennas of radar boards, as published, and of a table of one's own.

Places are (x, z) in half wavelengths, x to the right and z up as seen from behind the board. Vendors count the columns
of their virtual arrays the other way, so x here is their column with the opposite sign.
"""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.registry import Registry

Places = tuple[tuple[float, float], ...]
FOUR_IN_A_ROW: Places = ((-6.0, 0.0), (-5.0, 0.0), (-4.0, 0.0), (-3.0, 0.0))


@dataclass(frozen=True, kw_only=True)
class AntennaTable:
    """Transmitters and receivers of a board, in the order of their numbers."""

    name: str
    tx_halfwaves: Places
    rx_halfwaves: Places
    rx_inverted: tuple[int, ...] = ()  # fed from the other side: their phase is turned by 180 degrees
    source: str = ""


# xWR1443BOOST, xWR1843BOOST, IWR6843ISK, AWR2243BOOST: a row of eight, and the second transmitter half a wavelength up.
ISK = AntennaTable(
    name="isk", tx_halfwaves=((0.0, 0.0), (2.0, 1.0), (4.0, 0.0)), rx_halfwaves=FOUR_IN_A_ROW,
    source="antGeometry0/1 of TI's 3D People Tracking, ISK_6m_default.cfg; TI SPRUIM4",
)  # fmt: skip
BOOST = AntennaTable(
    name="boost", tx_halfwaves=ISK.tx_halfwaves, rx_halfwaves=ISK.rx_halfwaves, source="TI SWRU546, SPRUIM4"
)
BOOST_1642 = AntennaTable(
    name="boost1642", tx_halfwaves=((0.0, 0.0), (4.0, 0.0)), rx_halfwaves=FOUR_IN_A_ROW, source="TI SWRU508"
)
AOP = AntennaTable(
    name="aop", tx_halfwaves=((0.0, 0.0), (2.0, -2.0), (0.0, -2.0)),
    rx_halfwaves=((1.0, -1.0), (1.0, 0.0), (0.0, -1.0), (0.0, 0.0)), rx_inverted=(1, 3),
    source="antGeometry0/1, antPhaseRot of TI's 3D People Tracking, AOP_6m_default.cfg",
)  # fmt: skip
ODS = AntennaTable(
    name="ods", tx_halfwaves=((0.0, 0.0), (2.0, 0.0), (2.0, -2.0)),
    rx_halfwaves=((0.0, 0.0), (0.0, -1.0), (1.0, -1.0), (1.0, 0.0)), rx_inverted=(1, 2),
    source="antGeometry0/1, antPhaseRot of TI's 3D People Tracking, ODS_6m_default.cfg",
)  # fmt: skip
# Rows 0.8 wavelengths apart; a row of twelve.
EVM_2944 = AntennaTable(
    name="evm2944", tx_halfwaves=((0.0, 0.0), (2.0, 1.6), (4.0, 0.0), (8.0, 0.0)), rx_halfwaves=FOUR_IN_A_ROW,
    source="antGeometryCfg of TI's mmWave MCU+ SDK demo for the AWR2944EVM",
)  # fmt: skip

ANTENNAS: Registry[AntennaTable] = Registry(
    "antenna table", [(table.name, table) for table in (ISK, BOOST, BOOST_1642, AOP, ODS, EVM_2944)]
)


def table_of_virtual_array(
    name: str, places: np.ndarray, num_rx: int, inverted: tuple[int, ...] = (), source: str = ""
) -> AntennaTable:
    """The table whose virtual antennas lie at places (tx * num_rx + rx, 2), the first transmitter at 0.

    Raises InputError where no transmitters and receivers give such an array.
    """
    if len(places) % num_rx:
        raise InputError(f"{len(places)} virtual antennas are no whole number of {num_rx} receivers")
    each = np.asarray(places, float).reshape(-1, num_rx, 2)
    tx, rx = each[:, 0] - each[0, 0], each[0]
    if not np.allclose(each, tx[:, None] + rx[None], atol=1e-6):
        raise InputError("these virtual antennas are not those of transmitters times receivers")

    def plain(rows: np.ndarray) -> Places:
        return tuple((float(x) + 0.0, float(z) + 0.0) for x, z in rows)

    return AntennaTable(
        name=name, tx_halfwaves=plain(tx), rx_halfwaves=plain(rx), rx_inverted=inverted, source=source
    )  # fmt: skip
