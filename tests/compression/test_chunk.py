import numpy as np
import pytest
import torch

from mmweaver.compression.chunk import ChunkEncoder, decoded
from mmweaver.core.errors import InputError
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted
from tests.fields.echoes import SMALL, crowd, error_db
from tests.fields.scatterers.test_fit_window import overlapping


def encoder_of(cube, hop: int, recipe: FitRecipe) -> ChunkEncoder:
    peak = float(np.abs(cube.values).max())
    stretch = FitWindow.of(cube.config, len(cube.values), hop)
    target = stretch.working(cube.values / np.float32(peak))
    return ChunkEncoder(target, stretch, fitted(target, stretch, recipe), peak)


@pytest.fixture(scope="module")
def encoder() -> ChunkEncoder:
    return encoder_of(crowd(), 0, FitRecipe(num_points=60, stages=6))


def test_a_finer_step_costs_more_and_errs_less(encoder: ChunkEncoder):
    truth = crowd().values
    sizes, errors = [], []
    for step in (0.1, 0.02, 0.004, 8e-4):
        data = encoder.encoded(step)
        sizes.append(len(data))
        errors.append(error_db(decoded(data, SMALL).cube_values(), truth))
    assert sizes == sorted(sizes)
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < -45
    # a cell of a cube that is coded throughout errs by step / sqrt(12)
    error = np.sqrt(np.mean(np.abs(decoded(data, SMALL).cube_values() - truth) ** 2))
    assert error < 8e-4 * np.abs(truth).max()


def test_without_the_residual_the_layers_are_the_same(encoder: ChunkEncoder):
    data = encoder.encoded(0.01)
    whole, part = decoded(data, SMALL), decoded(data, SMALL, with_residual=False)
    assert part.residual is None
    assert torch.equal(whole.layers.points.amplitude, part.layers.points.amplitude)
    assert error_db(part.cube_values(), crowd().values) > error_db(whole.cube_values(), crowd().values)


def test_overlapping_windows():
    cube = overlapping()
    chunk = encoder_of(cube, 3, FitRecipe(num_points=20, stages=2))
    data = chunk.encoded(0.05)
    again = decoded(data, SMALL)
    assert again.stretch.hop == 3
    assert error_db(again.cube_values(), cube.values) < -12
    # noise once for each chirp, not once for each window: 31 loops instead of 96
    assert len(data) < 0.7 * 2 * cube.values.size


def test_noise_power_and_gains_survive(encoder: ChunkEncoder):
    again = decoded(encoder.encoded(0.01), SMALL)
    assert 10 * np.log10(again.layers.noise_power / encoder.layers.noise_power) == pytest.approx(0.0, abs=0.3)
    assert torch.equal(again.layers.calibration, encoder.layers.calibration)


@pytest.mark.parametrize("data", [b"", b"\0" * 16, b"\xff" * 400])
def test_nonsense_is_an_input_error(data: bytes):
    with pytest.raises(InputError, match=r"makes no sense"):
        decoded(data, SMALL)
