"""Antennas of the board of a TI .cfg: from its antenna lines, else from the platform named in its comments.

A platform is often just xWR68xx, which exists with four antenna layouts; channel phases (compRangeBiasAndRxChanPhase)
that invert the receivers of an AOP or ODS then identify it. Reference: TI, 3D People Tracking tuning guide
(antGeometry0, antGeometry1, antPhaseRot); mmWave MCU+ SDK (antGeometryCfg); header comments of TI's mmWave Demo
Visualizer.
"""

import numpy as np

from mmweaver.core.antenna_tables import AntennaTable, table_of_virtual_array
from mmweaver.core.errors import InputError
from mmweaver.core.presets import ANTENNAS

NUM_RX = 4
TURNED = tuple(ANTENNAS[board] for board in ("aop", "ods"))  # boards with inverted receivers


def antennas_of_cfg(values: dict[str, tuple[float, ...]], platform: str) -> AntennaTable | None:
    """Determines the antennas of a .cfg.

    Args:
        values: Numbers of each command.
        platform: Platform named in the comments, lower-case letters and digits only.

    Returns:
        Antenna table; None if the file does not identify it.

    Raises:
        InputError: If the antenna lines do not describe a board.
    """
    if "antGeometry0" in values and "antGeometry1" in values:
        column, row = np.array(values["antGeometry0"]), np.array(values["antGeometry1"])
        if len(column) != len(row):
            raise InputError("antGeometry0 and antGeometry1 differ in length")
        turned = values.get("antPhaseRot", (1.0,) * len(row))
        inverted = tuple(rx for rx, sign in enumerate(turned[:NUM_RX]) if sign < 0)
        if len(turned) >= NUM_RX and turned[0] < 0:  # a common sign is irrelevant
            inverted = tuple(rx for rx in range(NUM_RX) if rx not in inverted)
        places = np.stack([-column, row], axis=1)
        return table_of_virtual_array("antGeometry", places, NUM_RX, inverted, "antGeometry0/1 of the .cfg")
    if "antGeometryCfg" in values:
        numbers = values["antGeometryCfg"]
        if len(numbers) % 2:
            raise InputError("antGeometryCfg holds an odd number of numbers; it takes pairs and two distances")
        pairs, (across, up) = np.array(numbers[:-2]).reshape(-1, 2), numbers[-2:]
        places = np.stack([2 * across * pairs[:, 1], -2 * up * pairs[:, 0]], axis=1)
        return table_of_virtual_array("antGeometryCfg", places, NUM_RX, source="antGeometryCfg of the .cfg")
    if platform in ("", "xwr68xx", "xwr64xx") and (
        turned := _turned_receivers(values.get("compRangeBiasAndRxChanPhase", ()))
    ):
        return next((board for board in TURNED if board.rx_inverted == turned), None)
    named = [(len(part), name) for name in ANTENNAS for part in ANTENNAS[name].platforms if part in platform]
    return ANTENNAS[max(named)[1]] if named else None


def _turned_receivers(compensation: tuple[float, ...]) -> tuple[int, ...]:
    """Receivers inverted by the channel phases, equal for all transmitters; () for any other phases."""
    factors = np.array(compensation[1:])
    if not factors.size or factors.size % (2 * NUM_RX):
        return ()
    each = factors.reshape(-1, NUM_RX, 2)
    if not (np.abs(each[..., 0]) == 1).all() or each[..., 1].any() or (each != each[0]).any():
        return ()
    return tuple(int(rx) for rx in np.flatnonzero(each[0, :, 0] < 0))
