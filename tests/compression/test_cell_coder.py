import numpy as np
import pytest

from mmweaver.compression.cell_coder import COARSE, FINE, MapCoder, NumberCoder
from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.core.seeding import stream
from tests.compression.test_residual_coder import clusters

SHAPES = [(2, 4, 3, 20, 16), (2, 1, 1, 37, 9), (2, 12, 1, 24, 1), (2, 2, 2, 1, 1)]


def opened(levels: np.ndarray, seed: int = 2) -> np.ndarray:
    """A class for each cell that holds anything."""
    kind = stream(seed, "classes").choice([COARSE, FINE], levels.shape[2:])
    return np.where((levels != 0).any(axis=(0, 1)), kind, 0)


@pytest.mark.parametrize("shape", SHAPES)
def test_map_and_levels_round_trip(shape: tuple[int, ...]):
    levels = clusters(shape)
    levels[0, 0, 0, 0, 0] = -70_000  # far beyond the single rungs
    classes = opened(levels)
    near = stream(1, "near").integers(0, 9, shape[2:])
    writer = Encoder()
    MapCoder(shape[2:]).code(writer, classes.copy(), near)
    NumberCoder(shape[1:]).code(writer, levels.copy(), classes, near)
    reader = Decoder(writer.to_bytes())
    classes_again, again = np.zeros_like(classes), np.zeros_like(levels)
    MapCoder(shape[2:]).code(reader, classes_again, near)
    NumberCoder(shape[1:]).code(reader, again, classes_again, near)
    assert np.array_equal(classes_again, classes)
    assert np.array_equal(again, levels)


def test_clustered_maps_cost_less_than_their_order_0_entropy():
    levels = clusters((2, 1, 8, 64, 32))
    classes = np.where((levels != 0).any(axis=(0, 1)), FINE, 0)
    writer = Encoder()
    MapCoder(classes.shape).code(writer, classes.copy(), np.zeros(classes.shape, np.int64))
    share = np.mean(classes > 0)
    entropy_bits = -classes.size * (share * np.log2(share) + (1 - share) * np.log2(1 - share))
    assert 0 < 8 * len(writer.to_bytes()) < 0.7 * entropy_bits


def test_levels_cost_less_than_their_order_0_entropy():
    levels = clusters((2, 8, 4, 64, 32))
    classes = np.where((levels != 0).any(axis=(0, 1)), FINE, 0)
    writer = Encoder()
    NumberCoder(levels.shape[1:]).code(writer, levels.copy(), classes, np.zeros(classes.shape, np.int64))
    _, counts = np.unique(levels[:, :, classes > 0], return_counts=True)
    share = counts / counts.sum()
    assert 8 * len(writer.to_bytes()) < -0.95 * counts.sum() * np.sum(share * np.log2(share))


def test_zeros_cost_next_to_nothing():
    classes = np.zeros((20, 64, 32), np.int64)
    writer = Encoder()
    MapCoder(classes.shape).code(writer, classes, classes)
    NumberCoder((12, *classes.shape)).code(writer, np.zeros((2, 12, *classes.shape), np.int64), classes, classes)
    assert len(writer.to_bytes()) < 100
