import numpy as np
import pytest

from mmweaver.compression.transforms import beams_of, from_coefficients, to_coefficients
from mmweaver.core.presets import AWR1843, BGT60, IWR6843
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.seeding import stream


@pytest.mark.parametrize("config", [AWR1843, BGT60, IWR6843], ids=lambda config: config.name)
def test_beams_are_unitary_and_coefficients_round_trip(config: RadarConfig):
    beams = beams_of(config)
    assert np.allclose(beams @ beams.conj().T, np.eye(config.num_antennas))
    parts = stream(0, "residual").normal(size=(2, 3, 5, 7, config.num_antennas))
    residual = parts[0] + 1j * parts[1]
    values = to_coefficients(residual, beams)
    assert values.shape == (config.num_antennas, 3, 5, 7)
    assert np.sum(np.abs(values) ** 2) == pytest.approx(np.sum(np.abs(residual) ** 2))
    assert np.allclose(from_coefficients(values, beams), residual)


def test_static_clutter_ahead_is_one_beam_per_row_and_one_coefficient():
    residual = np.zeros((4, 1, 5, 12), complex)
    residual[:, 0, 2, :] = 1.0
    values = np.abs(to_coefficients(residual, beams_of(AWR1843)))
    assert np.count_nonzero(values > 1e-9) == 2  # two rows
