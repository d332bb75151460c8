import numpy as np
import pytest

from mmweaver.compression.quantised_cells import beams_of
from mmweaver.core.boards import AWR1843, BGT60
from mmweaver.core.radar_config import RadarConfig


@pytest.mark.parametrize("config", [AWR1843, BGT60], ids=lambda config: config.name)
def test_beams_are_unitary(config: RadarConfig):
    beams = beams_of(config)
    assert np.allclose(beams @ beams.conj().T, np.eye(config.num_antennas))


def test_a_far_wall_ahead_fills_one_beam_per_row():
    heard = beams_of(AWR1843) @ np.ones(12)
    assert np.count_nonzero(np.abs(heard) > 1e-9) == 2
