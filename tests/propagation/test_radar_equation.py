"""Mean echoes seen by a radar: the same radar equation and pattern as the simulator's."""

import numpy as np
import pytest
import torch

from mmweaver.core.boards import AWR1843
from mmweaver.propagation.antenna import pattern
from mmweaver.propagation.mean_power import MeanEchoes
from mmweaver.propagation.radar_equation import carrier, direction_loss_db, points_of
from mmweaver.signal.point_response import PointResponse


def test_the_pattern_is_the_simulators():
    rng = np.random.default_rng(1)
    direction = rng.standard_normal((200, 3)) + np.array([0, 2.5, 0])
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction = direction[direction[:, 1] > 0.1]
    loss = direction_loss_db(torch.tensor(direction[:, [0, 2]]), AWR1843).numpy()
    assert np.allclose(10 ** (-loss / 20), pattern(direction, AWR1843), rtol=1e-4)


def test_amplitudes_follow_the_radar_equation():
    echoes = MeanEchoes(
        range_m=torch.tensor([1.0, 2.0]), velocity_mps=torch.tensor([0.0, 1.0]), direction=torch.zeros(2, 2),
        cross_section_m2=torch.tensor([1.0, 4.0]),
    )  # fmt: skip
    response = PointResponse(AWR1843)
    points = points_of(echoes, response)
    # 12 dBm + 2 x 10.5 dBi + 20 log10(3.792 mm) - 30 log10(4 pi): 1 m2 at 1 m; four times that at twice the range
    assert 20 * np.log10(points.amplitude.numpy()) == pytest.approx([-48.40, -48.40 - 6.02], abs=0.01)
    assert np.isclose(float(points.doppler_bin[1]) * response.velocity_a_bin_mps, 1.0)


def test_the_carrier_turns_once_each_half_wavelength():
    range_m = torch.tensor([1.0, 1.0 + AWR1843.wavelength_m / 8], dtype=torch.float64)
    turned = carrier(range_m, AWR1843)
    assert np.allclose(np.angle((turned[1] / turned[0]).numpy()), np.pi / 2, atol=1e-3)
