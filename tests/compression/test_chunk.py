import numpy as np
import pytest
import torch

from mmweaver.compression.chunk import ChunkEncoder, decode_chunk
from mmweaver.core.errors import InputError
from mmweaver.fields.scatterers.fit_window import FitWindow
from mmweaver.fields.scatterers.fitting import FitRecipe, fitted
from tests.fields.echoes import SMALL, crowd, error_db
from tests.fields.scatterers.test_fit_window import overlapping


def encoder_of(cube, hop: int, recipe: FitRecipe) -> ChunkEncoder:
    peak = float(np.abs(cube.values).max())
    fit_window = FitWindow.of(cube.config, len(cube.values), hop)
    target = fit_window.working(cube.values / np.float32(peak))
    return ChunkEncoder(target, fit_window, fitted(target, fit_window, recipe), peak)


@pytest.fixture(scope="module")
def encoder() -> ChunkEncoder:
    return encoder_of(crowd(), 0, FitRecipe(num_points=60, stages=6))


def test_a_finer_step_costs_more_and_has_less_error(encoder: ChunkEncoder):
    truth = crowd().values
    sizes, errors = [], []
    for step in (0.1, 0.02, 0.004, 8e-4):
        data = encoder.encode(step)
        sizes.append(len(data))
        errors.append(error_db(decode_chunk(data, SMALL).cube_values(), truth))
    assert sizes == sorted(sizes)
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < -45
    # a cell of a cube that is coded throughout errs by step / sqrt(12)
    error = np.sqrt(np.mean(np.abs(decode_chunk(data, SMALL).cube_values() - truth) ** 2))
    assert error < 8e-4 * np.abs(truth).max()


def test_without_the_residual_the_layers_are_the_same(encoder: ChunkEncoder):
    data = encoder.encode(0.01)
    whole, part = decode_chunk(data, SMALL), decode_chunk(data, SMALL, with_residual=False)
    assert part.residual is None
    assert torch.equal(whole.layers.points.amplitude, part.layers.points.amplitude)
    assert error_db(part.cube_values(), crowd().values) > error_db(whole.cube_values(), crowd().values)


def test_overlapping_windows():
    cube = overlapping()
    chunk = encoder_of(cube, 3, FitRecipe(num_points=20, stages=2))
    data = chunk.encode(0.05)
    again = decode_chunk(data, SMALL)
    assert again.fit_window.hop == 3
    assert error_db(again.cube_values(), cube.values) < -12
    # noise once for each chirp, not once for each window: 31 loops instead of 96
    assert len(data) < 0.7 * 2 * cube.values.size


def test_noise_power_and_gains_survive(encoder: ChunkEncoder):
    again = decode_chunk(encoder.encode(0.01), SMALL)
    assert 10 * np.log10(again.layers.noise_power / encoder.layers.noise_power) == pytest.approx(0.0, abs=0.3)
    assert torch.equal(again.layers.calibration, encoder.layers.calibration)


@pytest.mark.parametrize("data", [b"", b"\0" * 16, b"\xff" * 400])
def test_malformed_chunks_are_refused(data: bytes):
    with pytest.raises(InputError, match=r"is malformed"):
        decode_chunk(data, SMALL)
