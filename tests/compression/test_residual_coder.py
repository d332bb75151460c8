import numpy as np
import pytest

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.residual_coder import ResidualCoder
from mmweaver.core.seeding import stream


def clusters(shape: tuple[int, ...], seed: int = 0) -> np.ndarray:
    """Mostly zeros, with smooth blobs of numbers."""
    from scipy.ndimage import gaussian_filter

    rng = stream(seed, "clusters")
    noise = gaussian_filter(rng.normal(size=shape), (0, 0, 0, 1, 1))
    strength = gaussian_filter((rng.random(shape) < 0.003).astype(float), (0, 1, 0, 2, 2))
    return np.rint(4000 * noise * strength).astype(np.int64)


@pytest.mark.parametrize("shape", [(2, 4, 3, 20, 16), (2, 1, 1, 37, 9), (2, 12, 1, 24, 1), (2, 2, 2, 1, 1)])
def test_levels_round_trip(shape: tuple[int, ...]):
    levels = clusters(shape)
    levels[0, 0, 0, 0, 0] = -70_000  # far beyond the learned steps
    near = stream(1, "near").integers(0, 9, shape[2:])
    writer = Encoder()
    ResidualCoder(shape[1:]).code(writer, levels.copy(), near)
    again = np.zeros_like(levels)
    ResidualCoder(shape[1:]).code(Decoder(writer.to_bytes()), again, near)
    assert np.array_equal(again, levels)


def test_clusters_cost_less_than_their_order_0_entropy():
    """Neighbours must help: fewer bits than the order-0 entropy of the same numbers."""
    levels = clusters((2, 8, 4, 64, 32))
    writer = Encoder()
    ResidualCoder(levels.shape[1:]).code(writer, levels.copy(), np.zeros(levels.shape[2:], np.int64))
    _, counts = np.unique(levels, return_counts=True)
    share = counts / counts.sum()
    entropy_bits = -levels.size * np.sum(share * np.log2(share))
    assert 8 * len(writer.to_bytes()) < 0.8 * entropy_bits


def test_zeros_cost_next_to_nothing():
    levels = np.zeros((2, 12, 20, 64, 32), np.int64)
    writer = Encoder()
    ResidualCoder(levels.shape[1:]).code(writer, levels, np.zeros(levels.shape[2:], np.int64))
    assert len(writer.to_bytes()) < 200
