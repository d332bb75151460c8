import numpy as np
import pytest

from mmweaver.compression.sample_block import BlockShape, decode_block, encode_block
from mmweaver.core.seeding import stream


def static_scene(shape: tuple[int, int, int, int], noise: float = 3.0) -> np.ndarray:
    """Samples of a strong static scene with a little noise."""
    draw = stream(0, "samples")
    steady = draw.normal(size=shape[1:]) * 2000
    return np.clip(np.rint(steady + draw.normal(size=shape) * noise), -32768, 32767).astype(np.int64)


def shape_of(samples: np.ndarray) -> BlockShape:
    return BlockShape(**dict(zip(("loops", "antennas", "samples", "parts"), samples.shape, strict=True)))


@pytest.mark.parametrize("shape", [(1, 1, 2, 2), (3, 2, 8, 2), (1, 4, 64, 1), (20, 3, 16, 1)])
def test_every_word_survives(shape: tuple[int, int, int, int]):
    samples = static_scene(shape)
    assert np.array_equal(decode_block(encode_block(samples), shape_of(samples)), samples)


def test_extreme_words_survive():
    samples = stream(1, "words").integers(-32768, 32768, size=(6, 2, 32, 2))
    samples[0, 0, :4, 0] = [-32768, 32767, -32768, 32767]
    assert np.array_equal(decode_block(encode_block(samples), shape_of(samples)), samples)
    zeros = np.zeros((4, 2, 16, 2), np.int64)
    assert np.array_equal(decode_block(encode_block(zeros), shape_of(zeros)), zeros)


@pytest.mark.parametrize("max_error", [1, 2, 7, 100])
def test_the_largest_error_is_kept_to(max_error: int):
    for samples in (static_scene((24, 2, 32, 2)), stream(2, "words").integers(-32768, 32768, size=(6, 2, 32, 2))):
        found = decode_block(encode_block(samples, max_error), shape_of(samples)).astype(np.int64)
        assert np.abs(found - samples).max() <= max_error


def test_a_static_scene_costs_its_noise():
    """The entropy of Gaussian noise of 3 counts is 3.63 bits; the prediction itself is noisy, too."""
    samples = static_scene((80, 3, 64, 2))
    bits = 8 * len(encode_block(samples)) / samples.size
    assert bits < 3.63 + 1.0
    assert 8 * len(encode_block(samples, 4)) / samples.size < bits - 2.5


def test_blocks_of_another_shape_are_refused():
    samples = static_scene((3, 2, 8, 2))
    with pytest.raises(ValueError):
        decode_block(encode_block(samples), shape_of(samples[:, :1]))
