"""The interface alone, on a field that is a plain formula."""

import numpy as np
from jaxtyping import Complex

from mmweaver.core.records import CubeGrid
from mmweaver.fields import field as field_module
from mmweaver.fields.field import SignalField
from mmweaver.fields.sampling import Coordinates
from tests.cubes import SMALL


class Formula(SignalField):
    def __init__(self):
        self.config, self.grid, self.scale = SMALL, CubeGrid.of(SMALL, 3), 1.0

    @property
    def num_values(self) -> int:
        return 0

    def sample(self, coordinates: Coordinates) -> Complex[np.ndarray, " point"]:
        frame, range_bin, doppler_bin, antenna = coordinates.T
        return (frame + 10 * range_bin + 1j * (doppler_bin - 100 * antenna)).astype(np.complex64)


def test_a_grid_equals_its_points(monkeypatch):
    monkeypatch.setattr(field_module, "CHUNK_POINTS", 1000)  # several chunks, one of them short
    values = Formula().on_grid(CubeGrid.of(SMALL, 3))
    frame, range_bin, doppler_bin, antenna = np.indices(values.shape)
    assert np.allclose(values, frame + 10 * range_bin + 1j * (doppler_bin - 100 * antenna), atol=1e-2)
    assert values.dtype == np.complex64


def test_a_cube_carries_grid_config_and_scale():
    field = Formula()
    finer = field.finer(n_r=2.0)
    assert finer.values.shape == finer.grid.shape == (3, 64, 16, 12)
    assert finer.config is SMALL
    assert np.allclose(finer.values[:, ::2], field.cube().values, atol=1e-2)
