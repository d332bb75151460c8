import numpy as np

from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.low_rank import RankFactors
from mmweaver.core.seeding import stream

SHAPE = (4, 20, 32, 6)


def low_rank(rank: int) -> np.ndarray:
    draw = stream(3, "factors")
    left = draw.normal(size=(rank, 80)) + 1j * draw.normal(size=(rank, 80))
    right = draw.normal(size=(rank, 192)) + 1j * draw.normal(size=(rank, 192))
    return (left.T @ (right / 10.0 ** np.arange(rank)[:, None])).reshape(SHAPE)


def test_its_rank_is_found_and_the_error_is_that_of_one_step():
    values, step = low_rank(3), 1e-3
    factors = RankFactors.of(values, step)
    assert factors is not None
    assert factors.rank == 3
    error = np.sqrt(np.mean(np.abs(factors.values(step, SHAPE) - values) ** 2))
    assert error < step


def test_noise_has_no_components_and_factors_survive_their_bits():
    draw = stream(4, "noise").normal(size=(2, *SHAPE))
    noise = draw[0] + 1j * draw[1]
    assert RankFactors.of(noise, 0.1, noise_power=2.0) is None
    factors = RankFactors.of(low_rank(2) + 1e-3 * noise, 1e-2)
    assert factors is not None
    stream_of = Encoder()
    factors.code(stream_of)
    again = RankFactors.empty(factors.rank, SHAPE)
    again.code(Decoder(stream_of.to_bytes()))
    assert np.array_equal(again.left, factors.left)
    assert np.array_equal(again.right, factors.right)
