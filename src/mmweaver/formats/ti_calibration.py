"""compRangeBiasAndRxChanPhase of a TI .cfg: range bias in m, then real and imaginary part of each antenna pair.

Pairs are those of the board, transmitter by transmitter; a recorded sample is multiplied by its pair's factor and the
bias subtracted from its range. Where receivers are fed from the other side the factors undo that, too (TI's visualizer
writes 1 0 -1 0 for the AOP), unless an antPhaseRot does. Reference: mmWave SDK User Guide,
"compRangeBiasAndRxChanPhase".
"""

from pathlib import Path

import numpy as np

from mmweaver.core.channel_calibration import ChannelCalibration
from mmweaver.core.errors import InputError
from mmweaver.formats.radar_options import split_radar
from mmweaver.formats.ti_cfg import fired_transmitters, ti_cfg_lines, whole

COMMAND, TURNS = "compRangeBiasAndRxChanPhase", "antPhaseRot"
NUM_RX = 4


def read_ti_calibration(name_or_path: str) -> ChannelCalibration | None:
    """What a .cfg (options may follow its name) compensates; None where it is no .cfg, or compensates nothing.

    Raises InputError where the line is too short for the transmitters that fire.
    """
    name, options = split_radar(name_or_path)
    path = Path(name)
    if path.suffix.lower() != ".cfg" or not path.is_file():
        return None
    lines = ti_cfg_lines(path, {COMMAND: 3, TURNS: 1})
    if COMMAND not in lines:
        return None
    line = lines[COMMAND][-1]
    bias_m, numbers = line.values[0], np.array(line.values[1:])
    pairs = numbers[: len(numbers) // 2 * 2].reshape(-1, 2) @ np.array([1, 1j])
    fired = fired_transmitters(lines, options.sub_frame)
    receivers = [rx for rx in range(NUM_RX) if whole(lines["channelCfg"][-1], "channelCfg", 0) >> rx & 1]
    if len(pairs) < NUM_RX * (max(fired) + 1):
        raise InputError(
            f"{path}, line {line.number}: {COMMAND} has {len(pairs)} antenna pairs; transmitter {max(fired)} needs"
            f" {NUM_RX * (max(fired) + 1)}"
        )
    factors = pairs[: NUM_RX * (max(fired) + 1)].reshape(-1, NUM_RX)[np.ix_(fired, receivers)]
    if not np.abs(factors).all():
        raise InputError(f"{path}, line {line.number}: {COMMAND} has a factor of zero; leave the line out")
    if bias_m == 0 and np.allclose(factors, 1):
        return None
    return ChannelCalibration(
        factors=factors, range_bias_m=bias_m, turns_receivers=not (np.allclose(factors, 1) or TURNS in lines)
    )
