"""Active and moving cells of a cube."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import RangeDopplerMap, RangeDopplerMask
from mmweaver.dsp.spectra import moving_doppler, range_doppler_power

ACTIVE_DB = 12.0  # above the noise floor


@dataclass(frozen=True, kw_only=True)
class Cells:
    """Masks (frame, range, doppler); a cell comprises all its antennas."""

    is_active: RangeDopplerMask  # power more than 12 dB above the noise floor
    is_moving: RangeDopplerMask  # active, outside zero Doppler and its two neighbours
    floor_power: float


def cells_of(cube: RadarCube) -> Cells:
    """The active and the moving cells of a cube.

    Power is the mean of |.|^2 over the antennas. The noise floor is its median over all cells, which is valid as long
    as most cells contain only noise.
    """
    power = range_doppler_power(cube)
    floor = noise_floor(power)
    is_active = power > floor * 10 ** (ACTIVE_DB / 10)
    return Cells(is_active=is_active, is_moving=is_active & moving_doppler(cube), floor_power=floor)


def noise_floor(power: RangeDopplerMap) -> float:
    """Median power over all cells."""
    return float(np.median(power))
