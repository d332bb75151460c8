"""Models of versions 1 and 2, which files are only read with; their coders still encode, for these tests."""

import numpy as np
import pytest

from mmweaver.compression.cell_coder import COARSE, FINE
from mmweaver.compression.entropy import Decoder, Encoder
from mmweaver.compression.legacy_chunk import LadderModel, LegacyLevelCoder, LegacyMapCoder
from mmweaver.core.seeding import stream

SHAPES = [(2, 4, 3, 20, 16), (2, 1, 1, 37, 9), (2, 12, 1, 24, 1), (2, 2, 2, 1, 1)]


def clusters(shape: tuple[int, ...], seed: int = 0) -> np.ndarray:
    """Mostly zeros, with smooth blobs of numbers."""
    from scipy.ndimage import gaussian_filter

    rng = stream(seed, "clusters")
    noise = gaussian_filter(rng.normal(size=shape), (0, 0, 0, 1, 1))
    strength = gaussian_filter((rng.random(shape) < 0.003).astype(float), (0, 1, 0, 2, 2))
    return np.rint(4000 * noise * strength).astype(np.int64)


def classes_of(levels: np.ndarray, *, is_dense: bool) -> np.ndarray:
    """A class for each cell that holds anything, or for all."""
    kind = stream(2, "classes").choice([COARSE, FINE], levels.shape[2:])
    return np.full(kind.shape, FINE) if is_dense else np.where((levels != 0).any(axis=(0, 1)), kind, 0)


@pytest.mark.parametrize("is_dense", [False, True])
@pytest.mark.parametrize("shape", SHAPES)
def test_map_and_levels_round_trip(shape: tuple[int, ...], is_dense: bool):
    levels = clusters(shape)
    levels[0, 0, 0, 0, 0] = -70_000  # far beyond the single rungs
    classes, near = classes_of(levels, is_dense=is_dense), stream(1, "near").integers(0, 9, shape[2:])
    writer = Encoder()
    LegacyMapCoder(shape[2:]).code(writer, classes.copy(), near)
    LegacyLevelCoder(shape[1:], is_dense=is_dense).code(writer, levels.copy(), classes, near)
    reader = Decoder(writer.to_bytes())
    classes_again, again = np.zeros_like(classes), np.zeros_like(levels)
    LegacyMapCoder(shape[2:]).code(reader, classes_again, near)
    LegacyLevelCoder(shape[1:], is_dense=is_dense).code(reader, again, classes_again, near)
    assert np.array_equal(classes_again, classes)
    assert np.array_equal(again, levels)


def test_numbers_on_a_ladder_round_trip():
    draw = stream(0, "numbers")
    numbers = np.concatenate([draw.geometric(0.4, 400) - 1, draw.integers(0, 2**28, 100)])
    contexts = [draw.integers(0, 3, 500), draw.integers(0, 2, 500)]
    writer = Encoder()
    LadderModel([3, 2]).code(writer, contexts, numbers)
    again = LadderModel([3, 2]).code(Decoder(writer.to_bytes()), contexts, np.zeros_like(numbers))
    assert np.array_equal(again, numbers)
