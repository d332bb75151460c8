import numpy as np
import pytest

from mmweaver.compression.entropy import Encoder
from mmweaver.compression.level_coder import LevelCoder
from mmweaver.compression.level_size import estimated_bits
from mmweaver.core.seeding import stream


@pytest.mark.parametrize(("beams", "size", "share"), [(1, 1.5, 0.5), (8, 0.8, 0.2), (12, 40.0, 0.05), (12, 1.0, 0.9)])
def test_the_bits_are_those_of_the_coder(beams: int, size: float, share: float):
    """Levels whose size changes from place to place: coded and counted, one beam and many, few cells and most."""
    draw = stream(0, "levels")
    shape = (6, 32, 16)
    is_open = draw.random(shape) < share
    factor = np.where(is_open, np.where(draw.random(shape) < 0.3, 4, 1), 0)
    growing = size * (1 + np.arange(shape[1]) / 8)[:, None] * np.ones(shape)
    levels = np.rint(draw.normal(size=(2, beams, is_open.sum())) * growing[is_open]).astype(np.int64)
    encoder, coder = Encoder(), LevelCoder((beams, *shape))
    coder.code(encoder, levels.copy(), factor)
    found = estimated_bits(LevelCoder((beams, *shape)), levels, factor, np.ones(beams))
    assert found / 8 == pytest.approx(len(encoder.to_bytes()), rel=0.12)  # of recordings 0.04


def test_levels_of_a_single_beam_are_counted():
    """Wherever it stands among the many beams of which only some are looked at."""
    levels = np.zeros((2, 12, 8192), np.int64)
    levels[:, 5] = np.rint(stream(0, "one beam").normal(size=(2, 8192)) * 3)
    factor, shape = np.ones((4, 64, 32), np.int64), (12, 4, 64, 32)
    encoder = Encoder()
    LevelCoder(shape).code(encoder, levels.copy(), factor)
    weights = np.log2(1 + np.abs(levels)).sum(axis=(0, 2)) + 100.0
    found = estimated_bits(LevelCoder(shape), levels, factor, weights)
    assert found / 8 == pytest.approx(len(encoder.to_bytes()), rel=0.2)


def test_no_levels_have_no_bits():
    nothing = np.zeros((2, 3, 0), np.int64)
    assert estimated_bits(LevelCoder((3, 2, 4, 4)), nothing, np.zeros((2, 4, 4), np.int64), np.ones(3)) == 0
