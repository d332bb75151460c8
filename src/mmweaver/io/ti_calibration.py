"""compRangeBiasAndRxChanPhase of a TI .cfg: range bias in m, then real and imaginary part per antenna pair.

Pairs are those of the board, transmitter by transmitter; recorded samples are multiplied by the factor of their pair,
and the bias is subtracted from the range. On boards with inverted receivers the factors also undo the inversion (TI's
visualizer writes 1 0 -1 0 for the AOP), unless antPhaseRot does. Reference: mmWave SDK User Guide,
"compRangeBiasAndRxChanPhase".
"""

import numpy as np

from mmweaver.core.board import ChannelCalibration
from mmweaver.core.errors import InputError
from mmweaver.io.radar_options import split_radar
from mmweaver.io.ti_cfg import cfg_path, setup_of_lines, ti_cfg_lines
from mmweaver.io.ti_chirps import MAX_TX

COMMAND, TURNS = "compRangeBiasAndRxChanPhase", "antPhaseRot"
NUM_RX = 4


def read_ti_calibration(name_or_path: str) -> ChannelCalibration | None:
    """Reads the channel calibration of a .cfg.

    Args:
        name_or_path: Path of a .cfg, with options as in `load_radar`, or any other radar.

    Returns:
        Calibration of the transmitters that fire; None if it is not a .cfg, or has no effect.

    Raises:
        InputError: If the line is too short for the transmitters that fire, or contains a zero factor.
    """
    path = cfg_path(name_or_path)
    lines = {} if path is None else ti_cfg_lines(path, {COMMAND: 3})
    if COMMAND not in lines:
        return None
    line, setup = lines[COMMAND][-1], setup_of_lines("", lines)
    bias_m, numbers = line.values[0], np.array(line.values[1:])
    pairs = numbers[: len(numbers) // 2 * 2].reshape(-1, 2) @ np.array([1, 1j])
    chirps, _ = setup.loop(setup.chosen_frame(split_radar(name_or_path)[1].sub_frame))
    fired = [tx for tx in range(MAX_TX) if any(chirp.tx_mask >> tx & 1 for chirp in chirps)]
    receivers = [rx for rx in range(NUM_RX) if setup.rx_mask >> rx & 1]
    needed = NUM_RX * (max(fired) + 1)
    if len(pairs) < needed:
        raise InputError(
            f"{path}, line {line.number}: {COMMAND} has {len(pairs)} antenna pairs; transmitter {max(fired)} needs"
            f" {needed}"
        )
    factors = pairs[:needed].reshape(-1, NUM_RX)[np.ix_(fired, receivers)]
    if not np.abs(factors).all():
        raise InputError(f"{path}, line {line.number}: {COMMAND} has a factor of zero; leave the line out")
    is_one = np.allclose(factors, 1)
    if bias_m == 0 and is_one:
        return None
    return ChannelCalibration(factors=factors, range_bias_m=bias_m, turns_receivers=not (is_one or TURNS in lines))
