"""RF-Genesis: repaired it sees a walking person where they are; as released, near, but at another velocity."""

from dataclasses import replace

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.signal.spectra import range_doppler_power
from tests.rooms import standing_person

pytest.importorskip("mitsuba")
WALKER = standing_person((0.3, 2.4, -1.2), (0.0, -1.1, 0.0), seconds=0.6)
SMALL = replace(AWR1843, num_loops=16)


def strongest(**settings: bool) -> tuple[float, float]:
    """Range and radial velocity of the strongest cell of the first frame."""
    from studies.peers.rf_genesis import RfGenesis

    cube = RfGenesis(has_environment=False, pixels=48, **settings).cube(WALKER, SMALL, 1)
    near, speed = np.unravel_index(range_doppler_power(cube)[0].argmax(), cube.values.shape[1:3])
    return float(cube.grid.range_m[near]), float(cube.grid.radial_velocity_mps[speed])


def test_repaired_it_sees_the_person():
    range_m, velocity_mps = strongest(repaired=True)
    assert abs(range_m - 2.3) < 0.15
    assert velocity_mps == pytest.approx(-1.1, abs=2 * SMALL.velocity_resolution_mps)


def test_as_released_chirps_fill_the_frame_and_velocities_alias():
    range_m, velocity_mps = strongest()
    assert abs(range_m - 2.3) < 0.3
    assert abs(velocity_mps + 1.1) > 2 * SMALL.velocity_resolution_mps
