from dataclasses import replace

import numpy as np
import pytest

from mmweaver.compression.chunk import decode_chunk
from mmweaver.compression.mmw_codec import compress_cube, values_of_bytes
from mmweaver.compression.optimiser import Optimiser, error_db
from mmweaver.compression.quantised_cells import active_mask
from mmweaver.core.errors import InputError
from mmweaver.core.records import CubeGrid, RadarCube
from mmweaver.core.seeding import stream
from tests.compression.echoes import SMALL, crowd


def optimiser_of(cube: RadarCube) -> Optimiser:
    optimiser = Optimiser(cube)
    optimiser.divide(num_bytes=3000)
    return optimiser


def decoded(chunks: list[bytes], cube: RadarCube) -> np.ndarray:
    return np.concatenate([decode_chunk(chunk, cube.config).cube_values() for chunk in chunks])


def test_a_size_is_found_in_a_few_trials():
    """An estimate calibrated by the last trial finds the size; bisection alone would take a dozen trials."""
    trials: list[str] = []
    chunks = optimiser_of(crowd()).within_bytes(3000, trials.append)
    assert 0.97 * 3000 <= sum(map(len, chunks)) <= 3000
    assert len(trials) <= 8


def test_a_quality_is_found_in_a_few_trials():
    cube, trials = crowd(), []
    values = decoded(optimiser_of(cube).within_error(20.0, trials.append), cube)
    assert -20.3 <= error_db(cube.values, values, active_mask(cube.values)) <= -20
    assert len(trials) <= 12


def test_what_cannot_be_reached_is_refused():
    optimiser = optimiser_of(crowd(num_frames=1))
    with pytest.raises(InputError, match="too few"):
        optimiser.within_bytes(5, lambda _: None)
    with pytest.raises(InputError, match="so many frames"):
        optimiser.within_bytes(-5, lambda _: None)
    with pytest.raises(InputError, match="cannot be reached"):
        optimiser.within_error(300.0, lambda _: None)


@pytest.mark.parametrize(
    ("cube", "num_bytes"),
    [(crowd(num_frames=1), 2500), (crowd(num_points=2, noise=2e-2), 2500)],
    ids=["one frame", "few points"],
)
def test_full_effort_is_not_behind_fast(cube: RadarCube, num_bytes: int):
    is_active = active_mask(cube.values)
    full, fast = (
        error_db(cube.values, values_of_bytes(compress_cube(cube, num_bytes=num_bytes, effort=effort)), is_active)
        for effort in ("full", "fast")
    )
    assert full <= fast + 0.1


def test_noise_alone_is_coded_as_a_noise_layer():
    """The window correlates the noise of cells along Doppler: a transform holds it in fewer numbers than cells do."""
    config, num_frames = replace(SMALL, num_loops=32), 4
    shape = (num_frames, config.num_range_bins, config.num_loops, config.num_antennas)
    draw = stream(0, "noise").normal(size=(2, *shape))
    window = np.hanning(config.num_loops)[:, None]
    values = np.fft.fftshift(np.fft.fft((draw[0] + 1j * draw[1]) * window, axis=2), axes=2).astype(np.complex64)
    cube = RadarCube(values=values, grid=CubeGrid.of(config, num_frames), config=config, scale=1.0)
    chunks = optimiser_of(cube).within_bytes(6000, lambda _: None)
    assert decode_chunk(chunks[0], config).mode_name() == "noise"
    assert error_db(values, decoded(chunks, cube), np.ones(shape[:3], bool)) < -1.5
