import numpy as np

from mmweaver.core.seeding import stream
from studies.baselines.tensor_codecs import packed, unpacked


def test_parts_come_back_in_eight_bits():
    numbers = stream(0, "parts").normal(size=(2, 5, 4, 3))
    parts = [numbers[0] + 1j * numbers[1], numbers[1, :, 0] * 1e-6 + 0j]
    again = unpacked(packed(parts))
    for part, back in zip(parts, again, strict=True):
        assert back.shape == part.shape
        assert np.abs(back - part).max() < np.abs(part).max() / 120
