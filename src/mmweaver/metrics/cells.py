"""Which cells of a cube carry signal, and which of them move."""

from dataclasses import dataclass

import numpy as np

from mmweaver.core.records import RadarCube
from mmweaver.core.shapes import RangeDopplerMap, RangeDopplerMask
from mmweaver.dsp.spectra import moving_doppler, range_doppler_power

ACTIVE_DB = 12.0  # above the noise floor


@dataclass(frozen=True, kw_only=True)
class Cells:
    """Masks over (frame, range, doppler); a cell is counted with all its antennas."""

    is_active: RangeDopplerMask  # power more than 12 dB above the noise floor
    is_moving: RangeDopplerMask  # active, and not in zero Doppler or its two neighbours
    floor_power: float


def cells_of(cube: RadarCube) -> Cells:
    """The active and the moving cells of a cube.

    Power is the mean of |.|^2 over the antennas; the noise floor is its median over all cells, which noise fills in
    any radar cube with most of its cells empty.
    """
    power = range_doppler_power(cube)
    floor = noise_floor(power)
    is_active = power > floor * 10 ** (ACTIVE_DB / 10)
    return Cells(is_active=is_active, is_moving=is_active & moving_doppler(cube), floor_power=floor)


def noise_floor(power: RangeDopplerMap) -> float:
    """Median power of all cells."""
    return float(np.median(power))
