import numpy as np
import pytest

from mmweaver.compression.entropy import BitModel, Decoder, Encoder, Mixture, NumberModel
from mmweaver.core.seeding import stream


def test_bits_and_numbers_round_trip_at_their_entropy():
    rng = stream(0, "bits")
    probability = rng.uniform(0.001, 0.2, 20_000)
    bits = (rng.random(20_000) < probability).astype(np.int64)
    sizes = rng.integers(1, 3000, 500)
    numbers = (rng.random(500) * sizes).astype(np.int64)
    writer = Encoder()
    writer.bits(probability, bits)
    writer.uniform(sizes, numbers)
    data = writer.to_bytes()
    ideal = -np.sum(np.log2(np.where(bits, probability, 1 - probability))) + np.sum(np.log2(sizes))
    assert 8 * len(data) < 1.005 * ideal + 64
    reader = Decoder(data)
    assert np.array_equal(reader.bits(probability, np.zeros_like(bits)), bits)
    assert np.array_equal(reader.uniform(sizes, np.zeros_like(sizes)), numbers)


def test_a_mixture_learns_the_informative_context():
    """Bits that one context decides and another does not: soon they cost next to nothing."""
    rng = stream(1, "bits")
    sizes = []
    for is_informative in (True, False):
        writer = Encoder()
        mixture = Mixture([BitModel(2), BitModel(2)])
        for _ in range(60):
            bits = rng.integers(0, 2, 100)
            other = rng.integers(0, 2, 100)
            mixture.code(writer, [bits if is_informative else other, other], bits)
        sizes.append(len(writer.to_bytes()) * 8 / 6000)
    assert sizes[0] < 0.1
    assert sizes[1] == pytest.approx(1.0, abs=0.05)


def test_integers_of_any_size():
    numbers = np.array([0, 1, 2, 3, 5, 8, 200, 70_000, 0, 12])
    context = np.array([0, 1, 0, 1, 0, 1, 0, 1, 0, 1])
    writer = Encoder()
    NumberModel(2, 4).code(writer, context, numbers)
    huge, values = np.array([2**23 + 1, 2**26, 2**30]), np.array([2**22 + 9, 2**26 - 1, 2**29 + 0xFFFE])
    writer.uniform(huge, values)
    reader = Decoder(writer.to_bytes())
    again = NumberModel(2, 4).code(reader, context, np.zeros_like(numbers))
    assert np.array_equal(again, numbers)
    assert np.array_equal(reader.uniform(huge, np.zeros_like(huge)), values)


def test_a_damaged_stream_terminates():
    noise = stream(2, "damage").integers(0, 256, 400).astype(np.uint8).tobytes()
    reader = Decoder(noise)
    with pytest.raises((ValueError, AssertionError)):
        for _ in range(1000):
            NumberModel(1, 2, 0.99).code(reader, np.zeros(500, np.int64), np.zeros(500, np.int64))
