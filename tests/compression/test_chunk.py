import contextlib

import numpy as np
import pytest
import torch

from mmweaver.compression.chunk import PREFIX, decode_chunk, pack_exact, unpack_exact
from mmweaver.compression.chunk_encoder import ChunkEncoder, ChunkMode, Scale
from mmweaver.compression.scatterers.fitting import FitRecipe, fitted
from mmweaver.compression.transforms import NO_DCT, TransformChoice
from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from tests.compression.echoes import SMALL, crowd, error_db
from tests.compression.scatterers.test_fit_window import overlapping

POINTS = ChunkMode(with_points=True)


def encoder_of(cube, recipe: FitRecipe) -> ChunkEncoder:
    encoder = ChunkEncoder(cube, Scale.of(cube))
    encoder.layers = fitted(torch.from_numpy(encoder.target), encoder.frames.fit_window(), recipe)
    return encoder


@pytest.fixture(scope="module")
def encoder() -> ChunkEncoder:
    return encoder_of(crowd(), FitRecipe(num_points=60, stages=6))


@pytest.mark.parametrize("mode", [POINTS, ChunkMode(), ChunkMode(with_noise=True)], ids=["points", "cells", "noise"])
def test_a_finer_step_costs_more_and_has_less_error(encoder: ChunkEncoder, mode: ChunkMode):
    truth = crowd().values
    sizes, errors = [], []
    for step in (0.1, 0.02, 0.004, 8e-4):
        data = encoder.encode(step, mode, 1)
        again = decode_chunk(data, SMALL).cube_values()
        sizes.append(len(data))
        errors.append(error_db(again, truth))
    assert sizes == sorted(sizes)
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < -45
    # a cell of a cube that is coded throughout errs by step / sqrt(12)
    assert np.sqrt(np.mean(np.abs(again - truth) ** 2)) < 8e-4 * np.abs(truth).max()


@pytest.mark.parametrize("mode", [POINTS, ChunkMode(), ChunkMode(with_noise=True)], ids=["points", "cells", "noise"])
def test_estimates_are_about_what_is_coded(encoder: ChunkEncoder, mode: ChunkMode):
    truth, is_active = crowd().values / np.abs(crowd().values).max(), encoder.is_active
    sample = encoder.sample(mode, 0.01)
    found = encoder.estimate(sample, mode, 0.01, 4)
    data = encoder.encode(0.01, mode, 4)
    left = np.sum(np.abs(decode_chunk(data, SMALL).cube_values() / np.abs(crowd().values).max() - truth) ** 2, -1)
    assert found.num_bytes == pytest.approx(len(data), rel=0.35)
    assert found.active_error == pytest.approx(left[is_active].sum(), rel=0.5)
    assert found.all_error == pytest.approx(left.sum(), rel=0.3)


def test_what_follows_a_stream_is_ignored(encoder: ChunkEncoder):
    """Files that hold next to nothing are filled up, some by other than whole words."""
    data = encoder.encode(0.5, POINTS, 4)
    found = [decode_chunk(data + bytes(more), SMALL).cube_values() for more in (0, 1, 4, 6)]
    assert all(np.array_equal(found[0], one) for one in found[1:])


def test_overlapping_windows():
    cube = overlapping()
    data = encoder_of(cube, FitRecipe(num_points=20, stages=2)).encode(0.05, POINTS, 1)
    again = decode_chunk(data, SMALL)
    assert again.frames.hop == 3
    assert error_db(again.cube_values(), cube.values) < -12
    # noise once for each chirp, not once for each window: 31 loops instead of 96
    assert len(data) < 0.7 * 2 * cube.values.size


@pytest.mark.parametrize("data", [b"", b"\0" * 18, b"\xff" * 400])
def test_malformed_chunks_are_refused(data: bytes):
    with pytest.raises(InputError, match=r"is malformed"):
        decode_chunk(data, SMALL)


def test_a_chunk_of_impossible_size_is_refused_before_anything_is_reserved():
    with pytest.raises(InputError, match="values"):
        decode_chunk(PREFIX.pack(60_000, 0, 1.0, 1.0, 0, 0, 0, 0, 0, 4) + bytes(30), SMALL)


@pytest.mark.parametrize("seed", range(3))
def test_a_damaged_stream_ends_in_one_clear_error_or_in_values(encoder: ChunkEncoder, seed: int):
    """Checksums guard chunks in files; whatever comes past them must not crash either."""
    mode = ChunkMode(transform=TransformChoice(time=NO_DCT), with_points=bool(seed % 2))
    data = bytearray(encoder.encode(0.02, mode, 4))
    for at in np.random.default_rng(seed).integers(PREFIX.size, len(data), 10):
        broken = bytes(data[:at]) + bytes([data[at] ^ 0x55]) + bytes(data[at + 1 :])
        with contextlib.suppress(InputError):
            assert decode_chunk(broken, SMALL).cube_values().shape == crowd().values.shape


@pytest.mark.parametrize("shape", [(1, 1, 1, 1), (2, 3, 4, 5)])
def test_every_bit_of_an_exact_chunk_survives(shape: tuple[int, ...]):
    values = stream(0, "values").normal(size=(*shape, 2)).astype(np.float32).view(np.complex64)[..., 0]
    for array in (values, np.zeros_like(values)):
        assert np.array_equal(unpack_exact(pack_exact(array), shape), array)
