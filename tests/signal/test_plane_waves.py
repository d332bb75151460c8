"""A plane wave is all of itself; random phases are not."""

import numpy as np
import pytest

from mmweaver.core.boards import AWR1843
from mmweaver.core.seeding import stream
from mmweaver.signal.plane_waves import best_wave_share, plane_waves


def test_share_of_the_best_wave():
    waves = plane_waves(AWR1843)
    phases = stream(0, "test").uniform(0, 2 * np.pi, (50, 12))
    assert best_wave_share(3 * waves[:, [100, 500]].T, waves) == pytest.approx(1)
    assert best_wave_share(np.exp(1j * phases), waves).mean() < 0.6
    assert best_wave_share(np.zeros((1, 12), complex), waves).tolist() == [0]
